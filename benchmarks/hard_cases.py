"""Hard scenes: what makes each hard, what general solvers do on it, and ours.

    python benchmarks/hard_cases.py [--only NAME ...] [--picture-only]

Prints Markdown and draws benchmarks/hard_scenes.png. The scenes of tests/hard at 61 times.
Error: largest of z outside slips, in eps, against the scene's independent reference (a
plain integration, from which whole periods of long slides are cut out, or slips without
duration). General solvers at atol = 1e-5 periods, rtol next to nothing, 10 s allowed:
SciPy's, and diffrax's Kvaerno5 with 2e5 steps, none with a guard against steps over wells.
In bold: half an eps or more off, and success reported. Ours at accuracy 1e-3; seconds of
one warm run.
"""

import argparse
import sys
import time
from pathlib import Path

import equinox as eqx
import jax
import numpy as np

import frictionjax as fx
from frictionjax.cost.instants import slips_of
from frictionjax.cost.scipy_solvers import SCIPY, run_scipy
from frictionjax.model.strip import strips_at

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "support"))

from catalogue import HARD
from hard_picture import draw
from unguarded import kvaerno5

fx.use_fast_cpu()
jax.config.update("jax_enable_x64", True)

_TOLERANCE, _SECONDS = 1e-5, 10.0
_SILENT = 0.5  # eps


def _slips(one, scene) -> str:
    """Wells that the limit passes, from the start in the strip that is nearest."""
    law = fx.friction(scene)
    rho = float(law.rho_plus), float(law.rho_minus)
    _, low, high = strips_at(scene, *rho, np.zeros(1))
    inside = np.clip(one.z0, float(low[0]), float(high[0]))
    start = eqx.tree_at(lambda s: s.z0, scene, jax.numpy.asarray(inside))
    slips = slips_of(start, one.eps)
    return f"{slips:.0f}" if slips < 1e5 else f"{slips:.1e}"


def _cell(one, expected, z, status: str) -> str:
    gaps = np.abs(np.asarray(z) - expected.z)[~expected.in_slip] / one.eps
    if not np.all(np.isfinite(gaps)):
        return f"- {status}"
    text = f"{gaps.max():.1e} {status}"
    return f"**{text}**" if status == "ok" and gaps.max() >= _SILENT else text


def row(name: str) -> str:
    """One scene as a line of the table."""
    one = HARD[name]
    scene, expected = one.build(), one.truth(one, one.ts)
    cells = []
    for method in SCIPY:
        options = one.ts, _TOLERANCE, method, _SECONDS
        run = run_scipy(scene, one.eps, one.gamma, *options)
        cells.append(_cell(one, expected, run.z, run.status.name.lower()))
    cells.append(_cell(one, expected, *kvaerno5(scene, one, _TOLERANCE)))
    fx.solve(scene, one.eps, one.gamma, one.ts)
    begun = time.perf_counter()
    found = fx.solve(scene, one.eps, one.gamma, one.ts)
    seconds = time.perf_counter() - begun
    ours = _cell(one, expected, found.z, found.status.name.lower())
    lines = [name, one.why, _slips(one, scene), *cells, f"{ours}, {seconds:.2g} s"]
    return f"| {' | '.join(lines)} |"


def main() -> None:
    """Print the table and draw the picture."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--only", nargs="+", default=list(HARD))
    parser.add_argument("--picture-only", action="store_true")
    options = parser.parse_args()
    if not options.picture_only:
        methods = [*SCIPY, "Kvaerno5"]
        print(f"| scene | what is hard | slips | {' | '.join(methods)} | ours |")
        print("|" + "---|" * (4 + len(methods)))
        for name in options.only:
            print(row(name), flush=True)
    if options.only == list(HARD):
        draw(HARD, Path(__file__).parent / "hard_scenes.png")


if __name__ == "__main__":
    main()
