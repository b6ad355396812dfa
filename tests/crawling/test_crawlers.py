"""Crawlers: the laws of friction and of energy, closed forms, another integrator."""

import math

import jax
import numpy as np
import pytest
from at_places import part_at
from samples import pair
from scipy import integrate

import frictionjax as fx
from frictionjax.crawling import wiggly_gait

SINE = fx.profiles.Sine(0.1)
ROD = fx.bristles.AngularSpring(1.0, length=1.414, height=1.0, rest_angle=0.3)
LEANING = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0)
UPRIGHT = fx.bristles.VerticalSpring(1.0, 2.0, 1.0)
BREATH = fx.loads.Sine(0.5, 1.0)
TS = np.linspace(0.0, 3.0, 601)


def friction_of(bristle, profile=SINE):
    law = fx.friction(profile, bristle)
    return float(law.rho_plus), -float(law.rho_minus)


@pytest.mark.parametrize("bristle", [ROD, LEANING])
@pytest.mark.parametrize("stiffness", [0.7, 5.0])
@pytest.mark.parametrize("kind", [fx.loads.Sine, fx.loads.Triangle])
def test_the_step_of_the_limit_in_closed_form(bristle, stiffness, kind):
    plus, minus = friction_of(bristle)
    for amplitude in (0.5, 0.03):
        breath = kind(amplitude, 1.3)
        found = fx.crawler(SINE, bristle, stiffness, breath, 3 * 1.3)
        way = max(0.0, 2 * amplitude - 2 * min(plus, minus) / stiffness)
        expected = way if plus < minus else -way
        assert found.step == pytest.approx(expected, abs=1e-12)
        assert found.closed_form == pytest.approx(expected, abs=1e-12)
        assert found.ok


def test_the_way_it_goes_is_that_of_less_friction():
    assert fx.crawler(SINE, ROD, 1.0, BREATH, 3.0).step > 0.8
    assert fx.crawler(SINE, LEANING, 1.0, BREATH, 3.0).step < -0.7


@pytest.mark.parametrize("bristle", [ROD, LEANING])
def test_the_limit_obeys_friction_at_both_feet(bristle):
    """Each foot moves under its own friction only, and energies balance."""
    plus, minus = friction_of(bristle)
    breath = fx.loads.PiecewiseLinear([0.0, 0.4, 1.0, 1.7, 3.0], [0.2, 1.0, 0.1, 0.6, 0.0])
    found = fx.crawler(SINE, bristle, 2.0, breath, 3.0, TS)
    least = min(plus, minus)
    assert np.all(np.abs(found.tension) <= least * (1 + 1e-9))
    for place, force in ((found.rear, found.tension), (found.front, -found.tension)):
        moved = np.diff(place)
        forwards, backwards = moved > 1e-12, moved < -1e-12
        # Where it has moved all the gap long: at both ends.
        for at in (force[1:], force[:-1]):
            there = forwards & np.roll(forwards, 1) & np.roll(forwards, -1)
            np.testing.assert_allclose(at[there], plus, rtol=1e-9)
            there = backwards & np.roll(backwards, 1) & np.roll(backwards, -1)
            np.testing.assert_allclose(at[there], -minus, rtol=1e-9)
    rest = np.asarray(part_at(breath, TS))
    longer = found.front - found.rear
    np.testing.assert_allclose(found.tension, 2.0 * (longer - rest), atol=1e-12)
    energy = found.tension**2 / 4.0
    given = -np.cumsum(0.5 * (found.tension[1:] + found.tension[:-1]) * np.diff(rest))
    left = energy[1:] - energy[0] - given + found.dissipation[1:]
    assert np.max(np.abs(left)) < 5e-4 * found.dissipation[-1]


