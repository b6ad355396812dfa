"""Tips with mass: where the limit stays dry friction with the paper's coefficients.

`python benchmarks/inertia.py [FOLDER]` sweeps masses `m_eps = mass eps^exponent` around the
exponent 1 + 2 gamma at gamma = 1, on a slanted spring over a sine: sup errors and their
orders along a loop, and on steady slides both ways the mean friction and the wells a slip.
It prints a table, and writes `inertia.nc` and `inertia.png` into the folder.
"""

import sys
import time
import warnings
from pathlib import Path
from typing import Any

import jax
import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter

import frictionjax as fx
from frictionjax.plot.style import COLOURS, GUIDE, LIMIT, styled

GAMMA = 1.0
EPS = np.geomspace(3e-2, 3e-3, 8)
EXPONENTS = (2.0, 3.0, 4.0)
BETAS = np.array([0.05, 0.2, 0.5, 0.7, 0.9, 1.3, 2.0, 5.0, 20.0, 100.0])
REFERENCE = 0.01  # the eps at which masses of all exponents have the same beta
SLIDES = 6e-3, 3e-3  # eps of the steady slides
DURATION, SAMPLES = 2.0, 6001


def scene_with(beta: float, exponent: float, load: Any, duration: float) -> fx.Scene:
    profile = fx.profiles.Sine(0.1)
    bristle = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 0.5)
    scene = fx.Scene(profile, bristle, fx.supports.Spring(1.0), load, duration)
    Y = np.linspace(0, 1, 4097)
    W = np.asarray(scene.potential.W(Y))
    bend = np.max(np.abs(np.gradient(np.gradient(W, Y), Y)[2:-2]))
    mass = beta / bend * REFERENCE ** (1 + 2 * GAMMA - exponent)
    return scene.replace(effects=(fx.effects.Inertia(mass, exponent),))


def loops(exponent: float, betas: np.ndarray) -> xr.Dataset:
    """Sup errors over eps and their slope, for each beta at the reference eps."""
    load, rows, seen = fx.loads.Sine(1.0488, 3.0), [], []
    for beta in betas:
        data = fx.sweep(scene_with(beta, exponent, load, 3.0), EPS, [GAMMA], [0.0, 3.0])
        rows.append(data.sup_error.where(data.status == 0).values[0])
        seen.append(float(fx.study(data).orders.order_seen[0]))
    columns = {"sup_error": (("mass", "eps"), rows), "order_seen": ("mass", seen)}
    return xr.Dataset(columns, coords={"mass": betas, "eps": data.eps.values})


def slide(beta: float, sign: float) -> tuple[np.ndarray, np.ndarray]:
    """Mean friction over rho, and wells a slip, at each eps.

    Of cells that are sensitive too: they are means over many slips.
    """
    scene = scene_with(beta, 3.0, fx.loads.Ramp(sign, 0.0), DURATION)
    law = fx.friction(scene)
    rho = float(law.rho_plus if sign > 0 else law.rho_minus)
    ts = np.linspace(0, DURATION, SAMPLES)
    data = fx.sweep(scene, SLIDES, [GAMMA], ts, suprema=False)
    half = SAMPLES // 2
    frictions, wells = [], []
    for eps in data.eps.values:
        cell = data.sel(eps=eps, gamma=GAMMA)
        z, lost = cell.z.values[half:], cell.dissipation.values[half:]
        way = z[-1] - z[0]
        frictions.append((lost[-1] - lost[0]) / way / rho)
        wells.append(abs(way) / eps / _slips(z, eps))
    return np.array(frictions), np.array(wells)


def _slips(z: np.ndarray, eps: float) -> int:
    """How often a tip moves on by more than half a well without a rest, 1 at least."""
    moving = np.abs(np.diff(z)) > 4 * DURATION / SAMPLES
    edges = np.flatnonzero(np.diff(moving.astype(int), prepend=0, append=0))
    begin, end = edges[::2], edges[1::2]
    return max(int(np.sum(np.abs(z[end] - z[begin]) > 0.5 * eps)), 1)


