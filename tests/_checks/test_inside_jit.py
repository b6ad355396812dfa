"""Numbers that a traced function holds, arrays of JAX too, are as good as traced ones."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import frictionjax as fx

_PROFILE, _BRISTLE = fx.profiles.Sine(0.1), fx.bristles.SlantedSpring(1.0, 2.2, 1.0, 0.4)
_SCENE = fx.Scene(
    _PROFILE, _BRISTLE, fx.supports.Spring(1.0), fx.loads.Triangle(1.0, 3.0), 0.4, 0.05
)
_TIMES = np.linspace(0.1, 0.4, 3)
_EPS, _GAMMA = jnp.asarray(0.05), jnp.asarray(1.0)


def _end(eps=_EPS, gamma=_GAMMA, ts=_TIMES, accuracy=1e-3):
    return fx.solve(_SCENE, eps, gamma, ts, accuracy=accuracy).z[-1]


@pytest.mark.parametrize(
    ("name", "value"),
    [
        pytest.param("gamma", 1.0, marks=pytest.mark.slow),
        pytest.param("accuracy", 1e-3, marks=pytest.mark.slow),
        pytest.param("ts", _TIMES, marks=pytest.mark.slow),
        pytest.param(None, 1.0, marks=pytest.mark.slow),
    ],
)
def test_solve_where_some_arguments_are_traced(name, value):
    """One of them, or none: all the others are arrays from outside."""
    run = jax.jit(lambda x: _end(**{name: x}) if name else x * _end())
    assert abs(float(run(value)) - float(_end())) < 1e-3 * 0.05


def test_traced_numbers_that_are_none_or_not_allowed_end_at_once():
    """Steps of NaN were made until there was room for no more, for minutes.

    Of what known numbers are refused for there were values, and status OK.
    """

    def run(eps, gamma, angle, ts):
        bristle = fx.bristles.SlantedSpring(1.0, 2.2, 1.0, angle)
        return fx.solve(_SCENE.replace(bristle=bristle), eps, gamma, ts)

    good = 0.05, 1.0, 0.4, _TIMES
    wrong = [
        *({0: eps} for eps in (-1.0, np.nan, 0.0)),
        *({1: gamma} for gamma in (np.nan, -1.0)),
        {2: 1.52},  # 1 + a omega < 0
        *({3: ts} for ts in (_TIMES - 0.2, _TIMES + 0.2, _TIMES[::-1])),
    ]
    rows = [good, *([one.get(i, v) for i, v in enumerate(good)] for one in wrong)]
    found = jax.jit(jax.vmap(run))(*map(jnp.stack, map(list, zip(*rows, strict=True))))
    assert found.status.tolist() == [fx.Status.OK] + 9 * [fx.Status.NOT_FINITE]
    assert found.ok.tolist() == [True] + 9 * [False]
    assert "batch (10,): 1 of 10 OK, 9 NOT_FINITE; 3 times each" in repr(found)
    assert np.all(np.isnan(found.z[1:]))
    assert abs(float(found.z[0, -1] - _end())) < 1e-3 * 0.05


def test_friction_of_known_parts():
    run = jax.jit(lambda x: x * fx.friction(_PROFILE, _BRISTLE).rho_plus)
    assert float(run(1.0)) == pytest.approx(float(fx.friction(_PROFILE, _BRISTLE).rho_plus))


@pytest.mark.slow
def test_steady_slide_of_known_parts():
    def mean(x):
        return fx.steady_slide(_PROFILE, _BRISTLE, 0.01, x, 1.0).mean_plus

    assert float(jax.jit(mean)(1.0)) == pytest.approx(float(mean(1.0)), rel=1e-9)


def test_the_limit_of_a_known_scene():
    run = jax.jit(lambda x: x * fx.solve_limit(_SCENE, _TIMES).z[-1])
    assert float(run(1.0)) == pytest.approx(float(fx.solve_limit(_SCENE, _TIMES).z[-1]))


def test_numbers_known_inside_are_still_checked():
    with pytest.raises(ValueError, match=r"eps = -0\.05"):
        jax.jit(lambda x: x * _end(eps=-0.05))(1.0)


_NOISY = _SCENE.replace(effects=(fx.effects.Noise(1e-6),))
_KEY, _CURVE = jax.random.PRNGKey(0), np.linspace(0.0, 0.01, 3)


@pytest.mark.parametrize(
    ("call", "given", "said"),
    [
        (lambda key: fx.solve(_NOISY, 0.05, key=key).z, _KEY, "key = .*fx.ensemble"),
        (lambda x: x * fx.solve(_NOISY, 0.05, key=0).z, 1.0, "noise = .*fx.ensemble"),
        (lambda eps: fx.sweep(_SCENE, eps, 1.0).z.values, 0.05, "eps = .*fx.solve"),
        (lambda x: x * fx.sweep(_SCENE, 0.05, 1.0).z.values, 1.0, r"sweep\(...\) = "),
        (lambda z: fx.certify(_SCENE, 0.05, 1.0, _TIMES, z).distance, _CURVE, "z = "),
        (
            lambda x: x * fx.certify(_SCENE, 0.05, 1.0, _TIMES, _CURVE).distance,
            1.0,
            r"certify\(...\) = 'part of jax.jit'",
        ),
    ],
)
def test_what_is_no_part_of_programs_says_so_by_name(call, given, said):
    with pytest.raises(ValueError, match=said):
        jax.jit(call)(given)