def test_values_do_not_depend_on_which_times_are_asked():
    whole = fx.crawler(SINE, ROD, 1.0, BREATH, 3.0, TS)
    few = fx.crawler(SINE, ROD, 1.0, BREATH, 3.0, TS[::97])
    np.testing.assert_allclose(few.rear, whole.rear[::97], atol=1e-14)
    np.testing.assert_allclose(few.front, whole.front[::97], atol=1e-14)
    assert few.step == pytest.approx(whole.step, abs=1e-14)
    some = TS[::3]  # as many as fit into one program
    wiggly = fx.crawler(SINE, ROD, 1.0, BREATH, 3.0, some, eps=0.05)
    others = fx.crawler(SINE, ROD, 1.0, BREATH, 3.0, some[::31], eps=0.05)
    np.testing.assert_allclose(others.rear, wiggly.rear[::31], atol=2e-3 * 0.05)


def by_scipy(eps, gamma, stiffness, amplitude, ts):
    """Two feet of a leaning spring, by the places of their tips, in closed form."""
    lean, cosine = math.tan(1.0), math.cos(1.0)

    def foot(p):
        """z, V' and dz/dp of the tip at p."""
        turn = 2 * math.pi * p / eps
        height = eps * 0.1 / (2 * math.pi) * math.sin(turn)
        slope = 0.1 * math.cos(turn)
        stretch = 1 - lean * slope
        climb = (2.4 - (1.0 - height) / cosine) / cosine
        return p - lean * height, climb * slope / stretch, stretch

    def rates(t, tips):
        (rear, back, one), (front, ahead, other) = foot(tips[0]), foot(tips[1])
        rest = amplitude * math.sin(2 * math.pi * t)
        tension, drag = stiffness * (front - rear - rest), eps**gamma
        return [(tension - back) / (drag * one), (-tension - ahead) / (drag * other)]

    found = integrate.solve_ivp(
        rates, (0, ts[-1]), [0, 0], "LSODA", t_eval=ts, rtol=1e-9, atol=1e-10 * eps
    )
    return np.vectorize(lambda p: foot(p)[0])(found.y)


@pytest.mark.parametrize(("eps", "gamma"), [(0.05, 1.0), (0.08, 0.6), (0.05, 1.4)])
def test_slips_of_both_feet_are_those_of_another_integrator(eps, gamma):
    ts = np.linspace(0, 1.2, 25)
    rear, front = by_scipy(eps, gamma, 1.5, 0.4, ts)
    found = fx.crawler(
        SINE, LEANING, 1.5, fx.loads.Sine(0.4, 1.0), 1.2, ts, eps=eps, gamma=gamma
    )
    assert found.ok
    assert found.error <= 1e-3
    assert np.ptp(rear) > 2 * eps
    np.testing.assert_allclose(found.rear, rear, atol=1e-3 * eps)
    np.testing.assert_allclose(found.front, front, atol=1e-3 * eps)


def test_its_steps_tend_to_those_of_the_limit():
    limit = fx.crawler(SINE, LEANING, 1.0, BREATH, 3.0, TS[::3])
    off, lost = [], []
    for eps in (0.05, 0.01, 2e-3):
        found = fx.crawler(SINE, LEANING, 1.0, BREATH, 3.0, TS[::3], eps=eps)
        assert found.ok
        assert found.error <= 1e-3
        assert np.max(found.residual) < 1e-4 * found.dissipation[-1]
        places = np.stack([found.rear - limit.rear, found.front - limit.front])
        off.append(np.max(np.abs(places)))
        lost.append(found.dissipation[-1] - limit.dissipation[-1])
    assert np.all(np.diff(off) < 0)
    assert off[-1] < 0.02
    assert 0 < lost[-1] < 0.02 * limit.dissipation[-1]
    assert found.step == pytest.approx(limit.step, rel=0.01)


def test_a_longer_spring_crawls_the_same_way():
    """The limit knows no places, and a surface repeats: by whole wells."""
    for eps in (None, 0.05):
        short = fx.crawler(SINE, ROD, 1.0, BREATH, 2.0, eps=eps)
        long = fx.crawler(SINE, ROD, 1.0, BREATH, 2.0, eps=eps, length=40 * 0.05)
        np.testing.assert_allclose(long.rear, short.rear, atol=1e-3 * 0.05)
        np.testing.assert_allclose(long.front, short.front + 2.0, atol=1e-3 * 0.05)
        assert long.closed_form == pytest.approx(short.closed_form, abs=1e-12)


