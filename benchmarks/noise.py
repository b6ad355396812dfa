"""Noise: how fast temperature has to fall with eps for dry friction to be the limit.

`python benchmarks/noise.py [FOLDER]` takes temperatures `T_eps = temperature eps^exponent`
around the exponent 1, and `eps` over its logarithm, on a slanted spring over a sine at
gamma = 1: mean friction of steady slides both ways, by Smoluchowski's equation, over rho
and beside that without noise, how fast what noise takes falls with eps, and with which
power of the logarithm of the speed. It prints tables, and writes `noise.nc`, `noise.png`.
"""

import sys
import time
from pathlib import Path
from typing import Any

import jax
import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from scipy import optimize, special

import frictionjax as fx
from frictionjax.plot.style import COLOURS, GUIDE, LIMIT, styled

GAMMA, SPEED = 1.0, 0.1
EPS = np.geomspace(3e-2, 1e-3, 7)
REFERENCE = 0.01  # the eps at which all temperatures are the same
SHARE = 0.01  # T_eps over eps rho there
SCALES = {  # T_eps over its value at the reference
    "eps^0.5": lambda eps: (eps / REFERENCE) ** 0.5,
    "eps": lambda eps: eps / REFERENCE,
    "eps/log(1/eps)": lambda eps: eps / REFERENCE * np.log(REFERENCE) / np.log(eps),
    "eps^1.5": lambda eps: (eps / REFERENCE) ** 1.5,
    "eps^2": lambda eps: (eps / REFERENCE) ** 2,
}
SPEEDS = np.geomspace(1e-5, 3e-2, 8)
SHARES = np.array([0.0025, 0.005, 0.01, 0.02])  # T_eps over eps rho, for the speeds


def scene_with(*effects: Any) -> fx.Scene:
    profile = fx.profiles.Sine(0.1)
    bristle = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 0.5)
    parts = fx.supports.Spring(1.0), fx.loads.Ramp(1.0), 1.0
    return fx.Scene(profile, bristle, *parts, effects=effects)


def rho() -> np.ndarray:
    """To the right and to the left, in N."""
    law = fx.friction(scene_with())
    return np.array([float(law.rho_plus), float(law.rho_minus)])


def curves(eps: float, speeds: np.ndarray, energies: Any = None) -> xr.Dataset:
    """Friction both ways; at `T_eps = energies` in J, where given."""
    both = np.concatenate([speeds, -speeds])
    if energies is None:
        return fx.friction_curve(scene_with(), both, eps, GAMMA)
    noisy = scene_with(fx.effects.Noise(1.0))
    return fx.friction_curve(noisy, both, eps, GAMMA, temperatures=energies / eps)


def measured() -> xr.Dataset:
    """Over scale, eps and direction; and over share and speed at the reference."""
    bounds = rho()
    depth = SHARE * REFERENCE * np.mean(np.abs(bounds))
    rows, plain, errors, failed = [], [], [], 0
    for eps in EPS:
        energies = depth * np.array([scale(eps) for scale in SCALES.values()])
        found = curves(eps, np.array([SPEED]), energies)
        rows.append(found.friction_force.values / bounds)
        errors.append(np.abs(found.error.values / bounds))
        failed += int(np.sum(found.status.values != 0))
        plain.append(curves(eps, np.array([SPEED])).friction_force.values / bounds)
    energies = SHARES * REFERENCE * np.mean(np.abs(bounds))
    found = curves(REFERENCE, SPEEDS, energies)
    failed += int(np.sum(found.status.values != 0))
    still = curves(REFERENCE, SPEEDS)
    dims = "direction", "share", "speed"
    taken = np.abs(still.friction_force.values - found.friction_force.values)
    taken = taken.reshape(SHARES.size, 2, -1).transpose(1, 0, 2)
    known = "direction", "scale", "eps"
    return xr.Dataset(
        {
            "friction": (known, np.transpose(rows, (2, 1, 0))),
            "error": (known, np.transpose(errors, (2, 1, 0))),
            "without": (("direction", "eps"), np.transpose(plain)),
            "taken_at": (dims, taken / np.abs(bounds)[:, None, None]),
        },
        coords={
            "direction": [1, -1],
            "scale": list(SCALES),
            "eps": EPS,
            "share": SHARES,
            "speed": SPEEDS,
        },
        attrs={"failed": failed, "gamma": GAMMA, "speed": SPEED},
    )


def taken(data: xr.Dataset) -> xr.DataArray:
    """What noise takes of the friction, over rho."""
    return data.without - data.friction


def order(data: xr.Dataset, scale: str, last: int = 4) -> float:
    """Slope of what noise takes over the smallest eps, both ways together."""
    values = taken(data).sel(scale=scale).mean("direction").values[-last:]
    eps = data.eps.values[-last:]
    return float(np.polyfit(np.log(eps), np.log(np.abs(values)), 1)[0])


