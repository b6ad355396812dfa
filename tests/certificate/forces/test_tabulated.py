"""Certificates go by tables where the parts say the same, and by the parts elsewhere."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest

import frictionjax as fx
from frictionjax.certificate.forces import force_of
from frictionjax.certificate.forces import tabulated as asked
from frictionjax.loads import Sine

EPS = 0.03
TS = np.linspace(0.0, 2.0, 801)

PROFILES = {
    "sine": fx.profiles.Sine(0.1),
    "series": fx.profiles.Fourier([0.004, 0.0, 0.001], [0.01, 0.002, 0.0]),
    "spline": fx.profiles.Spline(0.01 * np.sin(2 * np.pi * np.arange(8) / 8)),
    "function": fx.profiles.Custom(lambda y: 0.01 * jnp.exp(jnp.sin(2 * jnp.pi * y))),
}
BRISTLES = {
    "vertical": fx.bristles.VerticalSpring(1.0, 2.0, 1.0),
    "slanted": fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 0.5),
    "angular": fx.bristles.AngularSpring(1.0, 1.5, 1.0, 0.2),
}
LOADS = {
    "sine": fx.loads.Sine(0.7, 2.0),
    "triangle": fx.loads.Triangle(0.7, 2.0),
    "ramp": fx.loads.Ramp(0.4, 0.1),
    "points": fx.loads.PiecewiseLinear([0.0, 0.7, 1.1, 2.0], [0.0, 0.6, -0.2, 0.3]),
}


def force(profile="sine", bristle="slanted", load="sine"):
    support = fx.supports.Spring(1.0)
    parts = PROFILES[profile], BRISTLES[bristle], support, LOADS[load]
    return force_of(fx.Scene(*parts, duration=2.0), jnp.asarray(EPS))


@eqx.filter_jit  # tables of one kind share a program
def slopes_of(of, ts, states):
    return jax.vmap(lambda t, y: of.with_slope(t, 3.0, y))(ts, states)


@pytest.mark.parametrize(
    "parts",
    [
        ("sine", "slanted", "sine"),
        ("series", "vertical", "points"),
        ("spline", "angular", "ramp"),
        ("function", "slanted", "triangle"),
    ],
)
def test_tables_are_used_and_say_the_same(parts):
    exact = force(*parts)
    tables = asked.force_in_tables(exact, TS)
    assert tables is not exact
    one, other = (slopes_of(of, TS, 0.5 * TS - 0.3) for of in (exact, tables))
    for a, b in zip(*map(jax.tree_util.tree_leaves, (one, other)), strict=True):
        assert np.max(np.abs(a - b)) <= 1e-9 * np.max(np.abs(a))


def test_kinds_of_parts_share_one_program():
    shared = [("sine", "slanted", "sine"), ("series", "vertical", "triangle")]
    kinds = {
        (
            jax.tree_util.tree_structure(of),
            *(x.shape for x in jax.tree_util.tree_leaves(of)),
        )
        for of in (asked.force_in_tables(force(*parts), TS) for parts in shared)
    }
    assert len(kinds) == 1


def test_a_table_of_another_load_is_not_used(monkeypatch):
    exact = force()
    monkeypatch.setattr(asked, "load_table", lambda load: Sine(0.7000001, 2.0))
    assert asked.force_in_tables(exact, TS) is exact


@pytest.mark.parametrize("wrong", ["profile", "bristle"])
def test_a_table_of_another_surface_is_not_used(monkeypatch, wrong):
    exact, right = force(), asked.tabulated_potentials
    other = {
        "profile": fx.profiles.Fourier([0.0, 1e-9], [0.1 / (2 * np.pi), 0.0]),
        "bristle": fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 0.500001),
    }[wrong]

    def tables(potential, highest):
        parts = {"profile": potential.profile, "bristle": potential.bristle, wrong: other}
        return right(fx.potential(**parts), highest)

    monkeypatch.setattr(asked, "tabulated_potentials", tables)
    assert asked.force_in_tables(exact, TS) is exact


def test_parts_that_no_table_holds_are_gone_by_themselves():
    given = fx.GivenPotential(
        lambda Y: 0.1 * jnp.sin(2 * jnp.pi * Y), lambda eps, Y: jnp.cos(2 * jnp.pi * Y)
    )
    load = fx.loads.Custom(
        lambda t: 0.7 * jnp.sin(t**2), turning_points=[np.sqrt(np.pi / 2)]
    )
    scene = fx.Scene(
        potential=given, support=fx.supports.Spring(1.0), load=load, duration=1.5
    )
    exact = force_of(scene, jnp.asarray(EPS))
    assert asked.force_in_tables(exact, TS[TS < 1.5]) is exact


@pytest.mark.slow  # programs for the parts
def test_certificates_are_those_by_the_parts(monkeypatch):
    scene = fx.Scene(
        PROFILES["series"], BRISTLES["angular"], fx.supports.Spring(1.1), LOADS["sine"], 2.0
    )
    ts = np.linspace(0.0, 2.0, 4001)
    z = np.asarray(fx.solve(scene, EPS, ts=ts).z)
    moved = z + 0.1 * EPS
    by_tables = [fx.certify(scene, EPS, 1.0, ts, curve) for curve in (z, moved)]
    assert [one.ok for one in by_tables] == [True, False]
    monkeypatch.setattr(asked, "load_table", lambda load: Sine(1.0, 2.0))
    for curve, known in zip((z, moved), by_tables, strict=True):
        found = fx.certify(scene, EPS, 1.0, ts, curve)
        assert found.status == known.status
        assert found.slips == known.slips
        for name in ("distance", "missing_force", "viscosity", "residual"):
            assert getattr(found, name) == pytest.approx(
                getattr(known, name), rel=1e-6, abs=1e-12
            ), name
