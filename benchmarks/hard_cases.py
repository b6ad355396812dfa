"""Hard scenes: what makes each hard, what general solvers do on it, and ours; Markdown.

    python benchmarks/hard_cases.py

The scenes of tests/test_hard_cases.py at 61 times. Error: largest of z outside slips, in
eps, against SciPy's LSODA at 1e-11 with steps no longer than a slip, on a field written by
hand. General solvers: SciPy's at rtol = atol = 1e-5 without that bound, 10 s allowed; ours
at accuracy 1e-3. Seconds: of one warm run.
"""

import sys
import time
from pathlib import Path

import jax
import numpy as np

import frictionjax as fx
from frictionjax.instants import slips_of
from frictionjax.wiggly.general import SCIPY, run_scipy

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

import reference
from test_hard_cases import HARD, TIMES, scene_of, system_of

fx.use_fast_cpu()
jax.config.update("jax_enable_x64", True)


def row(name: str) -> str:
    """One scene as a line of the table."""
    one = HARD[name]
    scene = scene_of(one)
    plain = reference.solve(system_of(one), one.eps, one.gamma, one.z0, TIMES)

    def error(z) -> str:
        gaps = np.abs(np.asarray(z) - plain.z)[~plain.in_slip] / one.eps
        return f"{gaps.max():.1e}" if np.all(np.isfinite(gaps)) else "-"

    cells = []
    for method in SCIPY:
        run = run_scipy(scene, one.eps, one.gamma, TIMES, 1e-5, method, 10.0)
        cells.append(f"{error(run.z)} {run.status.name.lower()}")
    fx.solve(scene, one.eps, one.gamma, TIMES)
    begun = time.perf_counter()
    found = fx.solve(scene, one.eps, one.gamma, TIMES)
    seconds = time.perf_counter() - begun
    ours = f"{error(found.z)} {found.status.name.lower()}, {seconds:.2g} s"
    slips = slips_of(fx.Scene(*_parts(scene)), one.eps)
    return f"| {name} | {one.why} | {slips:.0f} | {' | '.join(cells)} | {ours} |"


def _parts(scene) -> tuple:
    """The scene from a start inside the strip: the limit has none outside."""
    return scene.profile, scene.bristle, scene.support, scene.load, scene.duration


def main() -> None:
    """Print the table."""
    print(f"| scene | what is hard | slips | {' | '.join(SCIPY)} | ours |")
    print("|" + "---|" * (4 + len(SCIPY)))
    for name in HARD:
        print(row(name), flush=True)


if __name__ == "__main__":
    main()
