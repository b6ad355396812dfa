"""The words of a report, for readers who meet them for the first time."""

from collections.abc import Iterable

from ..._text import ResultTable
from ...wiggly import Status
from ..page import Section, definitions

_WORDS = {
    "eps": (
        "The distance between two bumps of the surface, in m; \u03b5 in formulas. Real "
        "surfaces have one; here it is made smaller and smaller, to see what is left."
    ),
    "gamma": (
        "How weak viscosity becomes with the bumps: it is eps^gamma, in N s/m; "
        "\N{GREEK SMALL LETTER GAMMA} in formulas. The larger gamma, the less the speed "
        "matters."
    ),
    "state z": "Where the root of the bristle is, in m, but for a constant.",
    "limit": (
        "The same scene with dry friction, which does not depend on the speed, instead of "
        "bumps and viscosity. It has no eps."
    ),
    "order": (
        "How fast an error falls with eps: as eps^order. With order 1, bumps of half the "
        "size leave half the error. An interval of 95% says how well the order is known."
    ),
    "strip": (
        "All states at which friction can hold the bristle under the load of a moment, "
        "from z_minus to z_plus. The limit never leaves it."
    ),
    "rho": (
        "The friction force: rho_plus against motion to the right, rho_minus against "
        "motion to the left, in N."
    ),
    "rho_with": (
        "Friction with the nap, in N; rho_against is that against it, and rho_flipped that "
        "of a rod that has turned over, moved as before. All positive."
    ),
    "dissipation": "The energy that has become heat since the start, in J.",
    "cell": "One eps with one gamma: one computation.",
    "slip": "The quick way from one hollow of the surface into the next.",
    "bracket": (
        "Two computations, one that starts provably below the true state and one above. "
        "They cannot cross: once they have met, the state between them is proven."
    ),
    "slip map": (
        "From the time of one slip to that of the next, where slips are too many to follow."
    ),
    "residual": (
        "By how much the energy balance of a computed motion fails to close, in J. It is "
        "zero for the true motion and for no other: a check that does not ask how the "
        "motion was computed."
    ),
    "nap": (
        "The direction in which bristles lean. With the nap the tip trails behind the "
        "root, as when a cat is stroked; against it the tip is pushed ahead."
    ),
    "critical load": (
        "The compression at which a straight rod buckles, in N: pi^2 B/L^2 of its "
        "bending stiffness B and its length L."
    ),
    "accuracy": "The error that was asked for, of z in units of eps.",
    "reference": (
        "What runs are judged by: the same motion computed at tighter tolerances in two "
        "ways that do not share their errors. Below their difference nothing is known."
    ),
    "alpha": "The force that presses the tip onto the surface without friction, in N.",
    "omega": "The steepest slopes of the surface, up (omega_plus) and down (omega_minus).",
    "ratio": "Friction to the right over friction to the left, -rho_plus/rho_minus.",
}
_VERDICTS = (
    ("converges", "the interval of the order lies above 0: the error vanishes as eps -> 0"),
    ("diverges", "the interval lies below 0: the error grows as eps -> 0"),
    ("undecided", "the interval holds 0: nothing can be said"),
    ("too few points", "too few cells are left to say anything of an order"),
    ("no power", "the errors do not follow a power of eps"),
    ("not yet seen", "errors follow the law of theory, but not yet its power of eps"),
)


def words_section(names: Iterable[str]) -> Section:
    """What these words mean."""
    return Section("Words", [definitions([(name, _WORDS[name]) for name in names])])


def status_legend(used: Iterable[int]) -> ResultTable:
    """All statuses of a computation: what each means, and how many cells have it."""
    counts = list(used)
    rows = [(one.name.lower(), str(counts.count(int(one))), one.message) for one in Status]
    return ResultTable(("status", "here", "meaning"), tuple(rows), left=1, meanings=1)


def verdict_legend() -> ResultTable:
    """What the verdict on an order means."""
    return ResultTable(("verdict", "meaning"), _VERDICTS, left=2)
