"""A sweep against compiled solvers, at equal accuracy, on both cores; prints Markdown.

    python benchmarks/sweep.py [--scene vertical|angular] [--gamma 0.5 1 2] [--cells 16]
        [--smallest 1e-4] [--patience 20] [--peers heyoka numbalsoda ...]

16 eps from 0.1 to 1e-4, one sweep of all gamma, and one of each. Error: max over 61
times, those inside a slip left out, in units of eps, against our own method at accuracy
1e-6. A cell's time for us is its share of the sweep of all (also: solved alone); for a peer
that of a lane while both cores run such cells, at the loosest tolerance of those tried that
reaches 1e-3 eps. Both find z at the times and nothing else; `suprema`: our sweep with
sup |z_eps - z| over [0, T] beside it. Wall seconds; CPU seconds where said, which other
programs on the machine change less. All warm; compilation is printed apart. A peer that
runs out of patience (seconds a run) is left out from there on.
"""

import argparse

import numpy as np
from cores import Cores
from ours import Timed, solve, timed
from peers import COMPILED, PEERS, installed
from scenes import NAMES, scene
from truth import ACCURACY, error_of, own

from frictionjax.wiggly import Status

TOLERANCES = (1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-10)
_A_WELL = 0.5  # eps: an error that means another well
# What ours is asked for: z at the times, as peers are; the same with suprema over [0, T];
# every slip.
_METHODS = {"auto": ("auto",), "suprema": ("auto", True), "resolved": ("resolved",)}


class Contest:
    """Each peer's cheapest tolerance, cell by cell, and what failed on the way."""

    def __init__(self, scene: str, peers: list[str], patience: float):
        self.scene, self.peers, self.patience = scene, peers, patience
        self.cores, self.left_out = Cores(), set()
        self.failures, self.compiled = [], dict.fromkeys(peers, 0.0)

    def cheapest(self, name: str, eps: float, gamma: float, truth) -> tuple:
        """Both-core seconds a cell, wall and CPU, and a text with error and tolerance."""
        if (name, gamma) in self.left_out:
            return np.inf, np.inf, "-"
        met = []
        for tolerance in TOLERANCES:
            job = name, self.scene, eps, gamma, tolerance
            found = self.cores.solve(job, self.patience)
            self.compiled[name] = max(self.compiled[name], found.compiled)
            error = np.inf if found.failure else error_of(found.z, truth, eps)
            if error <= ACCURACY:
                text = f"{found.seconds:.2g} ({error:.0e}, {tolerance:.0e})"
                return found.seconds, found.cpu, text
            if not found.failure and error > _A_WELL:
                self.failures.append(
                    f"{name}, gamma {gamma:g}, eps {eps:.2g}, {tolerance:.0e}: "
                    f"{error:.2g} eps off, success reported"
                )
            met.append(f"{tolerance:.0e}: {found.failure or f'{error:.1e} eps off'}")
            if found.failure.startswith("> "):
                self.left_out.add((name, gamma))
                break
        self.failures.append(f"{name}, gamma {gamma:g}, eps {eps:.2g}: {'; '.join(met)}")
        return np.inf, np.inf, "failed"


def report(run: Timed, eps: np.ndarray, gamma: np.ndarray, truths, method: str):
    """Errors by cell of our sweep; prints a line about the whole."""
    found, best, worst, first, cpu = run
    cells = zip(found.z, truths, eps, strict=True)
    errors = np.array([error_of(z, truth, e) for z, truth, e in cells])
    bad = {Status.of(s).name for s in found.status if s != 0}
    gammas = ", ".join(f"{g:g}" for g in np.unique(gamma))
    print(
        f"ours, {method}, gamma {gammas}: {best:.3f} s for {eps.size} cells "
        f"({worst:.3f} at worst, CPU {cpu:.3f}); first call {first:.1f} s; "
        f"largest error {np.nanmax(errors):.1e} eps; status {', '.join(bad) or 'OK'}",
        flush=True,
    )
    return errors


def alone(one, eps: float, gamma: float) -> float:
    return timed(lambda: solve(one, eps, gamma, ACCURACY), 3)[1]


