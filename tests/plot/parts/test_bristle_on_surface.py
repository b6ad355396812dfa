"""The bristle of a scene as it is drawn."""

import jax.numpy as jnp
import numpy as np
import pytest

import frictionjax as fx

REST = fx.supports.Spring(1.0), fx.loads.Ramp(1.0), 1.0
SINE = fx.profiles.Sine(0.1)


@pytest.mark.parametrize(
    ("bristle", "root"),
    [
        (fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0), (np.tan(1.0), 1.0)),
        (fx.bristles.SlantedSpring(1.0, 2.4, 1.0, -0.5), (-np.tan(0.5), 1.0)),
        (fx.bristles.AngularSpring(1.0, 2.0, 1.0, 0.3), (np.sqrt(3.0), 1.0)),
        (fx.bristles.VerticalSpring(1.0, 3.0, 2.0), (0.0, 2.0)),
        (fx.bristles.Homothetic(1.0), (0.0, 1.0)),
    ],
)
def test_root_and_tip_stand_where_the_bristle_has_them(bristle, root):
    (axes,) = fx.plot.draw_parts(fx.Scene(SINE, bristle, *REST)).axes
    squares = [line for line in axes.lines if line.get_marker() == "s"]
    assert np.ravel(squares[0].get_data()) == pytest.approx(root, abs=1e-12)
    (tip,) = (line for line in axes.lines if line.get_marker() == "o")
    assert np.ravel(tip.get_data()) == pytest.approx((0.0, 0.0), abs=1e-12)
    low, high = axes.get_xlim()
    assert low < min(0.0, root[0])
    assert root[0] < high
    ends = [
        line.get_xydata()[[0, -1]] for line in axes.lines if line.get_color() == "#0072B2"
    ]
    assert ends[0] == pytest.approx(np.array([[0.0, 0.0], root]), abs=1e-12)
    assert type(bristle).__name__ in axes.get_title(loc="left")


def test_a_potential_alone_has_no_bristle_to_draw():
    waves = fx.GivenPotential(lambda Y: 0.01 * jnp.sin(2 * jnp.pi * Y))
    scene = fx.Scene(potential=waves, support=REST[0], load=REST[1], duration=1.0)
    with pytest.raises(ValueError, match="scene = 'one of a potential alone'"):
        fx.plot.draw_parts(scene)
