"""diffrax's Kvaerno5 as a user would call it: no guard against steps over wells."""

import diffrax
import equinox as eqx
import jax.numpy as jnp
import numpy as np

from frictionjax.wiggly.sequential.integration import field_of

_STEPS = 200_000


@eqx.filter_jit
def _states(scene, eps, gamma, ts, stops, tolerance):
    field = field_of(scene, eps, gamma)
    found = diffrax.diffeqsolve(
        diffrax.ODETerm(lambda t, y, args: field.velocity(t, y)),
        diffrax.Kvaerno5(),
        ts[0],
        ts[-1],
        None,
        field.start(scene.z0),
        stepsize_controller=diffrax.ClipStepSizeController(
            diffrax.PIDController(rtol=0.0, atol=tolerance), jump_ts=stops
        ),
        saveat=diffrax.SaveAt(ts=ts),
        max_steps=_STEPS,
        throw=False,
    )
    return field.state(found.ys), found.result == diffrax.RESULTS.successful, found.stats


def kvaerno5(scene, one, tolerance: float) -> tuple[np.ndarray, str]:
    """States at the scene's times, and a status."""
    stops = jnp.asarray(one.system.kinks)
    numbers = jnp.asarray(one.eps), jnp.asarray(one.gamma), jnp.asarray(one.ts)
    z, ok, stats = _states(scene, *numbers, stops, tolerance)
    spent = int(stats["num_steps"]) >= _STEPS
    return np.asarray(z), "ok" if bool(ok) else "max_steps" if spent else "gave_up"
