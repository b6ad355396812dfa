"""Orders by regression: intervals that hold, windows, floors, divergence."""

import numpy as np
import pytest

from frictionjax.convergence.order import Verdict, fit_order, local_orders

GENERATOR = np.random.default_rng(20)


def grid(n):
    return 10 ** np.sort(GENERATOR.uniform(-3, -1, n))[::-1]


def fit(eps, errors, floor=0.0):
    return fit_order(eps, errors, np.full_like(eps, floor))


@pytest.mark.parametrize("order", [-0.4, 0.5, 1.0, 2.0])
def test_exact_powers_on_any_grid(order):
    eps = grid(9)
    found = fit(eps, 3.0 * eps**order)
    assert found.order == pytest.approx(order, abs=1e-12)
    assert found.low <= order <= found.high
    assert found.constant == pytest.approx(3.0)
    assert found.points + found.preasymptotic == 9


def coverage(law, points, decades, scatter, draws=80, random=False, order=1.0):
    """Share of intervals that hold the order, and their median half width."""
    rng = np.random.default_rng(5)
    hits, halves = 0, []
    for _ in range(draws):
        places = rng.uniform(0, 1, points) if random else np.linspace(0, 1, points)
        eps = 10 ** (-1 - decades * np.sort(places))
        errors = law(eps) * np.exp(scatter * rng.standard_normal(points))
        found = fit(eps, errors)
        hits += found.low <= order <= found.high
        halves.append(0.5 * (found.high - found.low))
    return hits / draws, float(np.median(halves))


@pytest.mark.parametrize(
    ("points", "width"),
    [(6, 0.0578), (8, 0.0424), (16, 0.0222), (32, 0.0151), (48, 0.0118)],
)
def test_clean_powers_on_random_grids(points, width):
    """Widths: of t intervals around straight lines, in the window with the narrowest."""
    held, half = coverage(lambda eps: eps**0.7, points, 2, 0.05, 160, True, 0.7)
    assert held >= 0.93
    assert half <= 1.3 * width


@pytest.mark.parametrize("points", [8, 16, 32])
@pytest.mark.parametrize(
    "law",
    [
        lambda eps: eps * (1 + eps**0.5),
        lambda eps: eps * (1 + 3 * eps**0.5),
        lambda eps: eps * (1 - 0.5 * eps**0.5),
        lambda eps: eps * (1 + 3 * eps**0.2),
        lambda eps: eps * (1 - 0.5 * eps**0.2),
    ],
)
def test_corrections_that_decay_slowly(law, points):
    held, half = coverage(law, points, 5, 0.02)
    assert held >= 0.9
    assert half < 0.12


@pytest.mark.parametrize("points", [8, 16, 32])
@pytest.mark.parametrize("power", [1, -1])
def test_a_logarithm_that_shows(power, points):
    held, half = coverage(lambda eps: eps * np.log(1 / eps) ** power, points, 5, 0.02)
    assert held >= 0.85
    assert half < 0.08


@pytest.mark.parametrize("largest", [0.04, 0.01])
def test_a_decade_of_a_correction_that_the_scatter_hides(largest):
    """As in the default scene at gamma = 1: sizes 4 to 1%, scatter a tenth of that."""

    def law(eps):
        return eps * (1 - largest * (10 * eps) ** 0.5)

    held, half = coverage(law, 12, 1, 0.08 * largest)
    assert held >= 0.93
    assert half < largest


# sup |z_eps - z| / eps of the default scene at gamma = 1, 12 eps a decade.
SWEEP = {
    1e-2: "0.804 0.858 0.84 0.884 0.904 0.922 0.931 0.919 0.925 0.943 0.963 0.959",
    1e-3: "0.968 0.962 0.962 0.973 0.976 0.977 0.981 0.98 0.983 0.986 0.989 0.989",
}


@pytest.mark.parametrize("top", list(SWEEP))
def test_decades_of_a_sweep_hold_the_limit(top):
    eps = np.geomspace(0.97 * top, 0.103 * top, 12)
    found = fit(eps, eps * np.array(SWEEP[top].split(), float))
    assert found.low <= 1.0 <= found.high
    assert 0.5 * (found.high - found.low) < {1e-2: 0.3, 1e-3: 0.02}[top]


def test_the_preasymptotic_part_is_left_out():
    eps = np.geomspace(1e-1, 1e-3, 12)
    found = fit(eps, eps * (1 + 30 * eps))
    assert found.preasymptotic >= 1
    assert found.eps_max < 0.05
    assert found.low <= 1.0 <= found.high
    assert abs(found.order - 1.0) < 0.05
    everything = np.polyfit(np.log(eps), np.log(eps * (1 + 30 * eps)), 1)[0]
    assert everything > 1.2  # what a plain regression says


