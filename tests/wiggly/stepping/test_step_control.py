"""Step control, on errors that change steadily as they do around a fold."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from frictionjax.wiggly.stepping.step_control import Control, ControlState, judge
from frictionjax.wiggly.stepping.step_sizes import rounded_down, step_of

ORDER = 5
FIRST = 1e-9
CONTROL = Control(FIRST, tolerance=1e-5, loosest=1e-4, pace=1e3, reach=0.125)


@jax.jit
def judged(control, before, step, moved, error, **more):
    return judge(ORDER, control, before, step=step, moved=moved, error=error, **more)


def follow(octaves: float, count: int = 60) -> tuple[float, float]:
    """Share of rejected steps and mean log2 of steps over the largest allowed ones.

    What the tolerance allows changes by so many octaves in each accepted step.
    """
    state, largest, rejected, used = ControlState(), FIRST, 0, []
    for _ in range(count):
        step = float(step_of(*map(jnp.asarray, (state.level, FIRST))))
        error = CONTROL.tolerance * (step / largest) ** ORDER
        accepted, state = judged(CONTROL, state, step, 0.0, error)
        if accepted:
            used.append(np.log2(step / largest))
            largest *= 2.0**octaves
        else:
            rejected += 1
    return rejected / count, float(np.mean(used[10:]))


@pytest.mark.parametrize("octaves", [-0.5, -0.25, 0.0, 0.25, 0.5, 1.0])
def test_steps_follow_what_the_error_allows(octaves):
    """PI control (gains 0.7, 0.4) lags by four octaves where they double."""
    rejected, used = follow(octaves)
    assert rejected < 0.05
    assert -0.3 - max(octaves, 0.0) < used < 0


def accepts(step=FIRST, moved=1e-9, error=1e-6, overgrown=0.0) -> bool:
    found = judged(CONTROL, ControlState(), step, moved, error, overgrown=overgrown)
    return bool(found.accepted)


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
    before = ControlState(level=2.0, trend=0.1)
    found = judged(CONTROL, before, 3 * FIRST, 1e-4, 3e-6).after
    other = judged(minutes, before, 3 * FIRST / 60, 1e-4, 3e-6).after
    assert float(found.level) == float(other.level)
    assert float(found.trend) == pytest.approx(float(other.trend), abs=1e-6)


def test_what_a_step_leaves_for_the_next_one():
    """One that a stop has cut short says nothing, but how far down one is rejected to."""
    before = ControlState(level=40.0, trend=0.1)

    def after(error, cut):
        return judged(CONTROL, before, 2 * FIRST, 0.0, error, cut=cut).after

    assert after(1e-7, cut=True) == before
    longer = after(1e-7, cut=False)
    assert longer.level < before.level
    assert longer.trend != before.trend
    for cut in (True, False):
        shorter = after(1e-4, cut)
        assert shorter.level < 8
        assert shorter.trend == before.trend


def test_steps_of_other_controllers_are_of_the_same_grid():
    steps = np.array([0.3, 1.0, 7.0])
    levels = 8 * np.log2(np.asarray(rounded_down(steps)))
    np.testing.assert_allclose(levels, np.floor(8 * np.log2(steps)), atol=1e-12)
