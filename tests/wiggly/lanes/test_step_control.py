"""Step control of lanes, on errors that change steadily as they do around a fold."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from frictionjax.wiggly.equation.step_sizes import step_of
from frictionjax.wiggly.lanes.step_control import Control, judge

ORDER = 5
FIRST = 1e-9
CONTROL = Control(FIRST, tolerance=1e-5, loosest=1e-4, pace=1e3, reach=0.125)
JUDGE = jax.jit(judge, static_argnums=0)


def follow(octaves: float, count: int = 60) -> tuple[float, float]:
    """Share of rejected steps and mean log2 of steps over the largest allowed ones.

    What the tolerance allows changes by so many octaves in each accepted step.
    """
    level, trend, largest, rejected, used = 0.0, 0.0, FIRST, 0, []
    for _ in range(count):
        step = float(step_of(*map(jnp.asarray, (level, FIRST))))
        error = CONTROL.tolerance * (step / largest) ** ORDER
        accepted, level, trend_after = JUDGE(ORDER, CONTROL, trend, step, 0.0, error)
        level = float(level)
        if accepted:
            used.append(np.log2(step / largest))
            largest *= 2.0**octaves
            trend = float(trend_after)
        else:
            rejected += 1
    return rejected / count, float(np.mean(used[10:]))


@pytest.mark.parametrize("octaves", [-0.5, -0.25, 0.0, 0.25, 0.5, 1.0])
def test_steps_follow_what_the_error_allows(octaves):
    """PI control (gains 0.7, 0.4) lags by four octaves where they double."""
    rejected, used = follow(octaves)
    assert rejected < 0.05
    assert -0.3 - max(octaves, 0.0) < used < 0


def accepts(step=FIRST, moved=1e-9, error=1e-6, control=CONTROL, overgrown=0.0) -> bool:
    return bool(JUDGE(ORDER, control, 0.0, step, moved, error, overgrown).accepted)


def test_steps_over_which_solutions_part_are_rejected_whatever_their_error():
    """Stiffly accurate methods damp growth: their error says nothing of it."""
    assert accepts(error=0.0, overgrown=0.99)
    assert not accepts(error=0.0, overgrown=1.01)
    assert not accepts(error=0.0, overgrown=1e22)


def test_errors_count_less_in_slips():
    slow, fast = 0.5 * CONTROL.pace * FIRST, 5 * CONTROL.pace * FIRST
    assert accepts(moved=slow, error=0.99e-5)
    assert not accepts(moved=slow, error=1.01e-5)
    assert accepts(moved=fast, error=4.9e-5)
    assert not accepts(moved=fast, error=5.1e-5)
    assert not accepts(moved=100 * fast, error=1.01e-4)  # never more than the loosest


def test_far_steps_are_rejected_whatever_their_error():
    assert accepts(moved=0.12, error=0.0)
    assert not accepts(moved=0.13, error=0.0)
    for bad in (np.nan, np.inf):
        assert not accepts(moved=bad)
        assert not accepts(error=bad)


def test_levels_do_not_depend_on_the_unit_of_time():
    minutes = CONTROL._replace(first_step=FIRST / 60, pace=CONTROL.pace * 60)
    found = JUDGE(ORDER, CONTROL, 0.1, 3 * FIRST, 1e-4, 3e-6)
    other = JUDGE(ORDER, minutes, 0.1, 3 * FIRST / 60, 1e-4, 3e-6)
    assert float(found.level) == float(other.level)
    assert float(found.trend) == pytest.approx(float(other.trend), abs=1e-6)
