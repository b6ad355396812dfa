"""How values were obtained is told in numbers, which no tree's structure holds."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import frictionjax as fx
from frictionjax.wiggly.solution import Solution


def made(how, sampled):
    """A solution of values that were obtained so."""
    numbers = {"steps": 9, "rejected": 0, "tolerance": 1e-4, "dissipation_gap": None}
    counts = numbers | {"how": np.array(how), "sampled": sampled}
    counts |= {"left_out": {"Mass": 0.02}}
    zeros = jnp.zeros(len(how))
    return Solution(zeros, zeros, None, None, jnp.asarray(0), counts, "; compiled for W")


def together(*solutions):
    return jax.tree.map(lambda *leaves: jnp.stack(leaves), *solutions)


def test_words_are_made_of_numbers_when_they_are_read():
    """Shares in a static text made each solution a tree of its own."""
    share, left = "% of them from brackets that closed", "; without Mass (at most 0.02 eps)"
    tiles = "resolved, every slip, in tiles; "
    few, many = made([0, 1, 0, 0], 0.0), made([0, 1, 1, 0], 0.0)
    assert few.how == f"{tiles}25{share}; compiled for W{left}"
    assert few.stats["values"] == few.how
    assert many.how == f"{tiles}50{share}; compiled for W{left}"
    assert together(few, many).how.startswith(f"{tiles}38{share}")
    part = f"windowed, 50{share}; 30% of the way known from some of its slips"
    assert made([0, 1, 1, 0], 0.3).how.startswith(part)
    alone = made([0, 1, 2, 2], np.nan)
    by_map = f"75{share}, 50% set off from a slip map"
    assert alone.how.startswith(f"windowed, values at the times alone; {by_map}")
    traced = []
    found = jax.jit(lambda solution: traced.append(solution.how) or solution)
    assert [found(solution).how for solution in (few, many)] == [few.how, many.how]
    assert traced == ["from lanes; compiled for W; without Mass"]


@pytest.mark.slow
def test_solutions_of_one_scene_are_trees_of_one_structure():
    bristle = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 0.5)
    load = fx.loads.Sine(1.05, 3.0)
    scene = fx.Scene(fx.profiles.Sine(0.1), bristle, fx.supports.Spring(1.0), load, 3.0)
    few, many = (fx.solve(scene, eps) for eps in (0.02, 0.01))
    assert few.how != many.how
    assert together(few, many).how.startswith("resolved, every slip, in tiles; 9")
