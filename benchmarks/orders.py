"""Do the 95% intervals of `study` hold the order that theory has?

python benchmarks/orders.py [--scenes 8] [--seed 0] [--keep DIR]

Random scenes of four bristles, series of one to five harmonics and three loads; nine gamma;
three grids of eps. For each error and gamma: how many intervals hold the predicted order,
their median width, and how many rest on a law. Sweeps are kept in DIR as NetCDF, so that a
run goes on where one stopped.
"""

import argparse
import tempfile
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import jax
import numpy as np
import xarray as xr

import frictionjax as fx

fx.use_fast_cpu()
jax.config.update("jax_enable_x64", True)

GAMMA = np.array([0.25, 0.35, 0.4, 0.5, 0.6, 0.75, 1.0, 1.5, 2.0])
GRIDS = {
    "3e-2 to 1e-5, 10": np.geomspace(3e-2, 1e-5, 10),
    "1e-1 to 1e-4, 8": np.geomspace(1e-1, 1e-4, 8),
    "1e-1 to 1e-6, 16": np.geomspace(0.097, 1.03e-6, 16),
}
ERRORS = {
    "": "sup |z_eps - z|",
    "strip_": "sup dist(z_eps, strip)",
    "dissipation_": "dissipation",
}


def random_scene(number: int, seed: int) -> fx.Scene:
    """A scene whose load moves the bristle over several strips."""
    rng = np.random.default_rng([seed, number])
    orders = np.arange(1, rng.integers(2, 7))
    size = rng.uniform(0.05, 0.25)
    cos, sin = size * rng.normal(size=(2, orders.size)) / (2 * np.pi * orders**2)
    profile, bristle = fx.profiles.Fourier(cos, sin), random_bristle(number % 4, rng)
    law = fx.friction(profile, bristle)
    strip = float(law.rho_plus - law.rho_minus)
    amplitude, period = strip * rng.uniform(1.5, 6), rng.uniform(2, 5)
    load = (
        fx.loads.Sine(amplitude, period),
        fx.loads.Triangle(amplitude, period),
        fx.loads.Ramp(amplitude * rng.uniform(0.3, 1.0)),
    )[number % 3]
    support = fx.supports.Spring(np.exp(rng.uniform(-1, 1)))
    return fx.Scene(profile, bristle, support, load, 3.0)


def random_bristle(kind: int, rng: np.random.Generator):
    stiffness = float(np.exp(rng.uniform(-1, 1)))
    if kind == 0:
        return fx.bristles.VerticalSpring(stiffness, 1 + rng.uniform(0.2, 0.8), 1.0)
    if kind == 1:
        angle = rng.uniform(-0.7, 0.7)
        rest = 1 / np.cos(angle) + rng.uniform(0.3, 1.2)
        return fx.bristles.SlantedSpring(stiffness, rest, 1.0, angle)
    if kind == 2:
        limit = rng.uniform(0.7, 1.0)
        rest = limit - rng.uniform(0.3, 1.0)
        return fx.bristles.AngularSpring(stiffness, 1 / np.cos(limit), 1.0, rest)
    return fx.bristles.Homothetic(stiffness)


def sweeps(count: int, seed: int, folder: Path) -> Iterator[tuple[str, str, xr.Dataset]]:
    """Names of scene and grid, and the sweep, of so many admissible scenes."""
    made, number = 0, 0
    while made < count:
        number += 1
        try:
            scene = random_scene(number, seed)
        except ValueError:
            continue  # a surface that the bristle does not admit
        made += 1
        for index, (name, eps) in enumerate(GRIDS.items()):
            file = folder / f"{seed}-{number}-{index}.nc"
            if not file.exists():
                fx.sweep(scene, eps, GAMMA, ts=[0.0, 3.0]).to_netcdf(
                    file, engine="h5netcdf"
                )
            yield f"{seed}-{number}", name, xr.load_dataset(file, engine="h5netcdf")


class Row(NamedTuple):
    """One interval: whether it holds the predicted order, its width, whether by a law."""

    held: bool
    width: float
    by_law: bool


def judged(orders: xr.Dataset, prefix: str, where: str) -> Row | None:
    """The interval of one error at one gamma; None where no law or no order is known."""
    order = float(orders[f"{prefix}order_predicted"])
    low, high = (float(orders[f"{prefix}order_{end}"]) for end in ("low", "high"))
    if not np.isfinite(order + low + high):
        return None
    law, held = str(orders[f"{prefix}law"].item()), low <= order <= high
    if not held:
        interval = f"{order:.3f} not in [{low:.3f}, {high:.3f}]"
        print(f"missed: {where}, {ERRORS[prefix]}: {interval}, law {law}", flush=True)
    return Row(held, high - low, law != "free")


def printed(name: str, gamma: str, rows: list[Row]) -> None:
    if rows:
        held, laws = sum(row.held for row in rows), sum(row.by_law for row in rows)
        width = float(np.median([row.width for row in rows]))
        print(f"| {name} | {gamma} | {held} | {len(rows)} | {width:.3f} | {laws} |")


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--scenes", type=int, default=8)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--keep", type=Path)
    args = parser.parse_args()
    folder = args.keep or Path(tempfile.mkdtemp())
    folder.mkdir(parents=True, exist_ok=True)
    warnings.simplefilter("ignore")  # failed cells are counted by the study
    rows: dict[str, dict[float, list[Row]]] = {p: {g: [] for g in GAMMA} for p in ERRORS}
    for scene, grid, data in sweeps(args.scenes, args.seed, folder):
        orders = fx.study(data).orders
        for prefix in ERRORS:
            for gamma in GAMMA:
                where = f"{scene}, eps {grid}, gamma {gamma:g}"
                row = judged(orders.sel(gamma=gamma), prefix, where)
                rows[prefix][gamma] += [] if row is None else [row]
    print("\n| error | gamma | held | of | median width | by a law |")
    print("|---|---|---|---|---|---|")
    for prefix, name in ERRORS.items():
        for gamma, some in rows[prefix].items():
            printed(name, f"{gamma:g}", some)
        printed(name, "all", [row for some in rows[prefix].values() for row in some])


if __name__ == "__main__":
    main()