@pytest.mark.parametrize("stiffness", [0.1, 0.3])
def test_energies_balance_where_a_breath_has_kinks(stiffness):
    """Slopes jump there, and steps end there: the work is not told by slopes."""
    breath = fx.loads.PiecewiseLinear([0.0, 0.25, 0.75, 1.0], [0.0, 0.3, -0.3, 0.0])
    found = fx.crawler(SINE, ROD, stiffness, breath, 1.5, eps=0.05)
    assert found.ok, found
    assert np.max(found.residual) < 1e-5 * found.dissipation[-1]


@pytest.mark.parametrize("accuracy", [1e-3, 1e-5, 1e-7])
def test_what_rounding_decides_is_not_trusted(accuracy):
    """Both feet alike, on a symmetric surface: which of them slips first is a coin."""
    found = fx.crawler(
        SINE, UPRIGHT, 10.0, fx.loads.Sine(0.1, 1.0), 2.0,
        eps=0.01, gamma=1.5, accuracy=accuracy,
    )  # fmt: skip
    assert found.status.name == "SENSITIVE"


@pytest.mark.parametrize("said", ["OK", "UNBALANCED", "MAX_STEPS"])
def test_a_coin_is_one_whatever_runs_say(monkeypatch, said):
    told = wiggly_gait._told
    code = int(fx.Status[said])
    monkeypatch.setattr(wiggly_gait, "_told", lambda *runs: told(*runs)._replace(code=code))
    parts = 10.0, fx.loads.Sine(0.1, 1.0), 2.0
    alike = fx.crawler(SINE, UPRIGHT, *parts, eps=0.01, gamma=1.5)
    assert alike.status.name == ("MAX_STEPS" if said == "MAX_STEPS" else "SENSITIVE")
    unlike = fx.crawler(SINE, LEANING, *parts, eps=0.01, gamma=1.5)
    assert unlike.status.name == said


@pytest.mark.parametrize("gamma", [1.0, 2.0])
def test_the_dissipation_is_as_accurate_as_it_says(gamma):
    parts = SINE, LEANING, 1.0, fx.loads.Sine(0.5, 1.0), 2.0
    rough = fx.crawler(*parts, eps=5e-3, gamma=gamma, accuracy=1e-2)
    fine = fx.crawler(*parts, eps=5e-3, gamma=gamma, accuracy=1e-5)
    assert rough.ok
    assert fine.ok
    assert rough.dissipation[-1] == pytest.approx(fine.dissipation[-1], rel=1e-2)


@pytest.mark.parametrize(
    "values",
    [
        [0.0, 1.0, 0.0, 1.0, 0.0],  # two breaths a cycle
        [0.0, 1.0, 0.0, 0.5, 0.2],  # does not come back
        [0.0, 0.3, 0.0, 1.0, 0.0],
    ],
)
def test_the_closed_form_is_of_cycles_with_one_breath(values):
    breath = fx.loads.PiecewiseLinear(np.linspace(0, 1, 5), values)
    found = fx.crawler(SINE, ROD, 1.0, breath, 1.0, cycle=1.0)
    assert math.isnan(found.closed_form)
    other = fx.crawler(SINE, ROD, 1.0, breath, 1.0, cycle=0.5)
    one = values[2] == values[4] and values[3] > values[2]
    assert math.isnan(other.closed_form) != one
    whole = fx.crawler(SINE, ROD, 1.0, fx.loads.Sine(0.5, 0.1 * 3), 0.3)
    assert np.isfinite(whole.step)


def test_traced_numbers_are_refused_by_name():
    def step(stiffness):
        return fx.crawler(SINE, ROD, stiffness, BREATH, 3.0).step

    with pytest.raises(ValueError, match="traced numbers"):
        jax.grad(step)(1.0)


@pytest.mark.slow  # pieces of splines are of another kind
def test_any_parts_crawl():
    for kind in ("custom", "homothetic", "slanted"):
        parts = pair("spline", kind, 1, 2)
        found = fx.crawler(*parts, 1.0, fx.loads.Custom(lambda t: 0.3 * t), 1.0, eps=0.02)
        assert found.ok, found
        assert math.isnan(found.step)  # no cycle
        assert found.front[-1] > found.rear[-1]


