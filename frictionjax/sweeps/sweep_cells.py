"""All cells eps x gamma of a scene, or of several, as a data set."""

import threading
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from jaxtyping import UInt32

from .._checks import (
    as_real,
    grid_of,
    is_known,
    known_numbers,
    require,
    require_flags,
    require_outside,
    with_nan,
)
from .._compile import progress_bar
from ..called_for import ALL, Simulated, simulated
from ..effects import Engine, engine_of, noise_among
from ..model import Scene
from ..wiggly import is_ours, require_accuracy, warn_of_failed
from .provenance import describe
from .scene_columns import SceneColumns, SweepRequest, scene_columns
from .scene_family import SceneFamily, columns_of_family, family_of, times_of

if TYPE_CHECKING:
    import xarray as xr

_ACCURACY = 1e-3  # by default


@with_nan
def sweep(
    scene: Scene | Sequence[Scene] | Mapping[Any, Scene],
    eps: Any,
    gamma: Any,
    ts: Any = None,
    accuracy: Any = _ACCURACY,
    method: Any = "auto",
    progress: bool = False,
    *,
    dissipation: bool = True,
    suprema: bool = True,
    effects: str = "all",
    key: Any = None,
) -> "xr.Dataset":
    """Solve all cells `eps` x `gamma` (eq. 2.8), compare each with the limit (eq. 2.3).

    `eps` in m and `gamma`: numbers or lists, in any order, where a value that is there
    twice is one cell (the data set has eps falling, gamma rising, each once); `ts`,
    `accuracy` and `method` as in `solve`. `progress`: a bar on standard error.
    `dissipation=False` integrates no energies and leaves their variables out;
    `suprema=False` leaves out `sup_error`, `strip_excess` and `survey_error`. Without
    both only `z` at `ts` is left, and no slips between are looked at: two thirds of the
    time that suprema take.

    Returns a data set with dims (gamma, eps, time): `z`, `dissipation`; over (gamma, eps)
    `sup_error` = sup |z_eps - z| and `dissipation_error` over all of [0, T], `residual`
    of the energy-dissipation balance, `strip_excess` = sup dist(z_eps, strip) (Lemma 7),
    `dissipation_gap` (an estimate of the error of the dissipation), `viscosity`, `steps`,
    `rejected` and `status`; of the library's own methods also `how` and `bracket` over
    time (see `solve`), `sampled`, and `survey_error`, an estimate of what sampling slips
    adds to the error of `sup_error`; over time the limit's `z_limit`,
    `dissipation_limit`, the strip `z_minus`, `z_plus` and the load, `data["load"]`. Units
    and provenance are in the attributes, and with suprema what the laws of the orders need
    (`law_...`: the force of a well, the speeds of the limit); it goes to NetCDF and back
    without loss. `compiled_for`, among them: parts that no table holds to rounding, for
    which programs were compiled. `effects="auto"` leaves out effects of a scene that no
    cell calls for at this accuracy, see `solve`; the attribute `left_out` says which, and
    the most that each changes z by in eps.

    Several scenes, in a list or under labels (strings or integers) in a mapping, make a
    data set with the dimension `scene` in front, the limit's values and the laws' arrays
    too, and their `parts` in words; they share the times. Each scene's values are those of
    its own sweep.

    With `effects.NapFlip` also `root` and `mode` over time, of the limit too
    (`root_limit`, `mode_limit`, and in all `jumps` and `jump_loss`; their times and losses
    are attributes). Where the limit jumps, the wiggly system gets there later, so that
    `sup_error` does not vanish: `graph_error` does, the distance of the graphs of z_eps and
    z completed by vertical segments (`numerics.graph_distance`; a second is worth the
    mean speed of the limit, the attribute `graph_speed`), and
    `dissipation_graph_error` likewise (a second is worth `graph_power`). The strip is that
    of the limit's mode; what does not exist is NaN and says why in its attribute `missing`.

    With `effects.AxialLoad` also `compression` (N) and `buckling_share`, the largest at
    `ts`; beside `NapFlip` those of straight rods, and `sprung_share` for the second.

    Of a scene with `effects.Noise` each cell is one path, by fixed steps, independent of
    all others: `key`, a seed or a key of `jax.random`, with the bits of the cell's eps and
    gamma gives its own, so that a cell has the same bits alone and in any grid, and
    `fx.solve(..., key=jnp.asarray(data.path_key.sel(...)))` is its path. `sup_error` and
    `strip_excess` are those of that path, at `ts` and at 16 times or more in each well;
    `thermal_share` is `T_eps/(eps (rho_plus - rho_minus))`. Energies, brackets and laws
    there are none of, their variables are left out, and `accuracy` is refused.

    A cell that fails has its status and NaNs and does not disturb the others; one warning
    (`FailedCells`, a `UserWarning`) names such cells.

    Raises `ValueError` for arguments out of range, z0 outside the strip at t = 0 (Theorem
    1 does not apply), or an eps at which the bristle loses contact.

    >>> data = fx.sweep(scene, eps=[0.1, 0.03, 0.01, 0.003, 0.001], gamma=1.0)
    >>> print(data.sup_error.sel(gamma=1.0).values.round(3), data.sup_error.units)
    [0.156 0.03  0.008 0.003 0.001] m
    """
    _require_outside(scene, eps=eps, gamma=gamma, ts=ts, accuracy=accuracy)
    eps, gamma = grid_of("eps", eps), grid_of("gamma", gamma)
    require_accuracy(accuracy)
    require_flags(progress=progress, dissipation=dissipation, suprema=suprema)

    def simulate(one: Any) -> Simulated:
        return simulated(one, effects, eps, gamma, accuracy)

    engines = Engine.SWEEP, engine_of(method)
    family = family_of(scene, eps, engines, simulate)
    noisy = [noise_among(scene.effects) is not None for scene in family.scenes]
    unused = not any(noisy) and any(noise_among(one.effects) for one in family.asked)
    told = all(noisy) and effects == ALL  # what no path reads
    words = _path_words(None if unused else key, accuracy, any(noisy), told)
    request = SweepRequest(
        eps=eps,
        gamma=gamma,
        ts=times_of(family, ts),
        accuracy=float(as_real(accuracy)),
        method=str(method),
        solver=None if is_ours(method) else _general(method),
        balanced=bool(dissipation),
        suprema=bool(suprema),
        key=words,
    )
    found = _all_columns(family, request, progress)
    import xarray as xr  # 0.4 s, which another thread may spend while cells run

    columns = (
        found[0].columns
        if family.labels is None
        else columns_of_family(found, family.asked)
    )
    codes = columns["status"][1]
    warn_of_failed(codes, gamma, eps, family.labels or (), frames=1)  # `with_nan`
    coords = {"gamma": gamma, "eps": eps, "time": np.asarray(request.ts)}
    if family.labels is not None:
        coords["scene"] = np.array(family.labels)
    # All variables at once: one by one they are aligned anew, 1 ms each.
    data = xr.Dataset(columns, coords=coords)
    data = describe(data, family.asked, request.accuracy, found[0].method)
    for name, why in (pair for one in found for pair in one.missing.items()):
        if name in data:
            data[name].attrs["missing"] = why
    if family.labels is None:
        data.attrs |= found[0].laws
    own = dict.fromkeys(one.compiled_for for one in found if one.compiled_for)
    if own:
        data.attrs["compiled_for"] = "; ".join(own)
    if family.left_out:
        data.attrs["left_out"] = family.left_out
    return data


