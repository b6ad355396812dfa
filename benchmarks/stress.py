"""Thousands of random scenes against what the mathematics guarantees; prints Markdown.

    python benchmarks/stress.py [--scenes 10000] [--seed 0] [--minutes 240]

Admissible scenes: any bristle, support and load, slopes 0.01 to 0.5, supports on
which the tip follows within 1e-8 to 1 of the time, admissibility by 1e-3 to 1, eps for 3 to
300 wells under half of the load's range, gamma 0.5 to 2.5.
Each is checked alone, and by one of these: its brackets, its suprema, a second solution of
every slip at a thousandth of the tolerance, a start above, a shift by whole wells, a mirror
image, or other units. Inadmissible ones: an admissible scene with one fault, from a number
that is none to a surface that is too steep by 1e-9; each has to be refused with an error
that names the argument.
"""

import argparse
import collections
import re
import sys
import time
from pathlib import Path
from typing import NamedTuple

import jax
import numpy as np

import frictionjax as fx
from frictionjax.model.friction_coefficients import coefficients_jit as coefficients

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "support"))

import guarantees
import hard_scenes

fx.use_fast_cpu()
jax.config.update("jax_enable_x64", True)
fx.keep_compiled()  # 24 kinds of scenes compile for minutes

_BAD = (np.nan, np.inf, -np.inf, "one", None)


class Spoiled(NamedTuple):
    """An admissible case with one fault, and what the error must name."""

    numbers: dict
    eps: object
    gamma: object
    name: str


def _copied(case) -> dict:
    return {k: dict(v) if isinstance(v, dict) else v for k, v in case.numbers.items()}


def _changed(case, part: str, name: str, value) -> Spoiled:
    numbers = _copied(case)
    numbers[part][name] = value
    return Spoiled(numbers, case.eps, case.gamma, name)


def no_number(case, rng) -> Spoiled:
    """One number is none, or not finite."""
    bad = _BAD[rng.integers(len(_BAD))]
    in_array = np.nan if isinstance(bad, str) or bad is None else bad
    part = ("bristle", "support", "load", "z0", "cos", "duration")[rng.integers(6)]
    numbers = _copied(case)
    if part in ("z0", "duration"):
        return Spoiled(numbers | {part: bad}, case.eps, case.gamma, part)
    if part == "cos":
        cos = np.array([0.0, in_array, 0.0])
        return Spoiled(numbers | {"cos": cos}, case.eps, case.gamma, "cos")
    names = ["stiffness"] if part == "support" else sorted(numbers[part])
    name = names[rng.integers(len(names))]
    if name in ("times", "values"):
        bad = np.where(np.arange(5) == 2, in_array, numbers[part][name])
    return _changed(case, part, name, bad)


def not_positive(case, rng) -> Spoiled:
    """A number that has to be positive is 0 or less; times that do not rise."""
    value = -(10 ** rng.uniform(-3, 3)) * rng.integers(2)
    numbers, load = case.numbers, case.numbers["load"]
    if "times" in load and rng.integers(2):
        times = load["times"].copy()
        times[2] = times[1] + min(value, 0.0)
        return _changed(case, "load", "times", times)
    places = [("bristle", n) for n in ("stiffness", "height") if n in numbers["bristle"]]
    places += [("support", "stiffness"), ("", "duration")]
    places += [("load", "period")] * ("period" in load)
    part, name = places[rng.integers(len(places))]
    if not part:
        return Spoiled(_copied(case) | {name: value}, case.eps, case.gamma, name)
    spoiled = _changed(case, part, name, value)
    # A support of the user's own has no arguments.
    own = part == "support" and case.kind[1] != "spring"
    return spoiled._replace(name="support.stiffness") if own else spoiled


def too_short(case, rng) -> Spoiled | None:
    """A rod that does not reach the surface."""
    bristle = case.numbers["bristle"]
    if "length" not in bristle:
        return None
    return _changed(case, "bristle", "length", bristle["height"] * rng.uniform())


def too_steep(case, rng) -> Spoiled | None:
    """A surface that the bristle cannot follow, by a share of 1e-9 to 1 of its slopes."""
    scene = case.scene
    found, bounds = coefficients(scene.potential), scene.potential.bristle.slope_bounds()
    low, high, a = map(float, (found.omega_minus, found.omega_plus, found.a))
    limits = [float(bounds.upper) / high, float(bounds.lower) / low]
    limits += [-1 / (a * omega) for omega in (low, high) if a * omega < 0]
    factor = min(limits) * (1 + 10 ** rng.uniform(-9, 0))
    if not np.isfinite(factor):
        return None
    numbers = _copied(case)
    numbers["cos"], numbers["sin"] = (factor * numbers[k] for k in ("cos", "sin"))
    name = "bristle.theta_lim" if case.kind[0] == "angular" else "bristle.angle"
    return Spoiled(numbers, case.eps, case.gamma, name)