def test_the_last_cycle_is_that_of_the_breathing_or_the_one_asked_for():
    breath = fx.loads.PiecewiseLinear([0.0, 0.5, 1.0, 1.5, 2.0], [0.0, 1.0, 0.0, 1.0, 0.0])
    found = fx.crawler(SINE, ROD, 1.0, breath, 2.0, cycle=1.0)
    plus, _ = friction_of(ROD)
    assert found.step == pytest.approx(1.0 - 2 * plus, abs=1e-12)
    assert math.isnan(fx.crawler(SINE, ROD, 1.0, breath, 2.0).step)
    assert math.isnan(fx.crawler(SINE, ROD, 1.0, BREATH, 0.7).step)


@pytest.mark.slow  # a size of table of its own
def test_feet_that_have_nowhere_to_go_are_balanced():
    """In wells from the start, with no breath: nothing moves, and nothing is lost."""
    lopsided = fx.profiles.Fourier([-0.02, -0.002], [-0.001, 0.0005])
    still = fx.crawler(lopsided, UPRIGHT, 1.0, fx.loads.Sine(0.0, 1.0), 1.0, eps=0.05)
    assert still.ok, still
    assert abs(still.step) < 1e-9
    assert still.closed_form == 0.0


def test_what_cannot_be_trusted_says_so():
    budget = fx.crawler(SINE, ROD, 1.0, BREATH, 1.0, eps=0.02, max_steps=50)
    assert budget.status.name == "MAX_STEPS"
    assert not budget.ok
    assert np.isnan(budget.rear[-1])


def test_what_it_shows():
    found = fx.crawler(SINE, ROD, 1.0, BREATH, 3.0, eps=0.05)
    assert "m a cycle" in repr(found)
    assert "closed_form" in str(found.table())
    data = found.to_dataset()
    assert set(data) == {
        *("rear", "front", "position", "tension", "dissipation", "residual"),
    }
    np.testing.assert_array_equal(data.position, (found.rear + found.front) / 2)
    figure = fx.plot.draw_crawler(found)
    assert "m a cycle" in figure.axes[0].get_title(loc="left")
    assert figure.axes[0].get_xlabel() == "t (s)"
    assert figure.axes[0].get_ylabel() == "place (m)"
    failed = fx.crawler(SINE, ROD, 1.0, BREATH, 1.0, eps=0.05, max_steps=20)
    assert "budget" in fx.plot.draw_crawler(failed).axes[0].get_title(loc="left")


@pytest.mark.parametrize(
    ("change", "named"),
    [
        ({"stiffness": 0.0}, "stiffness = 0"),
        ({"stiffness": "x"}, "stiffness = "),
        ({"breathing": fx.loads.Pulled(BREATH)}, "breathing = 'Pulled'"),
        ({"breathing": 1.0}, "breathing = 'float'"),
        ({"profile": ROD}, "profile = 'AngularSpring'"),
        ({"bristle": SINE}, "bristle = 'Sine'"),
        ({"length": np.nan}, "length = nan"),
        ({"duration": -1.0}, "duration = -1"),
        ({"ts": [0.0, 9.0]}, "ts = "),
        ({"eps": 0.0}, "eps = 0"),
        ({"eps": 0.1, "gamma": 0.0}, "gamma = 0"),
        ({"eps": 0.1, "accuracy": 2.0}, "accuracy = 2"),
        ({"eps": 0.1, "max_steps": 0}, "max_steps = 0"),
        ({"cycle": 0.0}, "cycle = 0"),
        ({"gamma": -1.0}, "gamma = -1"),
        ({"eps": 1e-20}, "eps = 1e-20"),
        ({"bristle": UPRIGHT}, "rho_plus != -rho_minus"),
    ],
)
def test_bad_arguments_are_named(change, named):
    known = {"profile": SINE, "bristle": ROD, "stiffness": 1.0}
    known |= {"breathing": BREATH, "duration": 3.0}
    with pytest.raises(ValueError, match=named):
        fx.crawler(**(known | change))
