"""Whether a sampled curve solves the wiggly system, from the scene alone."""

from typing import Any

import jax.numpy as jnp
import numpy as np

from .._checks import (
    as_real,
    known_numbers,
    require,
    require_flags,
    require_outside,
    require_real,
    with_nan,
)
from .._compile import waiting
from ..effects import (
    AbstractEffect,
    CompliantArray,
    Engine,
    NapFlip,
    inertia_among,
    nap_flip_among,
)
from ..model import Scene, coefficients_jit, require_instants, require_reach, scene_for
from .plain_curve import plain_certificate
from .verdicts import Certificate, CertificateStatus, nothing_known

__all__ = ["Certificate", "CertificateStatus", "certify"]


@with_nan
def certify(
    scene: Scene,
    eps: Any,
    gamma: Any,
    ts: Any,
    z: Any,
    *,
    velocity: Any = None,
    root: Any = None,
    mode: Any = None,
    progress: bool = False,
) -> Certificate:
    """Certify any sampled curve, whatever made it, against the `scene` alone (eq. 2.8).

    `eps` in m, `gamma` > 0; `ts` in s, increasing, in [0, duration]; `z` in m; shapes
    (n,), n >= 2, NumPy or JAX. The curve's start is not compared with the scene's `z0`.
    Needs slips sampled at eps/4 or finer; a tenth of eps is comfortable, and as much finer
    as the wells have flanks narrower than a sine's: eps/50 of a rod that lies flat, of
    whose true curves `UNRESOLVED` or `VISCOSITY` may be told before.

    `ok` accepts a curve within eps/100 of a solution, whatever the deviation, and rejects
    one that skips a well, is shifted by eps/10, has another gamma, or slips late or early,
    by a tenth of a slip period say. From samples where tips forget where they were two
    solutions are followed, one from just below and one from just above, between which all
    that are close to the curve have to be: `distance` is how far the curve is from all of
    these (where it is far from every one, in slips, it may say more than that: some that
    set off farther away are nearer later), `within` how far it is at most from one. Where
    tips forget nothing for many wells, as in fast slides, `within` may be inf; then forces
    over windows, the force that a slip takes and the viscosity that shows in it decide too.
    Narrow wells under few samples are `UNRESOLVED` where half of these tell another
    viscosity by as much as it is off, and may be `OFF` on a true curve: take more. In time
    a hundredth of what the limit takes to slide by eps is allowed, as slips may be far
    shorter. The residual of the balance is reported but cannot decide: a shift by eps/100
    costs 270 slips at eps = 1e-3 and gamma = 1, a skipped well that is made slowly 1e-4 of
    a slip.

    Of a scene with `effects.CompliantArray` of N bristles `z` has the shape (N, n), a row
    for each: `solve` of arrays of one offset each gives them, where that of all gives
    their mean, which solves nothing. `residual`, `slips` and `skipped` are sums over
    bristles, `scale` is the energy of one slip of one of them, and of all other numbers
    there is the worst.

    Of a scene with `effects.Inertia` it needs `velocity`, z' in m/s, (n,), as `solve` gives
    it. Solutions of such scenes part in slips, and no window proves anything: the solution
    nearest to all samples is sought, by steps from each to the next. `distance` is how far
    in eps the curve is from it, inf where none is found; `status` is `VELOCITY` where only
    velocities are not that solution's. `residual` is the size of what is left of the
    balance of energies in J: the change of `m_eps z'^2/2 + Phi + V_eps`, less `int l z'`
    and plus `int eps^gamma z'^2`; `viscosity` what would balance them, over `eps^gamma`.
    Momentum may carry a tip over: `missing_force` is NaN and `skipped` 0. Where a slip
    begins, samples have to come close in time before they move, each gap at most four
    times its neighbour, else steps between them may not agree, as they may not on curves
    that are wrong: both are `UNRESOLVED`. Noise of eps/100, or a shift by it, is not
    accepted everywhere: from states beyond a fold others follow.

    Of a scene with `effects.NapFlip` it needs `root`, u in m, and `mode`, (n,), as `solve`
    gives them; the curve begins in a mode, 1 or -1. Stretches in a mode are judged as above
    from their side, turnings by the equation of the root over its pinned tip, and both meet
    where the compression is the critical load and where the root has come to the other
    end, energies going on there: `residual` is the sum over all of them, jumps and all.
    `status` is `TURN` where the rod turns over at a load that differs from that by more
    than 0.3% of the critical load, or where it should have and did not; `skipped` counts
    these stretches too. That is told by the load alone, so that noise of eps/100 does not
    matter. Samples have to come as close in turnings as in slips, and from the last one
    before a turning to its first one the load may change by 0.3% of the critical load: else
    it is `UNRESOLVED`.

    `progress`: a line on standard error where it takes more than two seconds.

    Returns a `Certificate`: `.ok .status .message`, `.distance` and `.within` in eps,
    `.residual` and `.scale` in J, wells crossed, `.slips` and `.skipped`, and more, see its
    `.table()`.

    Raises `ValueError` for arguments out of range, 32 bits, or an eps at which the
    bristle loses its contact.

    >>> ts = np.linspace(0.0, 3.0, 501)
    >>> z = fx.solve(scene, eps=0.1, ts=ts).z
    >>> fx.certify(scene, 0.1, 1.0, ts, z).message
    'the curve solves the wiggly system'
    >>> fx.certify(scene, 0.1, 1.0, ts, z + 0.01).message
    'a well was crossed without the force that this takes'
    """
    require_flags(progress=progress)
    curve = {"scene": scene, "eps": eps, "gamma": gamma, "ts": ts, "z": z}
    after = "certify what the program returns"
    require_outside("certify(...)", after, **curve, velocity=velocity, root=root, mode=mode)
    with waiting("certify", progress):
        return _certificate(
            *(scene, eps, gamma, ts, z), velocity=velocity, root=root, mode=mode
        )


