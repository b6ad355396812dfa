"""Order of dense output, which slides are read from."""

import jax
import jax.numpy as jnp
import numpy as np
from scipy.integrate import solve_ivp

from frictionjax.wiggly.rosenbrock import RODAS5P, Linearised, dense_output, rosenbrock_step

SHARES = jnp.linspace(0.0, 1.0, 8)[1:]


def field(t, y):
    return -3 * jnp.sin(y) + 0.3 * jnp.cos(2 * t) * y**2 + t


@jax.jit
def curve(step, count, y):
    """Values at `SHARES` of each of 88 steps at most; NaN from the last of `count` on."""

    def advance(y, index):
        t = index * step
        velocity, by_state = jax.value_and_grad(field, 1)(t, y)
        start = Linearised(velocity, by_state, jax.grad(field)(t, y))
        after, stages = rosenbrock_step(RODAS5P, field, start, t, step, y)
        inside = jax.vmap(lambda s: dense_output(RODAS5P, y, after, stages, s))(SHARES)
        return after, jnp.where(index < count, inside, jnp.nan)

    return jax.lax.scan(advance, y, jnp.arange(88.0))[1]


def test_dense_output_has_the_order_of_the_scheme_less_one():
    tight = {"rtol": 1e-13, "atol": 1e-13, "dense_output": True, "method": "DOP853"}
    truth = solve_ivp(lambda t, y: np.asarray(field(t, y)), (0.0, 2.0), [0.7], **tight).sol
    counts, errors = np.array([11, 22, 44, 88]), []
    for count in counts:
        step = 2.0 / count
        found = np.asarray(curve(step, float(count), jnp.asarray(0.7)))[:count]
        times = step * (np.arange(count)[:, None] + np.asarray(SHARES))
        errors.append(np.abs(found - truth(times.ravel())[0].reshape(times.shape)).max())
    order = np.polyfit(np.log(counts), -np.log(errors), 1)[0]
    assert order > RODAS5P.order - 0.5
