"""Random scenes against what the mathematics guarantees of every solution."""

import guarantees
import hard_scenes
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

# Each kind compiles its own programs; benchmarks/stress.py tries all of them.
KINDS = [
    ("slanted", "spring", "piecewise"),
    pytest.param(("vertical", "stiffening", "sine"), marks=pytest.mark.slow),
]
GENES = st.lists(
    st.floats(0, 1, width=16), min_size=hard_scenes.GENES, max_size=hard_scenes.GENES
)


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: "-".join(kind))
@settings(max_examples=6, deadline=None, derandomize=True, database=None)
@given(genes=GENES, turn=st.integers(0, len(guarantees.COMPARED) - 1))
def test_guarantees_hold(kind, genes, turn):
    try:
        case = hard_scenes.draw(kind, genes)
        found = guarantees.solved(case)
    except ValueError:  # not admissible, at this eps
        assume(False)
    assert guarantees.finite(case, found) == 0
    assume(found.ok)
    for check in (*guarantees.ALONE, guarantees.COMPARED[turn]):
        violation = check(case, found)
        assert not violation > 1, (check.__name__, violation, case)


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


def changed(field, change):
    """The genes' scene with one of its solution's numbers changed."""
    rng = np.random.default_rng(0)
    case = hard_scenes.draw(
        ("vertical", "stiffening", "sine"), rng.uniform(size=hard_scenes.GENES)
    )
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
        (guarantees.is_accurate, "z", lambda z: z * 1.01),
        (guarantees.keeps_order, "z", lambda z: z + 1e3),
        (guarantees.knows_no_left, "z", lambda z: z * 1.01),
        (guarantees.knows_no_units, "z", lambda z: z * 1.01),
    ],
    ids=lambda v: getattr(v, "__name__", None),
)
def test_checks_see_what_is_wrong(check, field, change):
    case, found = changed(field, change)
    assert check(case, found) > 1
