"""Parts show the call that makes them."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import frictionjax as fx
from frictionjax._checks import exact_text, notebook_text

PROFILE = fx.profiles.Sine(0.1)
SCENE = fx.Scene(
    PROFILE, fx.bristles.Homothetic(0.5), fx.supports.Spring(2.0), fx.loads.Ramp(1.0), 3.0
)
PARTS = [
    PROFILE,
    fx.profiles.Fourier([0.0, 0.01], [0.02, 0.0]),
    fx.bristles.SlantedSpring(1.0, 2.21257, 1.0, -0.5),
    fx.loads.PiecewiseLinear([0.0, 1.0, 2.5], [0.0, 1.5, -1.0]),
    fx.effects.Inertia(0.3, 3.0),
    fx.effects.RigidArray([0.0, 0.25]),
]


@pytest.mark.parametrize("part", PARTS, ids=lambda part: type(part).__name__)
def test_the_text_is_the_call(part):
    places = fx.loads, fx.profiles, fx.bristles, fx.effects  # Sine is a profile
    again = eval(repr(part), {kind: getattr(m, kind) for m in places for kind in dir(m)})
    same = jax.tree_util.tree_map(np.array_equal, again, part)
    assert all(jax.tree_util.tree_leaves(same))
    assert type(again) is type(part)


def test_a_scene_has_a_line_for_each_part():
    assert repr(SCENE.replace(effects=(fx.effects.LeadingOrder(),))).splitlines() == [
        "Scene(",
        "  profile=Sine(slope=0.1),",
        "  bristle=Homothetic(alpha=0.5),",
        "  support=Spring(stiffness=2),",
        "  load=Ramp(rate=1),",
        "  duration=3,",
        "  effects=(LeadingOrder(),)",
        ")",
    ]


def test_a_given_potential_is_named_by_its_functions():
    def waves(Y):
        return 0.02 * jnp.sin(2 * jnp.pi * Y)

    assert repr(fx.GivenPotential(W=waves)) == "GivenPotential(W=waves)"


def test_long_arrays_are_told_by_their_range():
    many = fx.profiles.Fourier(np.zeros(7), 1e-3 * np.arange(7))
    assert repr(many) == "Fourier(cos=<7 values, 0 to 0>, sin=<7 values, 0 to 0.006>)"


def test_traced_numbers_have_a_shape_only():
    seen = []
    jax.eval_shape(lambda a: seen.append(repr(fx.profiles.Sine(a))), 0.1)
    assert "f64[]" in seen[0]
    batch = jax.vmap(fx.bristles.Homothetic)(jnp.array([0.5, 1.0]))
    assert repr(batch) == "Homothetic(alpha=[0.5, 1])"


def test_provenance_has_every_digit_of_every_field():
    scene = SCENE.replace(
        support=fx.supports.Spring(1 / 3), effects=(fx.effects.LeadingOrder(),)
    )
    text = exact_text(scene)
    for told in (f"stiffness={1 / 3!r}", "effects=(LeadingOrder(),)", "z0=0.0", "turns="):
        assert told in text
    waves = np.linspace(0.0, 1e-3, 9)
    assert str((waves / 7).tolist()) in exact_text(fx.profiles.Fourier(waves / 7, waves))


def test_a_notebook_shows_a_table_of_what_is_known_and_escaped_text_of_a_trace():
    class Table:
        def _repr_html_(self):
            return "<table>"

    shown = []

    def look(number):
        shown.append(notebook_text({"<": number}, Table))
        return number

    look(1.0)
    jax.jit(look)(1.0)
    assert shown[0] == "<table>"
    assert shown[1].startswith("<pre>{&#x27;&lt;&#x27;: ")