def _law(log_speed: np.ndarray, scale: float, fastest: float, power: float) -> np.ndarray:
    """Logarithm of `(scale (fastest - log v))^power`."""
    return power * (scale + np.log(np.maximum(fastest - log_speed, 1e-9)))


def power_of_logarithm(speeds: np.ndarray, values: np.ndarray) -> np.ndarray:
    """`scale`, `fastest`, `power` of the law, and half of the power's 95% interval."""
    x, y = np.log(speeds), np.log(values)
    start = (float(np.log(values[0] ** 1.5 / 15)), x[-1] + 3.0, 0.7)
    bounds = ([-50, x[-1] + 0.01, 0.05], [50, x[-1] + 100, 5])
    found, spread = optimize.curve_fit(_law, x, y, start, bounds=bounds, max_nfev=20000)
    half = special.stdtrit(x.size - 3, 0.975) * np.sqrt(spread[2, 2])
    return np.append(found, half)


def table(data: xr.Dataset) -> str:
    lines = ["| temperature | " + " | ".join(f"eps = {e:.3g}" for e in data.eps.values)]
    lines[0] += " | order of what is taken |"
    lines.append("|---" * (data.sizes["eps"] + 2) + "|")
    for scale in data.scale.values:
        row = data.friction.sel(scale=scale).values
        pairs = [f"{right:.4f}, {left:.4f}" for right, left in row.T]
        lines.append(f"| {scale} | {' | '.join(pairs)} | {order(data, scale):.2f} |")
    still = [f"{right:.4f}, {left:.4f}" for right, left in data.without.values.T]
    lines.append(f"| none | {' | '.join(still)} | |")
    lines.append("\n| T/(eps rho) | power of the logarithm, right | left |\n|---|---|---|")
    for share in data.share.values:
        cells = []
        for way in data.direction.values:
            values = data.taken_at.sel(direction=way, share=share).values
            _, _, power, half = power_of_logarithm(data.speed.values, values)
            cells.append(f"{power:.3f} +- {half:.3f}")
        lines.append(f"| {share:g} | {' | '.join(cells)} |")
    worst = float(data.error.max())
    lines.append(f"\nlargest error {worst:.1g} rho, {data.attrs['failed']} slides failed")
    return "\n".join(lines)


@styled
def picture(data: xr.Dataset) -> Figure:
    figure = Figure(figsize=(12.5, 4.2), layout="constrained")
    friction, lost, speeds = figure.subplots(1, 3)
    for colour, scale in zip(COLOURS, data.scale.values, strict=False):
        for way, style in ((1, "-"), (-1, ":")):
            row = data.sel(scale=scale, direction=way)
            look: dict[str, Any] = {"color": colour, "ls": style, "marker": "o", "ms": 3}
            label = f"T ~ {scale}" if way > 0 else None
            friction.semilogx(data.eps, row.friction, label=label, **look)
            lost.loglog(data.eps, row.without - row.friction, **look)
    for way, style in ((1, "-"), (-1, ":")):
        still = data.without.sel(direction=way)
        friction.semilogx(data.eps, still, color=LIMIT, ls=style, lw=1)
        lost.loglog(data.eps, 1 - still, color=GUIDE, ls=style, lw=1)
    friction.set(xlabel="eps in m", ylabel="mean friction over rho", ylim=(0, 1.05))
    friction.set_title("to the right; dotted: to the left; black: none")
    friction.legend(loc="lower right", fontsize=8)
    lost.set(xlabel="eps in m", ylabel="what noise takes, over rho")
    lost.set_title("grey: what eps takes without noise")
    fine = np.geomspace(data.speed.values[0], data.speed.values[-1], 200)
    for colour, share in zip(COLOURS, data.share.values, strict=False):
        for way, style in ((1, "-"), (-1, ":")):
            values = data.taken_at.sel(direction=way, share=share).values
            known = power_of_logarithm(data.speed.values, values)
            label = f"T/(eps rho) = {share:g}, power {known[2]:.2f}" if way > 0 else None
            speeds.semilogx(data.speed, values, "o", color=colour, ms=3)
            fitted = np.exp(_law(np.log(fine), *known[:3]))
            speeds.semilogx(fine, fitted, color=colour, ls=style, label=label)
    speeds.set(xlabel="speed in m/s", ylabel="what noise takes, over rho", ylim=(0, 1.3))
    speeds.set_title(f"(a log(v_c/v))^power at eps = {REFERENCE:g} m")
    speeds.legend(loc="best", fontsize=8)
    return figure


def main(folder: Path) -> None:
    jax.config.update("jax_enable_x64", True)
    fx.use_fast_cpu()
    began = time.perf_counter()
    data = measured()
    folder.mkdir(parents=True, exist_ok=True)
    data.to_netcdf(folder / "noise.nc")
    picture(data).savefig(folder / "noise.png", dpi=150)
    print(table(data))
    print(f"\n{time.perf_counter() - began:.0f} s")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
