"""What friction takes and allows is drawn from the scene's own law."""

import numpy as np
import pytest

import frictionjax as fx

SCENE = fx.Scene(
    fx.profiles.Sine(0.1),
    fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0),
    fx.supports.Spring(1.0),
    fx.loads.Sine(1.05, 3.0),
    3.0,
)


def test_K_is_drawn_over_the_size_of_the_force():
    law = fx.friction(SCENE)
    left, right = fx.plot.draw_friction_law(SCENE).axes
    K, size = (np.asarray(line.get_ydata()) for line in left.lines)
    xi = np.asarray(left.lines[0].get_xdata())
    inside = (xi > float(law.rho_minus) * 0.999) & (xi < float(law.rho_plus) * 0.999)
    np.testing.assert_allclose(size, np.abs(xi))
    assert np.all(K[inside] > size[inside])
    np.testing.assert_allclose(K, fx.principle.K(SCENE, xi))
    graph = right.lines[1].get_xdata()
    assert [graph[0], graph[-1]] == pytest.approx(
        [float(law.rho_minus), float(law.rho_plus)]
    )


def test_what_is_no_scene_is_named():
    with pytest.raises(ValueError, match="scene = "):
        fx.plot.draw_friction_law(SCENE.profile)
