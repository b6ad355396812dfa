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
STOPS = np.append(0.5, np.full(7, END))  # as many as scenes have: one program
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


def test_no_step_goes_over_a_turn_of_the_load():
    nodes = followers._nodes(FORCE, VISCOSITY, set_off(), STOPS)
    assert 0.5 in nodes.time
    others = np.full(STOPS.size, END)  # as many: no other program
    assert 0.5 not in followers._nodes(FORCE, VISCOSITY, set_off(), others).time


def test_tips_come_to_rest_between_nodes_too():
    """From beside a rest, in 1e-8 s; no cubic over a longer step knows of that."""
    scene = SCENE.replace(load=fx.loads.Ramp(0.01), bristle=fx.bristles.Homothetic(1.0))
    force = force_in_tables(force_of(scene, jnp.asarray(EPS)), TS)
    one = Departures(np.zeros(1), np.ones(1), np.zeros(1), np.full(1, -0.24))
    ts = np.append(np.logspace(-9, -1, 400), 1.0)
    found = followed(ts, force, 1e-9, one, STOPS).state / EPS
    assert np.all(np.abs(np.diff(found)) < 0.02)
    assert np.all((found > -0.25) & (found < -0.19))


def test_what_takes_too_many_steps_is_not_known(monkeypatch):
    few = followers.SETTINGS._replace(most=32)
    monkeypatch.setattr(followers, "SETTINGS", few)
    found = followed(TS, FORCE, VISCOSITY, set_off(), STOPS)
    lost = np.isnan(found.state)
    assert np.all(lost[(TS > 1.3) & (TS <= END)])
    assert not np.any(lost[TS < 0.01])
    np.testing.assert_array_equal(np.isnan(found.doubt), lost)


def test_seats_and_sets_do_not_matter():
    """One beside 63 copies of it is the same as beside others, in a set of its own."""
    one = set_off(BEGINS[:1], STATES[:1], BEGINS[1:2])
    inside = BEGINS[1] >= TS
    alone = followed(TS, FORCE, VISCOSITY, one, STOPS).state[inside]
    for found in followed_at(TS, FORCE, VISCOSITY, [set_off(), one], STOPS):
        np.testing.assert_array_equal(alone, found.state[inside])
