"""Thousands of random scenes against what the mathematics guarantees; prints Markdown.

    python benchmarks/stress.py [--scenes 10000] [--seed 0] [--minutes 60]

Admissible scenes: any bristle, support and load, slopes 0.01 to 0.5, supports of 1e-3 to
1e3 N/m, admissibility by 1e-3 to 1, eps for 3 to some thousand slips, gamma 0.5 to 2.5.
Each is checked alone, and against a second solution: every slip at a thousandth of the
tolerance, a start above, a shift by whole wells, a mirror image, or other units.
Inadmissible ones: an admissible scene with one number that is not allowed; each has to be
refused with an error that names the argument.
"""

import argparse
import collections
import sys
import time
from pathlib import Path

import jax
import numpy as np

import frictionjax as fx

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

import guarantees
import hard_scenes

fx.use_fast_cpu()
jax.config.update("jax_enable_x64", True)
fx.keep_compiled()  # 24 kinds of scenes compile for minutes

_BAD = (np.nan, np.inf, -np.inf, "one", None)


def spoiled(case, rng):
    """Numbers of a scene with one that is not allowed, and what the error must name."""
    numbers = {k: dict(v) if isinstance(v, dict) else v for k, v in case.numbers.items()}
    bad = _BAD[rng.integers(len(_BAD))]
    part = ("bristle", "support", "load", "z0", "cos", "duration")[rng.integers(6)]
    if part in ("z0", "duration"):
        numbers[part] = bad
        return numbers, part
    if part == "cos":
        value = np.nan if isinstance(bad, str) or bad is None else bad
        numbers["cos"] = np.array([0.0, value, 0.0])
        return numbers, "cos"
    names = sorted(numbers[part])
    if part == "support":
        names = ["stiffness"]
    name = names[rng.integers(len(names))]
    if name in ("times", "values"):
        value = np.nan if isinstance(bad, str) or bad is None else bad
        numbers[part][name] = np.where(np.arange(5) == 2, value, numbers[part][name])
    else:
        numbers[part][name] = bad
    return numbers, name


def refused(count: int, rng) -> None:
    """Try scenes with one bad number."""
    kinds = [kind for kind in hard_scenes.KINDS if kind[1] == "spring"]
    good, tried, silent, unnamed = [], 0, [], []
    while len(good) < 4 * len(kinds):
        kind = kinds[len(good) % len(kinds)]
        try:
            good.append(hard_scenes.draw(kind, rng.uniform(size=hard_scenes.GENES)))
        except ValueError:
            continue
    while tried < count:
        case = good[tried % len(good)]
        numbers, name = spoiled(case, rng)
        tried += 1
        try:
            hard_scenes.build(case.kind, numbers)
            silent.append((case.kind, name, numbers))
        except ValueError as error:
            if name not in str(error):
                unnamed.append((name, str(error)))
        except Exception as error:  # anything else is a failure to refuse
            unnamed.append((name, repr(error)))
    print(
        f"\n{tried} inadmissible scenes: {len(silent)} accepted, "
        f"{len(unnamed)} refused without naming the argument"
    )
    for item in (silent + unnamed)[:10]:
        print("-", item)


def tried(count: int, minutes: float, rng) -> None:
    """Try admissible scenes."""
    states: collections.Counter = collections.Counter()
    worst: dict = collections.defaultdict(lambda: (0, -1.0, ""))
    begun, number = time.time(), 0
    while number < count and time.time() - begun < 60 * minutes:
        kind = hard_scenes.KINDS[number % len(hard_scenes.KINDS)]
        genes = rng.uniform(size=hard_scenes.GENES)
        try:
            case = hard_scenes.draw(kind, genes)
            found = guarantees.solved(case)
        except ValueError:
            states["not admissible, drawn again"] += 1
            continue
        number += 1
        states[found.status.name] += 1
        other = guarantees.COMPARED[rng.integers(len(guarantees.COMPARED))]
        checks = (*guarantees.ALONE, other) if found.ok else (guarantees.finite,)
        for check in checks:
            value = float(check(case, found))
            if np.isnan(value):
                continue
            times, most, _ = worst[check.__name__]
            text = f"{'-'.join(kind)}, eps {case.eps:.3g}, gamma {case.gamma:.3g}"
            worst[check.__name__] = (times + 1, *max((most, _), (value, text)))
            if value > 1:
                print(f"violation {value:.3g}: {check.__name__}, {text}, scene {number}")
                print(f"  genes {genes.tolist()}", flush=True)
    print(f"\n{number} admissible scenes in {time.time() - begun:.0f} s\n")
    for state, times in states.most_common():
        print(f"- {state}: {times}")
    print("\n| guarantee | tried | worst violation (1 is allowed) | where |")
    print("|---|---|---|---|")
    for name, (times, most, where) in sorted(worst.items()):
        print(f"| {name} | {times} | {most:.2g} | {where} |")


def main() -> None:
    """Try both kinds and print what was found."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--scenes", type=int, default=10_000)
    parser.add_argument("--inadmissible", type=int, default=None)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--minutes", type=float, default=60.0)
    options = parser.parse_args()
    rng = np.random.default_rng(options.seed)
    bad = options.scenes if options.inadmissible is None else options.inadmissible
    refused(bad, rng)
    tried(options.scenes, options.minutes, rng)


if __name__ == "__main__":
    main()
