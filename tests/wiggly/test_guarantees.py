"""Random scenes against what the mathematics guarantees of every solution."""

import guarantees
import hard_scenes
import numpy as np
import pytest
from guarantees import energy
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


@pytest.fixture(scope="module", params=KINDS, ids="-".join)
def known(request):
    """A scene whose strip is five wells wide, and its solution."""
    rng = np.random.default_rng(0)
    case = hard_scenes.draw(request.param, rng.uniform(size=hard_scenes.GENES))
    return case, guarantees.solved(case)


def beyond(case, z):
    """By the strip's width, and an eightieth of eps more, but at the start."""
    low, high = guarantees.strip_of_eps(case)
    return np.append(z[0], (z + high - low + case.eps / 80)[1:])


def opened():
    """All brackets closed but those from half of the time on."""
    return np.where(guarantees.TIMES < 1, 0.0, 1.1e-3)


class Changed:
    """A solution, one field of which is wrong."""

    def __init__(self, case, found, field, change):
        self._case, self._found = case, found
        self._field, self._change = field, change

    def __getattr__(self, name):
        value = getattr(self._found, name)
        if name != self._field:
            return value
        value = value if isinstance(value, dict) else np.asarray(value)
        return self._change(self._case, value)


@pytest.mark.parametrize(
    ("check", "field", "change"),
    [
        (guarantees.finite, "z", lambda case, z: z * np.nan),
        (guarantees.dissipates, "dissipation", lambda case, d: d - 0.01 * d[-1]),
        (guarantees.balance_closes, "residual", lambda case, r: r + 20 * energy(case)),
        (guarantees.stays_near_the_strip, "z", beyond),
        (guarantees.stays_near_the_limit, "z", lambda case, z: z + 2.1 * case.eps),
        (guarantees.is_accurate, "z", lambda case, z: z + 2e-3 * case.eps),
        (guarantees.closes_brackets, "stats", lambda case, s: {"bracket": opened()}),
        (guarantees.keeps_order, "z", lambda case, z: z + 1.01 * case.eps),
        (guarantees.knows_no_origin, "z", lambda case, z: z + 4e-3 * case.eps),
        (guarantees.knows_no_left, "z", lambda case, z: z + 4e-3 * case.eps),
        (guarantees.knows_no_units, "z", lambda case, z: z + 4e-3 * case.eps),
    ],
    ids=lambda v: getattr(v, "__name__", None),
)
def test_checks_see_what_is_wrong(known, check, field, change):
    case, found = known
    nothing = check is guarantees.knows_no_origin and case.kind == SLOW
    assert np.isnan(check(case, found)) if nothing else check(case, found) <= 1
    if not nothing:
        assert check(case, Changed(case, found, field, change)) > 1


@pytest.mark.parametrize("name", ["sup_error", "strip_excess", "dissipation_error"])
def test_suprema_that_are_wrong_are_seen(known, monkeypatch, name):
    """By two accuracies, of the larger of eps and the supremum."""
    case, found = known
    right = guarantees.swept

    def wrong(case, ts, accuracy, method):
        cell = right(case, ts, accuracy, method)
        if accuracy != guarantees.ACCURACY:
            return cell
        size = max(case.eps, float(cell.sup_error))
        if name == "dissipation_error":
            size = max(float(cell.dissipation[-1]), float(cell[name]))
        return cell.assign({name: cell[name] + 2.1e-3 * size})

    monkeypatch.setattr(guarantees, "swept", wrong)
    assert guarantees.knows_its_suprema(case, found) > 1


def test_no_numbers_are_no_agreement(known):
    case, found = known
    lost = Changed(case, found, "z", lambda case, z: z * np.nan)
    assert guarantees._apart(case, found, lost, np.negative) == np.inf
    never = np.zeros(guarantees.TIMES.size, dtype=bool)
    assert np.isnan(guarantees._largest(case, found, np.zeros(never.size), never))