def table(contest: Contest, eps: np.ndarray, gamma: float, truths, errors, share: float):
    """Rows of one gamma; wall and CPU of the fastest peers, NaN where none ends."""
    one = scene(contest.scene)
    names = " | ".join(contest.peers)
    print(f"\n| gamma | eps | our error | share, s | alone, s | {names} | peer/share |")
    print("|---" * (6 + len(contest.peers)) + "|")
    fastest = []
    for e, truth, error in zip(eps, truths, errors, strict=True):
        met = [contest.cheapest(name, float(e), gamma, truth) for name in contest.peers]
        wall, cpu = np.min([(np.inf, np.inf), *(m[:2] for m in met)], axis=0)
        fastest.append((wall, cpu) if np.isfinite(wall) else (np.nan, np.nan))
        ratio = f"{wall / share:.2g}" if np.isfinite(wall) else "-"
        columns = [f"{gamma:g}", f"{e:.2g}", f"{error:.0e}", f"{share:.2g}"]
        columns += [f"{alone(one, e, gamma):.2g}", *(m[2] for m in met), ratio]
        print(f"| {' | '.join(columns)} |", flush=True)
    return np.array(fastest)


def compare(name: str, fastest: np.ndarray, shares: float, own: Timed) -> None:
    """Prints the fastest peers of some cells, added up, beside ours.

    `shares`: of these cells in the sweep of all, s; `own`: a sweep of nothing else.
    """
    wall, cpu = fastest.T
    ended = np.isfinite(wall)
    part = ended.mean() or 1.0
    added, busy = np.nansum(wall), 2 * np.nansum(cpu)
    print(
        f"{name}: fastest peers added up {added:.3f} s over {ended.sum()} of "
        f"{ended.size} cells, {added / (part * shares):.2g} times our shares of the sweep "
        f"of all, {added / (part * own.best):.2g} times a sweep of these alone; in CPU "
        f"seconds {busy:.3f}, {busy / (part * own.cpu):.2g} times the latter",
        flush=True,
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--scene", choices=NAMES, default="vertical")
    parser.add_argument("--gamma", type=float, nargs="+", default=[0.5, 1.0, 2.0])
    parser.add_argument("--largest", type=float, default=0.1)
    parser.add_argument("--smallest", type=float, default=1e-4)
    parser.add_argument("--cells", type=int, default=16)
    parser.add_argument("--patience", type=float, default=20.0)
    usual = [name for name in installed() if name in COMPILED]
    parser.add_argument("--peers", nargs="*", default=usual, choices=PEERS)
    parser.add_argument("--methods", nargs="+", default=list(_METHODS), choices=_METHODS)
    chosen = parser.parse_args()
    eps = np.geomspace(chosen.largest, chosen.smallest, chosen.cells)
    contest = Contest(chosen.scene, chosen.peers, chosen.patience)
    print(f"scene: {chosen.scene}")
    one = scene(chosen.scene)
    every = np.repeat(chosen.gamma, eps.size)
    # Each gamma, those where windows are short, and all.
    groups = [[gamma] for gamma in chosen.gamma]
    groups += [[g for g in chosen.gamma if g >= 1]] * (len(chosen.gamma) > 2)

    def sweep(gammas: list[float], method: str) -> Timed:
        cells = np.tile(eps, len(gammas)), np.repeat(gammas, eps.size)
        return timed(lambda: solve(one, *cells, ACCURACY, *_METHODS[method]))

    # Before the references, so that the first calls of the first sweep compile.
    whole = [sweep(chosen.gamma, method) for method in chosen.methods]
    solo = [[sweep(group, method) for method in chosen.methods] for group in groups]
    cells = np.tile(eps, len(chosen.gamma)), every
    truths = [own(one, float(e), float(g)) for e, g in zip(*cells, strict=True)]
    errors = [
        report(run, *cells, truths, method)
        for run, method in zip(whole, chosen.methods, strict=True)
    ]
    for group, runs in zip(groups, solo, strict=True):
        mine = np.flatnonzero(np.isin(every, group))
        rows = cells[0][mine], every[mine], [truths[i] for i in mine]
        for run, method in zip(runs, chosen.methods, strict=True):
            report(run, *rows, method)
    share, fastest = whole[0].best / every.size, np.empty((every.size, 2))
    for gamma in chosen.gamma:
        mine = np.flatnonzero(every == gamma)
        rows = [truths[i] for i in mine], errors[0][mine], share
        fastest[mine] = table(contest, eps, gamma, *rows)
    print()
    for group, runs in zip(groups, solo, strict=True):
        mine = np.isin(every, group)
        name = "gamma " + ", ".join(f"{g:g}" for g in group)
        compare(name, fastest[mine], share * mine.sum(), runs[0])
    for run, method in zip(whole, chosen.methods, strict=True):
        compare(f"all, {method}", fastest, run.best, run)
    contest.cores.stop()
    compiled = ", ".join(f"{n} {s:.1f} s" for n, s in contest.compiled.items())
    print(f"compilation: {compiled}")
    for line in contest.failures:
        print(f"not accurate: {line}")


if __name__ == "__main__":
    main()
