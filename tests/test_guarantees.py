"""Random scenes against what the mathematics guarantees of every solution."""

import guarantees
import hard_scenes
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

# Each kind compiles its own programs; benchmarks/stress.py tries all of them.
QUICK, SLOW = ("slanted", "spring", "piecewise"), ("vertical", "stiffening", "sine")
KINDS = [QUICK, pytest.param(SLOW, marks=pytest.mark.slow)]
PAIRS = [
    *((QUICK, check) for check in guarantees.COMPARED),
    *(
        pytest.param(SLOW, check, marks=pytest.mark.slow)
        for check in guarantees.COMPARED
        if check is not guarantees.knows_no_origin  # there is one only on a spring
    ),
]
GENES = st.lists(
    st.floats(0, 1, width=16), min_size=hard_scenes.GENES, max_size=hard_scenes.GENES
)
ANY = {"deadline": None, "derandomize": True, "database": None}


def solved(kind, genes):
    """A case and its solution, of genes that make an admissible scene."""
    try:
        case = hard_scenes.draw(kind, genes)
        found = guarantees.solved(case)
    except ValueError:  # not admissible, at this eps
        assume(False)
    assert guarantees.finite(case, found) == 0
    assume(found.ok)
    return case, found


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: "-".join(kind))
@settings(max_examples=10, **ANY)
@given(genes=GENES)
def test_guarantees_hold(kind, genes):
    case, found = solved(kind, genes)
    for check in guarantees.ALONE:
        violation = check(case, found)
        assert violation <= 1, (check.__name__, violation, case)


@pytest.mark.parametrize(
    ("kind", "check"), PAIRS, ids=lambda v: getattr(v, "__name__", None) or "-".join(v)
)
@settings(max_examples=4, **ANY)
@given(genes=GENES)
def test_solutions_agree(kind, check, genes):
    case, found = solved(kind, genes)
    violation = check(case, found)
    assume(not np.isnan(violation))  # nothing to compare with
    assert violation <= 1, (violation, case)


@pytest.mark.slow
@pytest.mark.parametrize("exponent", [-9, 9])
def test_units_do_not_matter(exponent):
    # A support given as a function once lost its root where states were 1e-8 m.
    rng = np.random.default_rng(0)
    case = hard_scenes.draw(
        ("vertical", "stiffening", "sine"), rng.uniform(size=hard_scenes.GENES)
    )
    found = guarantees.solved(case)
    length, force = 10.0**exponent, 10.0 ** (-exponent / 2)
    assert guarantees.knows_no_units(case, found, length, force) < 1


def changed(field, change, kind):
    """A scene with one of its solution's numbers changed."""
    rng = np.random.default_rng(0)
    case = hard_scenes.draw(kind, rng.uniform(size=hard_scenes.GENES))
    found = guarantees.solved(case)
    return case, Changed(found, field, change)


class Changed:
    """A solution, one field of which is wrong."""

    ok = True

    def __init__(self, found, field, change):
        self._found, self._field, self._change = found, field, change

    def __getattr__(self, name):
        value = getattr(self._found, name)
        return self._change(np.asarray(value)) if name == self._field else value


@pytest.mark.parametrize(
    ("check", "field", "change"),
    [
        (guarantees.finite, "z", lambda z: z * np.nan),
        (guarantees.dissipates, "dissipation", lambda d: d[::-1]),
        (guarantees.balance_closes, "residual", lambda r: r + 1e3),
        (guarantees.stays_near_the_strip, "z", lambda z: z + 1e15 * np.arange(41)),
        (guarantees.stays_near_the_limit, "z", lambda z: z + 1e15),
        (guarantees.is_accurate, "z", lambda z: z * 1.01),
        (guarantees.keeps_order, "z", lambda z: z + 1e3),
        (guarantees.knows_no_origin, "z", lambda z: z * 1.01),
        (guarantees.knows_no_left, "z", lambda z: z * 1.01),
        (guarantees.knows_no_units, "z", lambda z: z * 1.01),
    ],
    ids=lambda v: getattr(v, "__name__", None),
)
def test_checks_see_what_is_wrong(check, field, change):
    kind = QUICK if check is guarantees.knows_no_origin else SLOW
    case, found = changed(field, change, kind)
    assert check(case, found) > 1
