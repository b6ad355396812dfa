"""Solutions that are followed are those of another code, and say what they are off by."""

from functools import cache

import jax.numpy as jnp
import numpy as np
from scipy.integrate import solve_ivp

import frictionjax as fx
from frictionjax.certificate.following import followers, radau_step
from frictionjax.certificate.following.followers import Departures, followed_at
from frictionjax.certificate.forces import force_in_tables, force_of

EPS, GAMMA, END = 0.1, 1.0, 1.5
SCENE = fx.Scene(
    fx.profiles.Sine(0.1),
    fx.bristles.VerticalSpring(1.0, 2.0, 1.0),
    fx.supports.Spring(1.0),
    fx.loads.Triangle(0.7, 2.0),
    END,
)
TS = np.linspace(0.0, END, 301)
FORCE = force_in_tables(force_of(SCENE, jnp.asarray(EPS)), TS)
VISCOSITY = EPS**GAMMA
STOPS = np.array([0.5, END, END])
TIGHT = {"rtol": 1e-10, "atol": 1e-12, "max_step": 1e-2}
BEGINS = np.array([0.0, 0.4, 0.9])
STATES = np.array([0.0, 0.021, 0.3])


def followed(ts, force, viscosity, departures, stops):
    (found,) = followed_at(ts, force, viscosity, [departures], stops)
    return found


@cache
def by_scipy(begin, state):
    """At all times after the begin. A vertical spring's tip is at z/eps; F(eta) = 1 + eta,
    as alpha = 1."""

    def rate(t, z):
        load = 1.4 * t if t < 0.5 else 1.4 - 1.4 * t
        phase = 2 * np.pi * z[0] / EPS
        height = EPS * 0.1 * np.sin(phase) / (2 * np.pi)
        return [(load - z[0] - (1 + height) * 0.1 * np.cos(phase)) / VISCOSITY]

    found, at = np.empty(0), [state]
    for first, last in ((begin, max(begin, 0.5)), (max(begin, 0.5), END)):
        some = TS[(first < TS) & (last >= TS)]
        if some.size:
            run = solve_ivp(rate, (first, last), at, "LSODA", some, **TIGHT)
            found, at = np.append(found, run.y[0]), [run.y[0, -1]]
    return found


def set_off(begins=BEGINS, states=STATES, ends=None):
    ends = np.append(begins[1:], END) if ends is None else ends
    return Departures(begins, ends, np.zeros(begins.size), states / EPS)


def test_states_are_those_of_another_code():
    found = followed(TS[1:], FORCE, VISCOSITY, set_off(), STOPS)
    ends = np.append(BEGINS[1:], END)
    for begin, state, end in zip(BEGINS, STATES, ends, strict=True):
        inside = (begin < TS) & (end >= TS)
        truth = by_scipy(begin, state)[: np.sum(inside)]
        off = np.abs(found.state[inside[1:]] - truth) / EPS
        assert np.max(off) < 1e-3  # cubics between the steps
        assert np.max(off[-1:]) < 1e-6  # the end of a step
    assert np.max(np.abs(found.state)) > 3 * EPS  # slips are among it


def test_doubt_holds_what_they_are_off_by(monkeypatch):
    """With a tolerance that lets steps err by far more than another code does."""
    monkeypatch.setattr(
        radau_step, "SETTINGS", radau_step.SETTINGS._replace(error=1e-4, between=1.0)
    )
    monkeypatch.setattr(followers, "_tries", followers.Program(followers._tries._fn))
    ends = np.append(BEGINS[1:], END)
    found = followed(ends, FORCE, VISCOSITY, set_off(), STOPS)
    for number, end in enumerate(ends):
        after = np.sum((BEGINS[number] < TS) & (end >= TS))
        truth = by_scipy(BEGINS[number], STATES[number])[after - 1]
        assert abs(found.state[number] - truth) / EPS <= found.doubt[number] + 1e-9
    assert 1e-6 < np.max(found.doubt) < 0.1


def test_a_slip_just_before_the_load_turns_is_not_stepped_over():
    """The load is beyond the fold for some thousandths of the way, in which a tip slips."""
    top = 0.1 + 0.28 * EPS  # N: the fold is at 0.1 N, the tip there at EPS/4
    load = fx.loads.PiecewiseLinear([0.0, 1.0, 2.0], [0.0, top, top - 0.02])
    scene = SCENE.replace(load=load, duration=2.0, bristle=fx.bristles.Homothetic(1.0))
    ts, viscosity = np.array([0.5, 2.0]), EPS**4
    truth = np.asarray(fx.solve(scene, EPS, 4.0, ts=ts, accuracy=1e-6).z)
    assert truth[1] > 0.6 * EPS  # it has slipped
    force = force_in_tables(force_of(scene, jnp.asarray(EPS)), ts)
    begin = Departures(np.zeros(1), np.full(1, 2.0), np.zeros(1), np.zeros(1))
    found = followed(ts, force, viscosity, begin, np.array([1.0, 2.0, 2.0]))
    np.testing.assert_allclose(found.state, truth, atol=2e-3 * EPS)


def test_what_takes_too_many_steps_is_not_known(monkeypatch):
    few = followers.SETTINGS._replace(most=32)
    monkeypatch.setattr(followers, "SETTINGS", few)
    found = followed(TS, FORCE, VISCOSITY, set_off(ends=np.full(3, END)), STOPS)
    assert np.any(np.isnan(found.state))
    assert np.all(np.isnan(found.doubt) == np.isnan(found.state))


def test_seats_and_sets_do_not_matter():
    """One beside 63 copies of it is the same as beside others, in a set of its own."""
    one = set_off(BEGINS[:1], STATES[:1], BEGINS[1:2])
    inside = BEGINS[1] >= TS
    alone = followed(TS, FORCE, VISCOSITY, one, STOPS).state[inside]
    for found in followed_at(TS, FORCE, VISCOSITY, [set_off(), one], STOPS):
        np.testing.assert_array_equal(alone, found.state[inside])
