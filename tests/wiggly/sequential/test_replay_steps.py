"""Known steps are taken again as they were, however their errors are judged."""

import diffrax
import jax
import jax.numpy as jnp
import numpy as np

from frictionjax.wiggly.sequential.replay_steps import ReplaySteps

# The second step is far too long for the tolerance; room beyond the last is padding.
ENDS = np.array([0.1, 0.9, 1.0, np.inf, np.inf])
HARSH = diffrax.PIDController(rtol=0.0, atol=1e-12)


def ended(rate, t0, t1):
    found = diffrax.diffeqsolve(
        diffrax.ODETerm(lambda t, y, args: -rate * y),
        diffrax.Heun(),
        t0,
        t1,
        None,
        jnp.asarray(1.0),
        stepsize_controller=ReplaySteps(HARSH, jnp.asarray(ENDS)),
        max_steps=ENDS.size,
    )
    return found.ys[0], found.stats["num_accepted_steps"], found.stats["num_steps"]


def by_hand(rate, t0, t1):
    lengths = 0.1 - t0, 0.8, t1 - 0.9
    return np.prod([1 - rate * h + 0.5 * (rate * h) ** 2 for h in lengths])


def test_every_step_is_taken_and_none_other():
    y, accepted, steps = ended(0.7, 0.0, 1.0)
    assert abs(y - by_hand(0.7, 0.0, 1.0)) < 1e-15
    assert (accepted, steps) == (3, 3)


def test_derivatives_move_the_ends_alone():
    point = 0.7, 0.0, 1.0
    slopes = jax.grad(lambda *p: ended(*p)[0], (0, 1, 2))(*point)
    for index, slope in enumerate(slopes):
        shift = 1e-6 * np.eye(3)[index]
        ends = by_hand(*(point + shift)), by_hand(*(point - shift))
        assert abs(slope - (ends[0] - ends[1]) / 2e-6) < 1e-9