@pytest.mark.parametrize(
    ("law", "points"),
    [
        (lambda eps: 7 * eps**0.7, 6),
        (lambda eps: 7 * eps**-0.4, 12),
        (lambda eps: 7 * eps * (1 + 3 * eps**0.5), 16),
        (lambda eps: 7 * eps * (1 - 0.5 * eps**0.2), 16),
    ],
)
def test_intervals_of_constants_hold_the_constant(law, points):
    rng = np.random.default_rng(6)
    eps, held = np.geomspace(1e-1, 1e-6, points), []
    for _ in range(40):
        found = fit(eps, law(eps) * np.exp(0.03 * rng.standard_normal(points)))
        held.append(found.constant_low <= 7 <= found.constant_high)
        assert found.constant_low <= found.constant <= found.constant_high
    assert np.mean(held) >= 0.92


def test_constants_do_not_depend_on_the_side_of_one_on_which_eps_lie():
    eps, noise = np.geomspace(1e-1, 1e-4, 9), np.exp(0.05 * np.sin(7.0 * np.arange(9)))
    small, large = fit(eps, eps**0.8 * noise), fit(1e6 * eps, eps**0.8 * noise)
    assert large.order == pytest.approx(small.order)
    for found in (small, large):
        assert 0 < found.constant_low < found.constant < found.constant_high


def test_what_is_seen_is_a_plain_slope_of_the_window():
    eps = np.geomspace(1e-1, 1e-5, 12)
    errors = eps * (1 + 3 * eps**0.2)
    found = fit(eps, errors)
    window = (eps >= found.eps_min) & (eps <= found.eps_max)
    slope = np.polyfit(np.log(eps[window]), np.log(errors[window]), 1)[0]
    assert found.seen == pytest.approx(slope)
    assert abs(found.order - 1) < abs(found.seen - 1)


def test_order_of_the_input_does_not_matter():
    eps = np.geomspace(1e-1, 1e-3, 12)
    errors = eps * (1 + 30 * eps)
    mixed = GENERATOR.permutation(12)
    assert fit(eps[mixed], errors[mixed]) == pytest.approx(fit(eps, errors), rel=1e-12)


def test_the_floor_is_left_out_and_counted():
    eps = np.geomspace(1e-1, 1e-4, 13)
    errors = np.hypot(eps, 1e-3)
    found = fit(eps, errors, floor=1e-3)
    assert found.floor == np.sum(errors <= 3e-3)
    assert found.eps_min > 2.5e-3
    assert abs(found.order - 1) < 0.05


def test_divergence_shows_as_divergence():
    eps = grid(10)
    errors = eps**-0.5 * np.exp(0.02 * GENERATOR.standard_normal(10))
    found = fit(eps, errors)
    assert found.verdict is Verdict.DIVERGES
    assert found.high < 0
    assert local_orders(np.array([0.1, 0.05]), np.array([1.0, 2.0])) == pytest.approx(-1)


def test_constant_errors_are_undecided():
    assert fit(grid(9), np.full(9, 3.0)).verdict is Verdict.UNDECIDED


def test_failures_and_too_few_points():
    eps = np.geomspace(1e-1, 1e-2, 6)
    errors = eps.copy()
    errors[1] = np.nan
    assert fit(eps, errors).failed == 1
    errors[2:4] = np.nan
    found = fit(eps, errors)
    assert found.verdict is Verdict.TOO_FEW_POINTS
    assert np.isnan(found.order)
    assert np.isnan([found.seen, found.constant_low, found.constant_high]).all()
    assert found.failed == 3


def test_bad_arguments_are_named():
    with pytest.raises(ValueError, match="errors = "):
        fit_order(np.array([0.1, 0.2]), np.array([1.0]), np.zeros(2))
    with pytest.raises(ValueError, match=r"eps = .*distinct"):
        fit(np.array([0.1, 0.1]), np.ones(2))


def test_a_window_must_foretell_its_smallest_eps():
    """Errors that fall fast and then stop falling: no narrow interval around the fall."""
    eps = np.geomspace(1e-1, 3e-3, 12)
    errors = 30 * eps**1.9
    errors[-2:] = errors[-3], 1.5 * errors[-3]
    found = fit(eps, errors)
    assert found.low < 0 < found.high
    assert found.misfit > 10
    assert found.verdict is Verdict.NO_POWER
    assert not found.low > 1.0


@pytest.mark.parametrize("order", [1.0, 4 / 3, 2.0])
@pytest.mark.parametrize("step", [1e-2, 1e-5])
def test_a_grid_of_four_percent_shows_no_order(order, step):
    """However well a power goes through it: errors wave by more than they fall there."""
    eps = 0.01 * (1 + step * np.arange(5))
    found = fit(eps, eps**order)
    assert found.order == pytest.approx(order, abs=1e-6)
    assert found.verdict == Verdict.UNDECIDED
    assert found.low < 0 < 2 * order < found.high


def test_narrow_windows_widen_the_interval_without_a_step():
    widths = []
    for factor in (1.1, 1.5, 2.9, 3.1, 10.0):
        found = fit(np.geomspace(0.01, 0.01 * factor, 6), np.ones(6))
        widths.append(found.high - found.low)
    assert np.all(np.diff(widths) <= 1e-9)
    assert widths[0] > 4.0
    assert widths[2] - widths[3] < 0.02
