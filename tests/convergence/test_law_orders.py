"""Orders by a law: taken where errors follow it, free fits where they do not."""

import numpy as np
import pytest

from frictionjax.convergence.law_orders import ENERGY, STATE, fit_with_law
from frictionjax.convergence.order import Verdict
from frictionjax.slide_laws import Law


def by_law(predicted, law, scatter=0.02, seed=1):
    eps = np.geomspace(3e-2, 1e-5, 10)
    noise = np.exp(scatter * np.random.default_rng(seed).standard_normal(eps.size))
    errors = predicted(eps) * noise
    return eps, errors, fit_with_law(eps, errors, 1e-9 * eps, predicted(eps), law, STATE)


@pytest.mark.parametrize(
    ("order", "predicted"),
    [
        (1.0, lambda eps: eps),
        (1.0, lambda eps: np.maximum(eps - 2 * eps**1.067, 2 * eps**1.067)),  # gamma = 0.6
        (0.5, lambda eps: np.hypot(0.1, 2 * eps**0.25) - 0.1),  # gamma = 0.25
    ],
)
def test_errors_that_follow_a_law_have_its_order(order, predicted):
    law = Law(order, 1.0, "x")
    fits = [by_law(predicted, law, 0.02, seed)[2] for seed in range(60)]
    assert np.mean([one.fit.low <= order <= one.fit.high for one in fits]) >= 0.95
    assert np.median([one.fit.high - one.fit.low for one in fits]) < 0.06
    assert all(one.law.name == "x" for one in fits)


@pytest.mark.parametrize(
    "errors", [lambda eps: eps**0.8, lambda eps: 2 * eps, lambda eps: eps * (1 + eps**-0.1)]
)
def test_errors_that_do_not_follow_the_law_are_fitted_freely(errors):
    eps = np.geomspace(3e-2, 1e-5, 10)
    found = fit_with_law(eps, errors(eps), 1e-9 * eps, eps, Law(1.0, 1.0, "x"), STATE)
    assert found.law.name == "free"
    assert found.law.order == 1.0  # said all the same
    slope = np.polyfit(np.log(eps), np.log(errors(eps)), 1)[0]
    assert found.fit.order == pytest.approx(slope, abs=0.05)


@pytest.mark.parametrize(
    ("predicted", "law", "seen"),
    [
        (lambda eps: 3.6e-4 * eps + 0.3 * eps**1.45, Law(1.0, 3.6e-4, "x"), 1.42),
        (lambda eps: eps - 0.55 * eps**1.067, Law(1.0, 1.0, "x"), None),
        (lambda eps: np.hypot(0.1, 2 * eps**0.25) - 0.1, Law(0.5, 20.0, "x"), 0.35),
        (lambda eps: eps / (1 + 1e4 * eps), Law(1.0, 1.0, "x"), 0.2),
    ],
)
def test_a_power_that_these_eps_do_not_show_is_not_called_seen(predicted, law, seen):
    eps, errors, found = by_law(predicted, law)
    plain = np.polyfit(np.log(eps), np.log(errors), 1)[0]
    assert found.law.name == "x"
    late = predicted(eps)[-1] / (law.constant * eps[-1] ** law.order)
    far = not 2 / 3 < late < 1.5
    assert (found.fit.verdict is Verdict.NOT_YET_SEEN) == far
    assert found.fit.points == 10
    assert found.fit.seen == pytest.approx(plain)
    if seen is not None:
        assert found.fit.seen == pytest.approx(seen, abs=0.1)
    assert found.fit.low <= law.order <= found.fit.high
    assert found.fit.constant_low <= law.constant <= found.fit.constant_high


@pytest.mark.parametrize("order", [0.5, 1.0, 1.5])
def test_a_power_that_the_errors_show_is_seen(order):
    _, _, found = by_law(lambda eps: 2 * eps**order, Law(order, 2.0, "x"))
    assert found.fit.verdict is Verdict.CONVERGES
    assert found.fit.seen == pytest.approx(found.fit.order, abs=0.01)


# Dissipation at gamma = 0.6 and 0.8 over its law, two scenes.
DRIFTING = (
    (5e-2, 5e-6, "1.038 1.020 1.069 1.091 1.111 1.035 1.194 1.232 1.239 1.263"),
    (7e-2, 2.3e-5, "1.140 1.113 1.215 0.917 1.414 1.038 0.959 0.714 0.457"),
)


@pytest.mark.parametrize(("largest", "smallest", "ratio"), DRIFTING)
def test_a_ratio_that_is_not_settled_widens_its_interval(largest, smallest, ratio):
    ratio = np.array(ratio.split(), float)
    eps = np.geomspace(largest, smallest, ratio.size)
    found = fit_with_law(eps, ratio * eps, 1e-9 * eps, eps, Law(1.0, 1.0, "x"), ENERGY)
    assert found.law.name == "x"
    assert found.fit.low <= 1.0 <= found.fit.high
    assert found.fit.constant_low <= 1.0 <= found.fit.constant_high
    assert found.fit.high - found.fit.low < 0.6


@pytest.mark.parametrize("scatter", [0.01, 0.05, 0.1])
def test_intervals_by_a_law_hold_the_constant(scatter):
    fits = [by_law(lambda e: 2 * e, Law(1.0, 2.0, "x"), scatter, s)[2] for s in range(40)]
    held = [f.fit.constant_low <= 2.0 <= f.fit.constant_high for f in fits]
    assert np.mean(held) >= 0.95


def test_energies_may_differ_more_from_their_law():
    eps = np.geomspace(3e-2, 1e-5, 10)
    found = fit_with_law(eps, 1.7 * eps, 1e-9 * eps, eps, Law(1.0, 1.0, "x"), ENERGY)
    assert found.law.name == "x"
    assert found.fit.constant == pytest.approx(1.7)
    assert found.fitted == pytest.approx(1.7 * eps)
