"""Formulas as people write them."""

import frictionjax as fx
from frictionjax.explain import composed_equation
from frictionjax.report.page.mathematics import equation


def test_the_equation_of_a_scene_is_written_by_hand():
    text = equation("eps^gamma z' = l(t) - Phi'(z) - V_eps'(z)\n  m_eps = 2 eps^1.5 kg")
    motion, where = text.removeprefix('<p class="equation">').split("<br>")
    assert motion == (
        "\u03b5<sup>\u03b3</sup> z\u2032 = l(t) \u2212 \u03a6\u2032(z) \u2212 "
        "V<sub>\u03b5</sub>\u2032(z)"
    )
    assert where == (
        '<span class="where">m<sub>\u03b5</sub> = 2 \u03b5<sup>1.5</sup> kg</span></p>'
    )


def test_nothing_of_an_equation_is_lost_or_a_tag():
    parts = fx.supports.Spring(1.0), fx.loads.Ramp(1.0), 0.5
    effects = (fx.effects.Inertia(1.0, 3.0), fx.effects.LeadingOrder())
    bristle = fx.bristles.VerticalSpring(1.0, 2.0, 1.0)
    scene = fx.Scene(fx.profiles.Sine(0.1), bristle, *parts, effects=effects)
    lines = composed_equation(scene, 1e-3, 0.5).text()
    shown = equation(lines)
    assert shown.count("<br>") == lines.count("\n")
    assert "z\u2032\u2032" in shown
    assert "&lt;" in equation("a < b")