def _certificate(
    scene: Scene,
    eps: Any,
    gamma: Any,
    ts: Any,
    z: Any,
    *,
    velocity: Any,
    root: Any,
    mode: Any,
) -> Certificate:
    scene = scene_for(Engine.CERTIFICATE, scene)
    require_real("eps", eps, "eps > 0", lambda e: e > 0)
    require_real("gamma", gamma, "gamma > 0", lambda g: g > 0)
    array = next((e for e in scene.effects if isinstance(e, CompliantArray)), None)
    ts = require_instants(scene, ts)
    z = _require_states(ts, z, array)
    inertia = inertia_among(scene.effects)
    speeds = _require_column("velocity", velocity, inertia, "Inertia", "z' in m/s", ts)
    flip = nap_flip_among(scene.effects)
    roots = _require_column("root", root, flip, "NapFlip", "u in m", ts)
    modes = _require_mode(ts, mode, flip)
    require_reach(scene.potential, jnp.asarray(as_real(eps)))
    eps = float(eps)
    viscosity = eps ** float(gamma)
    law = coefficients_jit(scene.potential)
    scale = eps * float(law.rho_plus - law.rho_minus)
    if not all(np.all(np.isfinite(column)) for column in (z, speeds, roots)):
        return nothing_known(scale)
    if array is not None:
        from .array_curves import array_certificate  # nothing else needs it

        return array_certificate(scene, array, eps, viscosity, scale, ts, z)
    if inertia is not None:
        from .massive_curve import massive_certificate  # nothing else needs it

        return massive_certificate(
            scene,
            mass=float(inertia.mass_at(eps)),
            eps=eps,
            viscosity=viscosity,
            scale=scale,
            ts=ts,
            z=z,
            velocity=speeds,
        )
    if flip is not None:
        from .turning_curve import turning_certificate  # nothing else needs it

        return turning_certificate(
            scene,
            flip,
            eps=eps,
            viscosity=viscosity,
            scale=scale,
            ts=ts,
            z=z,
            root=roots,
            mode=modes,
        )
    return plain_certificate(scene, eps, viscosity, scale, ts, z)


def _require_states(ts: np.ndarray, z: Any, array: CompliantArray | None) -> np.ndarray:
    states = known_numbers(z)
    shape, needs = ts.shape, f"real states of the shape {ts.shape} of ts"
    if array is not None:
        shape = (array.offsets.size, *ts.shape)
        needs = f"real states of the shape {shape}, a row a bristle, not their mean"
    require(states.shape == shape, "z", z, needs)
    return states.astype(float)


def _require_column(
    name: str, values: Any, effect: AbstractEffect | None, kind: str, needs: str, ts: Any
) -> np.ndarray:
    """Values at the times, which curves with an effect of a kind have, and others not."""
    if effect is None:
        require(values is None, name, values, f"None, or a scene with effects.{kind}")
        return np.zeros(0)
    needs = f"{needs} of the shape {ts.shape} of ts, as solve gives it"
    require(values is not None, name, values, needs)
    known = known_numbers(values)
    require(known.shape == ts.shape, name, values, needs)
    return known.astype(float)


def _require_mode(ts: np.ndarray, mode: Any, flip: NapFlip | None) -> np.ndarray:
    """The modes of a rod that turns over; none of others."""
    needs = "1, -1 and 0"
    modes = _require_column("mode", mode, flip, "NapFlip", needs, ts)
    if modes.size:
        told = f"{needs} of the shape {ts.shape} of ts, as solve gives them"
        require(np.all(np.isin(modes, (-1, 0, 1))), "mode", mode, told)
        first = "1 or -1: where the tip of a rod in between is, nothing tells"
        require(modes[0] != 0, "mode[0]", 0, first)
    return modes.astype(int)