def flat(case, rng) -> Spoiled:
    """A surface without slopes of both signs."""
    none = {"cos": np.zeros(3), "sin": np.zeros(3)}
    return Spoiled(_copied(case) | none, case.eps, case.gamma, "profile.cos")


def no_force(case, rng) -> Spoiled | None:
    """A bristle that does not press on the surface: alpha = 0."""
    bristle = case.numbers["bristle"]
    if "alpha" in bristle:
        return _changed(case, "bristle", "alpha", 0.0)
    if "rest_length" not in bristle:
        return None
    rest = bristle["height"] / np.cos(bristle.get("angle", 0.0))
    return _changed(case, "bristle", "rest_length", rest)._replace(name="alpha")


def no_scale(case, rng) -> Spoiled:
    """An eps or gamma that is none."""
    bad = (0.0, -(10 ** rng.uniform(-3, 3)), *_BAD)[rng.integers(2 + len(_BAD))]
    spoiled = Spoiled(_copied(case), case.eps, case.gamma, "")
    name = ("eps", "gamma")[rng.integers(2)]
    return spoiled._replace(**{name: bad}, name=name)


FAULTS = (
    no_number,
    not_positive,
    too_short,
    too_steep,
    flat,
    no_force,
    no_scale,
)


def refusal(case, spoiled: Spoiled) -> str:
    """What is wrong with how a spoiled case is refused; empty where nothing is."""
    try:
        scene = hard_scenes.build(case.kind, spoiled.numbers)
        fx.solve(scene, spoiled.eps, spoiled.gamma, hard_scenes.TIMES[:2])
    except ValueError as error:
        named = re.search(rf"\b{spoiled.name} = ", str(error))
        return "" if named else f"does not name it: {error}"
    except Exception as error:  # anything else is a failure to refuse
        return f"another error: {error!r}"
    return "accepted"


def refused(count: int, rng) -> int:
    """Try scenes with one fault; how many are not refused as they should be."""
    good: list = []
    while len(good) < 4 * len(hard_scenes.KINDS):
        kind = hard_scenes.KINDS[len(good) % len(hard_scenes.KINDS)]
        try:
            good.append(hard_scenes.draw(kind, rng.uniform(size=hard_scenes.GENES)))
        except ValueError:
            continue
    times: collections.Counter = collections.Counter()
    wrong: list = []
    while times.total() < count:
        case = good[rng.integers(len(good))]
        fault = FAULTS[rng.integers(len(FAULTS))]
        spoiled = fault(case, rng)
        if spoiled is None:
            continue
        times[fault.__name__] += 1
        found = refusal(case, spoiled)
        if found:
            wrong.append((fault.__name__, case.kind, spoiled, found))
    print(f"\n{times.total()} inadmissible scenes, {len(wrong)} not refused as they should")
    for fault, number in times.most_common():
        print(f"- {fault}: {number}")
    for item in wrong[:10]:
        print("- violation:", *item, flush=True)
    return len(wrong)


def tried(count: int, minutes: float, rng) -> int:
    """Try admissible scenes; how many violate a guarantee."""
    states: collections.Counter = collections.Counter()
    worst: dict = collections.defaultdict(lambda: (0, -1.0, ""))
    begun, number, wrong = time.time(), 0, 0
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
            if np.isnan(value) and check is other:
                continue  # nothing to compare with
            times, most, _ = worst[check.__name__]
            text = f"{'-'.join(kind)}, eps {case.eps:.3g}, gamma {case.gamma:.3g}"
            worst[check.__name__] = (times + 1, *max((most, _), (value, text)))
            if not value <= 1:
                wrong += 1
                print(f"violation {value:.3g}: {check.__name__}, {text}, scene {number}")
                print(f"  genes {genes.tolist()}", flush=True)
    print(f"\n{number} admissible scenes in {time.time() - begun:.0f} s\n")
    for state, times in states.most_common():
        print(f"- {state}: {times}")
    print("\n| guarantee | tried | worst violation (1 is allowed) | where |")
    print("|---|---|---|---|")
    for name, (times, most, where) in sorted(worst.items()):
        print(f"| {name} | {times} | {most:.2g} | {where} |")
    return wrong


def main() -> None:
    """Try both kinds and print what was found."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--scenes", type=int, default=10_000)
    parser.add_argument("--inadmissible", type=int, default=None)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--minutes", type=float, default=240.0)
    options = parser.parse_args()
    rng = np.random.default_rng(options.seed)
    bad = options.scenes if options.inadmissible is None else options.inadmissible
    wrong = refused(bad, rng) + tried(options.scenes, options.minutes, rng)
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
