"""Loops of long strokes lie between the frictions that `nap` found."""

import numpy as np
import pytest
from rods_that_turn import ROD, SURFACE

import frictionjax as fx


def loops(found):
    (axes,) = found.plot().axes
    return {
        line.get_label(): line.get_ydata()
        for line in axes.lines
        if line.get_label()[0] != "_"
    }


def ends(force):
    return [np.max(force), np.min(force)]


def test_one_loop_each_effect():
    found = fx.nap(SURFACE, ROD)
    drawn = loops(found)
    kept = ends(drawn["it keeps its nap"])
    assert kept == pytest.approx([found.rho_with, -found.rho_against])
    turned = ends(drawn["if it turned over"])
    assert turned == pytest.approx([found.rho_with, -found.rho_flipped])


def test_a_critical_load_in_the_window_turns_it_over():
    found = fx.nap(SURFACE, ROD)
    load = 0.5 * sum(found.window)
    stiffness = load * float(ROD.length) ** 2 / np.pi**2
    turns = fx.nap(SURFACE, ROD, stiffness)
    assert "it turns over" in loops(turns)
    title = turns.plot().axes[0].get_title(loc="left")
    assert title.endswith(f"turned over/with = {turns.rho_flipped / turns.rho_with:.4g}")


def test_a_bristle_that_cannot_turn_has_one_loop():
    spring = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0)
    assert set(loops(fx.nap(SURFACE, spring))) == {"it keeps its nap"}
