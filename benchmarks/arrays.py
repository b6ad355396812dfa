"""Arrays: what many bristles on one root do to friction, and how soon.

`python benchmarks/arrays.py [FOLDER]`: vertical springs over a sine, where bristles stand
anywhere, 1 to 100,000 of them. Compliant arrays on a steady slide: mean force a bristle,
what is left of stick-slip, with which power of N it falls, and a loop. Rigid arrays: rho of
the sum of all tips. It prints a table, and writes `arrays.nc` and `arrays.png`.
"""

import resource
import sys
import time
from pathlib import Path
from typing import Any

import jax
import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from scipy import stats

import frictionjax as fx
from frictionjax.plot.style import COLOURS, GUIDE, LIMIT, styled

EPS, RATE = 1e-2, 1.0
SEEDS = {1: 4, 10: 16, 100: 16, 1000: 8, 10_000: 3, 100_000: 1}
SAMPLES = 32  # of one slip of the slide
LOOPS = (1, 10, 1000)
RANDOM_WALK = 0.8862269  # sqrt(pi)/2


def scene_with(effect: Any, load: Any = None, duration: float = 1.0) -> fx.Scene:
    profile = fx.profiles.Sine(0.1)
    bristle = fx.bristles.VerticalSpring(1.0, 2.0, 1.0)
    load = fx.loads.Ramp(RATE, 0.0) if load is None else load
    effects = () if effect is None else (effect,)
    spring = fx.supports.Spring(1.0)
    return fx.Scene(profile, bristle, spring, load, duration, effects=effects)


def phases(count: int, seed: int) -> np.ndarray:
    return np.random.default_rng([count, seed]).uniform(size=count)


def slide(offsets: np.ndarray) -> np.ndarray:
    """Force a bristle in N, over one slip of a steady slide."""
    slip = EPS / RATE
    ts = 1.0 - slip + slip * np.arange(SAMPLES) / SAMPLES
    scene = scene_with(fx.effects.CompliantArray(offsets))
    found = fx.solve(scene, EPS, ts=ts, dissipation=False)
    assert found.ok
    return RATE * ts - np.asarray(found.z)


def measured() -> tuple[xr.Dataset, float]:
    """Means and ripples over N and seed, NaN where a seed is not taken; loops; seconds of
    the largest array."""
    counts, most = list(SEEDS), max(SEEDS.values())
    shape = len(counts), most
    mean, ripple, rigid = (np.full(shape, np.nan) for _ in range(3))
    seconds = 0.0
    for i, (count, seeds) in enumerate(SEEDS.items()):
        for seed in range(seeds):
            began = time.perf_counter()
            force = slide(phases(count, seed))
            seconds = time.perf_counter() - began
            mean[i, seed], ripple[i, seed] = np.mean(force), np.std(force)
        for seed in range(most):
            array = fx.effects.RigidArray(phases(count, seed))
            rigid[i, seed] = float(fx.friction(scene_with(array)).rho_plus)
    end = 30.0  # slow: little drag at an eps whose slips are seen
    ts = np.linspace(0.0, end, 1201)
    load = fx.loads.Sine(1.0488, end)
    loops = []
    for count in LOOPS:
        scene = scene_with(fx.effects.CompliantArray(phases(count, 0)), load, end)
        loops.append(np.asarray(fx.solve(scene, 0.05, ts=ts, dissipation=False).z))
    known = "count", "seed"
    rho = float(fx.friction(scene_with(None)).rho_plus)
    return xr.Dataset(
        {
            "mean_force": (known, mean),
            "ripple": (known, ripple),
            "rho_rigid": (known, rigid),
            "z": (("bristles", "time"), loops),
            "load": ("time", np.asarray(jax.vmap(load)(ts))),
        },
        coords={
            "count": counts,
            "seed": np.arange(most),
            "bristles": list(LOOPS),
            "time": ts,
        },
        attrs={"eps": EPS, "rate": RATE, "rho": rho},
    ), seconds


