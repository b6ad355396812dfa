"""Predicted against measured memory of sweeps, each in a process of its own; Linux.

    python benchmarks/memory.py [--scenes vertical angular]

Each process makes a tiny sweep first, so that what is loaded once is there; then the sweep.
`before`, `most`: memory of the process before and at most (VmHWM), MB. `predicted`: by
`fx.predict_cost`; `ratio`: measured over that. `above`: what the sweep added, less what its
compiled loops take (`LOOPS`), and what is predicted above the machine's own.
"""

import argparse
import json
import subprocess
import sys
from pathlib import Path

import jax
import numpy as np
from scenes import NAMES, PERIOD, scene

import frictionjax as fx
from frictionjax.cost.machine_cost import machine_cost

fx.use_fast_cpu()
jax.config.update("jax_enable_x64", True)
fx.keep_compiled()

MANY, FEW = np.geomspace(1e-1, 1e-4, 100).tolist(), np.geomspace(1e-1, 1e-4, 16).tolist()
ALL = [0.5, 1.0, 2.0]
# eps, gamma, times, accuracy, method, whether energies are balanced
CASES = (
    ("48 cells", FEW, ALL, 61, 1e-3, "auto", True),
    ("48 cells", FEW, ALL, 401, 1e-3, "auto", True),
    ("48 cells", FEW, ALL, 401, 1e-5, "auto", True),
    ("16 cells", FEW, [0.5], 61, 1e-3, "auto", True),
    ("300 cells", MANY, ALL, 61, 1e-3, "auto", True),
    ("300 cells", MANY, ALL, 401, 1e-3, "auto", True),
    ("eps 1e-6", [1e-6], [1.0], 61, 1e-3, "auto", True),
    ("eps 1e-5", [1e-5], [1.0], 20001, 1e-3, "auto", True),
    ("eps 1e-5", [1e-5], [1.0], 100001, 1e-3, "auto", True),
    ("eps 1e-3", [1e-3], [1.0], 200001, 1e-3, "resolved", True),
    ("16 cells", FEW, [1.0], 4001, 1e-3, "auto", True),
    ("16 cells", FEW, [1.0], 4001, 1e-3, "auto", False),
    ("16 cells", FEW, [1.0], 40001, 1e-3, "resolved", True),
)
LOOPS = 7e7  # bytes that compiled loops of another size or kind take


def peak() -> float:
    """Most memory that this process has had, bytes."""
    lines = Path("/proc/self/status").read_text(encoding="ascii").splitlines()
    return 1024 * float(next(x for x in lines if x.startswith("VmHWM")).split()[1])


def measure(name: str, number: int) -> dict[str, float]:
    """What one case takes in this process."""
    _, eps, gamma, times, accuracy, method, balanced = CASES[number]
    one, ts = scene(name), np.linspace(0.0, PERIOD, times)
    fx.sweep(one, 0.1, 1.0, ts[[0, -1]], 1e-3, dissipation=balanced)
    before = peak()
    cost = fx.predict_cost(one, eps, gamma, accuracy, ts, method)
    data = fx.sweep(one, eps, gamma, ts, accuracy, method, dissipation=balanced)
    failed = int(np.count_nonzero(data.status))
    most = peak()
    return {"before": before, "most": most, "predicted": cost.memory, "failed": failed}


def row(name: str, number: int) -> str:
    """A line of the table, measured in a process of its own."""
    child = [sys.executable, __file__, "--case", name, str(number)]
    answer = subprocess.run(child, check=True, capture_output=True, text=True)
    found = json.loads(answer.stdout.splitlines()[-1])
    what, _, gamma, times, accuracy, method, balanced = CASES[number]
    added = found["most"] - found["before"] - LOOPS
    predicted = found["predicted"] - machine_cost().memory
    sizes = " | ".join(f"{found[k] / 1e6:.0f}" for k in ("before", "most", "predicted"))
    which = f"{method}{'' if balanced else ', no energies'}"
    kind = f"{what}, gamma {', '.join(f'{g:g}' for g in gamma)}"
    above = f"{added / 1e6:.0f} / {predicted / 1e6:.0f}"
    return (
        f"| {name} | {kind} | {times} | {accuracy:.0e} | {which} | {sizes} | "
        f"{found['most'] / found['predicted']:.2f} | {above} |"
    )


def main() -> None:
    """Print how far predictions are off."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--scenes", nargs="*", choices=NAMES, default=NAMES)
    parser.add_argument("--case", nargs=2, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.case:
        print(json.dumps(measure(options.case[0], int(options.case[1]))))
        return
    machine_cost()
    print(
        "| scene | sweep | times | accuracy | method | before | most | predicted | ratio | "
        "above, MB |\n|" + "---|" * 10
    )
    for name in options.scenes:
        for number in range(len(CASES)):
            print(row(name, number), flush=True)


if __name__ == "__main__":
    main()