def _require_outside(scene: Any, **grid: Any) -> None:
    """A sweep is no part of a program; what is no scene is named where scenes are."""
    several = list(scene.values()) if isinstance(scene, Mapping) else scene
    row = several if isinstance(several, Sequence) else [scene]
    scenes = [one for one in row if isinstance(one, Scene)]
    require_outside("sweep(...)", "`fx.solve` can be traced", scene=scenes, **grid)


def _path_words(
    key: Any, accuracy: Any, some: bool, all_of_them: bool
) -> UInt32[np.ndarray, " 2"] | None:
    """The two words of a key where scenes have noise, which fixed steps are taken of."""
    if not some:
        require(key is None, "key", key, "None, or a scene with effects.Noise")
        return None
    from ..stochastic import key_words  # nothing else needs it

    if all_of_them:
        told = "its default: steps of a path with noise are fixed"
        unasked = is_known(accuracy) and known_numbers(accuracy) == _ACCURACY
        require(unasked, "accuracy", accuracy, told)
    return key_words(key)


def _all_columns(
    family: SceneFamily, request: SweepRequest, progress: bool
) -> list[SceneColumns]:
    counting = threading.Lock()
    with progress_bar("cells", progress) as bar:

        def report(share: float) -> None:
            with counting:
                bar.update(min(share / len(family.scenes), bar.total - bar.n))

        return family.side_by_side(lambda scene: scene_columns(scene, request, report))


def _general(method: Any) -> Any:
    """A solver of diffrax."""
    from ..wiggly import solver_of  # and diffrax, 0.5 s

    return solver_of(method)