def power(data: xr.Dataset, name: str) -> tuple[float, float]:
    """With which a column goes with N, and its 95% interval's half, over all seeds."""
    values = data[name].values
    known = np.isfinite(values) & (data["count"].values[:, None] > 1)
    counts = np.broadcast_to(data["count"].values[:, None], values.shape)
    fit = stats.linregress(np.log(counts[known]), np.log(values[known]))
    return fit.slope, fit.stderr * stats.t.ppf(0.975, known.sum() - 2)


def table(data: xr.Dataset) -> str:
    rho = data.attrs["rho"]
    lines = [
        "| bristles | seeds | force/rho | ripple/rho | times sqrt(N) | rigid rho/rho |",
        "|---|---|---|---|---|---|",
    ]
    for count in data["count"].values:
        row = data.sel(count=count)
        ripple = float(np.sqrt(np.nanmean(row.ripple.values**2))) / rho
        numbers = (
            float(row.mean_force.mean()) / rho,
            ripple,
            ripple * np.sqrt(count),
            float(row.rho_rigid.mean()) / rho,
        )
        seeds = int(np.isfinite(row.ripple).sum())
        cells = " | ".join(f"{value:.4g}" for value in numbers)
        lines.append(f"| {count:,} | {seeds} | {cells} |")
    for name, meaning in (("ripple", "ripple"), ("rho_rigid", "rigid rho")):
        slope, half = power(data, name)
        lines.append(f"\n{meaning} ~ N^({slope:.3f} +- {half:.3f})")
    return "\n".join(lines)


@styled
def picture(data: xr.Dataset) -> Figure:
    figure = Figure(figsize=(11.5, 3.9), layout="constrained")
    loops, ripple, rigid = figure.subplots(1, 3)
    rho, counts = data.attrs["rho"], data["count"].values
    for colour, count in zip(COLOURS, data.bristles.values, strict=False):
        z = data.z.sel(bristles=count)
        loops.plot(z, data["load"] - z, color=colour, lw=1, label=f"N = {count:,}")
    for level in (rho, -rho):
        loops.axhline(level, color=GUIDE, lw=0.8, ls="--")
    loops.set(xlabel="mean z in m", ylabel="force a bristle in N")
    loops.set_title("compliant arrays, eps = 0.05 m")
    loops.legend(loc="center")
    for seed in data.seed.values:
        look = {"color": COLOURS[0], "ls": "", "marker": "o", "ms": 3, "alpha": 0.6}
        ripple.loglog(counts, data.ripple.sel(seed=seed) / rho, **look)
    one = float(data.ripple.isel(count=0).mean()) / rho
    ripple.loglog(counts, one / np.sqrt(counts), color=LIMIT, lw=1, label="1/sqrt(N)")
    error = np.abs(data.mean_force.mean("seed") / data.mean_force.isel(count=0, seed=0) - 1)
    ripple.loglog(counts, error, "x", color=COLOURS[1], label="mean force off from one's")
    ripple.set(xlabel="bristles", ylabel="ripple of the force over rho", ylim=(5e-7, 0.1))
    ripple.set_title("compliant: steady slide")
    ripple.legend(loc="lower left")
    for seed in data.seed.values:
        look = {"color": COLOURS[2], "ls": "", "marker": "o", "ms": 3, "alpha": 0.6}
        rigid.loglog(counts, data.rho_rigid.sel(seed=seed) / rho, **look)
    rigid.loglog(counts, counts, color=GUIDE, ls="--", label="all in phase: N")
    law = RANDOM_WALK * np.sqrt(counts)
    rigid.loglog(counts, law, color=LIMIT, lw=1, label="anywhere: 0.8862 sqrt(N)")
    rigid.set(xlabel="tips", ylabel="rho of the array over rho")
    rigid.set_title("rigid; evenly spread: 0")
    rigid.legend(loc="upper left")
    return figure


def main(folder: Path) -> None:
    jax.config.update("jax_enable_x64", True)
    fx.use_fast_cpu()
    began = time.perf_counter()
    data, seconds = measured()
    folder.mkdir(parents=True, exist_ok=True)
    data.to_netcdf(folder / "arrays.nc")
    picture(data).savefig(folder / "arrays.png", dpi=150)
    print(table(data))
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
    print(f"\nlargest array {seconds:.1f} s, peak {peak:.2f} GB", end="; ")
    print(f"all {time.perf_counter() - began:.0f} s")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