def measured() -> xr.Dataset:
    border = loops(3.0, BETAS)
    columns: dict[str, Any] = {
        "order_seen": ("beta", border.order_seen.values),
        "error_at_border": (("beta", "eps"), border.sup_error.values),
    }
    others = [loops(p, np.array([1.0])) for p in EXPONENTS]
    columns["sup_error"] = (("exponent", "eps"), [o.sup_error.values[0] for o in others])
    columns["order"] = ("exponent", [float(o.order_seen[0]) for o in others])
    found = [[slide(beta, sign) for beta in BETAS] for sign in (1.0, -1.0)]
    dims = "direction", "beta", "slide_eps"
    columns["friction"] = (dims, [[f for f, _ in row] for row in found])
    columns["wells"] = (dims, [[w for _, w in row] for row in found])
    coords = {"eps": border.eps.values, "beta": BETAS, "exponent": list(EXPONENTS)}
    return xr.Dataset(columns, coords | {"direction": [1, -1], "slide_eps": list(SLIDES)})


def table(data: xr.Dataset) -> str:
    lines = [
        "| beta | order seen | friction/rho, right | left | wells a slip, right | left |",
        "|---|---|---|---|---|---|",
    ]
    for beta in data.beta.values:
        row = data.sel(beta=beta).isel(slide_eps=-1)
        numbers = [*row.friction.values, *row.wells.values]
        cells = " | ".join(f"{value:.3g}" for value in [float(row.order_seen), *numbers])
        lines.append(f"| {beta:g} | {cells} |")
    lines.append("")
    for exponent in data.exponent.values:
        order = float(data.order.sel(exponent=exponent))
        lines.append(
            f"exponent {exponent:g}, beta = 1 at eps = 0.01: order seen {order:.2f}"
        )
    return "\n".join(lines)


@styled
def picture(data: xr.Dataset) -> Figure:
    figure = Figure(figsize=(9.0, 6.4), layout="constrained")
    errors, orders, friction, wells = figure.subplots(2, 2).ravel()
    for colour, exponent in zip(COLOURS, data.exponent.values, strict=False):
        column = data.sup_error.sel(exponent=exponent)
        label = f"mass ~ eps^{exponent:g}"
        errors.loglog(data.eps, column, "o-", color=colour, label=label, ms=3)
    errors.loglog(data.eps, data.eps, color=GUIDE, ls="--", label="eps")
    errors.xaxis.set_minor_formatter(NullFormatter())
    errors.set(xlabel="eps in m", ylabel="sup error in m", title="beta = 1 at eps = 0.01")
    errors.legend()
    orders.semilogx(data.beta, data.order_seen, "o-", color=COLOURS[0], ms=3)
    orders.set(xlabel="beta", ylabel="order of the sup error", title="mass ~ eps^3")
    betas = np.geomspace(1.6, 100, 50)
    friction.semilogx(betas, 4 / np.pi / np.sqrt(betas), color=GUIDE, ls="--")
    friction.annotate("caught: 4/(pi sqrt(beta))", (1.6, 0.15), color=LIMIT, fontsize=8)
    for i, name in enumerate(("right", "left")):
        for j, eps in enumerate(data.slide_eps.values):
            how = {"color": COLOURS[i], "ls": ("-", ":")[j], "marker": "o", "ms": 3}
            label = f"{name}, eps = {eps:g}"
            friction.semilogx(data.beta, data.friction[i, :, j], label=label, **how)
            wells.loglog(data.beta, data.wells[i, :, j], label=label, **how)
    friction.set(xlabel="beta", ylabel="mean friction over rho", title="steady slides")
    wells.set(xlabel="beta", ylabel="wells a slip", title="steady slides")
    friction.legend(loc="lower left")
    for axes in (orders, friction, wells):
        axes.axvline(0.7026, color=GUIDE, lw=0.8)
    return figure


def main(folder: Path) -> None:
    jax.config.update("jax_enable_x64", True)
    fx.use_fast_cpu()
    warnings.simplefilter("ignore", UserWarning)  # cells that are sensitive are left out
    began = time.perf_counter()
    data = measured()
    folder.mkdir(parents=True, exist_ok=True)
    data.to_netcdf(folder / "inertia.nc")
    picture(data).savefig(folder / "inertia.png", dpi=150)
    print(table(data))
    print(f"\n{time.perf_counter() - began:.0f} s")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
