"""One cell: time and error reached of every solver at every tolerance; prints Markdown.

    python benchmarks/solvers.py [--scene vertical|angular] [--eps 1e-2] [--gamma 1]
        [--patience 20] [--guarded] [--peers ...]

Error: max over 61 times, those inside a slip left out, in units of eps, against SciPy's
LSODA at tolerance 1e-11 with steps no longer than a slip. Seconds are warm, of a cell that
has both cores: for us as measured, for a peer half of what two processes take that each
solve such a cell at once (heyoka and diffrax: a batch of such cells). SciPy and CVODE call
a compiled field from Python. Compilation apart.
"""

import argparse

import numpy as np
from cores import Cores
from ours import solve, timed
from peers import PEERS, installed
from scenes import NAMES, scene
from truth import error_of, independent

ACCURACIES = (1e-2, 1e-3, 1e-4)
TOLERANCES = (1e-4, 1e-6, 1e-8, 1e-10)
OURS = ("auto", "resolved")


def row(name: str, asked: float, error: float, seconds: float, compiled: float) -> None:
    print(
        f"| {name} | {asked:g} | {error:.1e} | {seconds:.3g} | {compiled:.1f} |", flush=True
    )


def own_rows(one, eps: float, gamma: float, truth) -> None:
    for method in OURS:
        for asked in ACCURACIES:
            found, best, _, first, _ = timed(
                lambda m=method, a=asked: solve(one, eps, gamma, a, m)
            )
            name = f"frictionjax, {method}"
            row(name, asked, error_of(found.z[0], truth, eps), best, first - best)


def guarded_rows(one, eps: float, gamma: float, truth) -> None:
    """Diffrax's implicit solvers inside our own integration, which guards the wells."""
    from scenes import TIMES

    import frictionjax as fx

    for method in ("Kvaerno3", "Kvaerno5"):
        for asked in ACCURACIES[1:]:
            found, best, _, first, _ = timed(
                lambda m=method, a=asked: np.asarray(
                    fx.solve(one, eps, gamma, TIMES, a, m, dissipation=False).z
                )
            )
            name = f"{method}, guarded by frictionjax"
            row(name, asked, error_of(found, truth, eps), best, first - best)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--scene", choices=NAMES, default="vertical")
    parser.add_argument("--eps", type=float, default=1e-2)
    parser.add_argument("--gamma", type=float, default=1.0)
    parser.add_argument("--patience", type=float, default=20.0)
    parser.add_argument("--peers", nargs="*", default=installed(), choices=PEERS)
    parser.add_argument("--guarded", action="store_true", help="10 s a row at eps = 1e-3")
    chosen = parser.parse_args()
    eps, gamma = chosen.eps, chosen.gamma
    truth = independent(chosen.scene, eps, gamma)
    counted = truth[1].sum()
    print(
        f"{chosen.scene}, eps = {eps:g}, gamma = {gamma:g}, {counted} of 61 times counted"
    )
    print("\n| method | asked | error/eps | s | compile s |")
    print("|---|---|---|---|---|")
    own_rows(scene(chosen.scene), eps, gamma, truth)
    if chosen.guarded:
        guarded_rows(scene(chosen.scene), eps, gamma, truth)
    cores, failures = Cores(), []
    for name in chosen.peers:
        for tolerance in TOLERANCES:
            job = name, chosen.scene, eps, gamma, tolerance
            found = cores.solve(job, chosen.patience)
            if found.failure:
                failures.append(f"{name} at {tolerance:g}: {found.failure}")
                if found.failure.startswith("> "):
                    break
                continue
            error = error_of(found.z, truth, eps)
            row(name, tolerance, error, found.seconds, found.compiled)
    cores.stop()
    print("\n".join(["", *failures]))


if __name__ == "__main__":
    main()
