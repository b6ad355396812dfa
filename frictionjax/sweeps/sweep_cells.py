"""All cells eps x gamma of a scene as a data set."""

from typing import TYPE_CHECKING, Any

import numpy as np

from .._checks import as_real, cells_of, grid_of, require_flags, viscosity_of, with_nan
from .._compile import progress_bar
from ..limit import LimitSolution, require_start_in_strip, solve_limit
from ..model import (
    Scene,
    coefficients_jit,
    known_scene,
    require_reach,
    require_times,
    require_told_apart,
    strips_at,
)
from ..slide_laws import slide_data
from ..wiggly import Status, integrate_cells, is_ours, require_accuracy, warn_of_failed
from .provenance import describe

if TYPE_CHECKING:
    import xarray as xr


def _run_lanes(
    scene, eps, gamma, ts, accuracy, method, balanced, progress, suprema
) -> dict | None:
    """Values of all cells through lanes, by name; None where they cannot say."""
    lane_eps, lane_gamma = cells_of(eps, gamma)
    with progress_bar("cells", progress) as bar:

        def report(share: float) -> None:
            bar.update(min(share, bar.total - bar.n))

        found = integrate_cells(
            scene=scene,
            eps=lane_eps,
            gamma=lane_gamma,
            ts=np.asarray(ts),
            accuracy=accuracy,
            method=method,
            balanced=balanced,
            report=report,
            suprema=suprema,
        )
    if found is None:
        return None
    values = found._asdict()
    values["status"] = values["status"].astype(np.int8)
    values["how"] = values["how"].astype(np.int8)
    values["bracket"] = values.pop("gap")
    failed = ~np.isin(values["status"], (Status.OK, Status.UNBALANCED, Status.ROUGH_SURVEY))
    for name in ("residual", "dissipation_gap", "dissipation_error", *_SUPREMA):
        values[name] = np.where(failed, np.nan, values[name])
    unused = ["running_residual", "survey_work_error"]
    if not balanced:
        unused += ["dissipation", "dissipation_error", "residual", "dissipation_gap"]
    return {name: value for name, value in values.items() if name not in unused}


_DIMS = ("gamma", "eps", "time")
_SUPREMA = ("sup_error", "strip_excess", "survey_error")


@with_nan
def sweep(
    scene: Scene,
    eps: Any,
    gamma: Any,
    ts: Any = None,
    accuracy: Any = 1e-3,
    method: Any = "auto",
    progress: bool = False,
    *,
    dissipation: bool = True,
    suprema: bool = True,
) -> "xr.Dataset":
    """Solve all cells `eps` x `gamma` and compare each with the limit.

    `eps` in m and `gamma`: numbers or lists, in any order; `ts`, `accuracy` and `method`
    as in `solve`. `progress`: a bar on standard error. `dissipation=False` integrates no
    energies and leaves their variables out; `suprema=False` leaves out `sup_error`,
    `strip_excess` and `survey_error`. Without both only `z` at `ts` is left, and no slips
    between are looked at: two thirds of the time that suprema take.

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
    without loss.

    A cell that fails has its status and NaNs and does not disturb the others; one warning
    (`FailedCells`, a `UserWarning`) names such cells.

    Raises `ValueError` for arguments out of range, z0 outside the strip at t = 0 (Theorem
    1 does not apply), or an eps at which the bristle loses contact.
    """
    scene = known_scene(scene)
    eps, gamma = grid_of("eps", eps), grid_of("gamma", gamma)
    require_accuracy(accuracy)
    require_flags(progress=progress, dissipation=dissipation, suprema=suprema)
    ts = require_times(scene, ts)
    require_start_in_strip(scene)
    require_reach(scene.potential, eps)
    require_told_apart(scene, eps)
    solver = None if is_ours(method) else _general(method)
    limit = solve_limit(scene, ts)
    balanced, wanted = bool(dissipation), float(as_real(accuracy))
    values, name = None, str(method)
    if solver is None:
        values = _run_lanes(
            scene, eps, gamma, ts, wanted, name, balanced, progress, bool(suprema)
        )
    if values is None:
        from .diffrax_blocks import run_blocks

        solver = _general(method) if solver is None else solver
        name = type(solver).__name__
        values = run_blocks(scene, eps, gamma, ts, wanted, solver, balanced, progress)
    if not suprema:
        values = {key: v for key, v in values.items() if key not in _SUPREMA}
    shape = (gamma.size, eps.size)
    columns: dict[str, tuple] = {
        key: (_DIMS[: value.ndim + 1], value.reshape(*shape, *value.shape[1:]))
        for key, value in values.items()
    }
    columns["viscosity"] = (_DIMS[:2], viscosity_of(eps, gamma[:, None]))
    columns |= {key: (_DIMS[2:], v) for key, v in _limit_values(scene, limit).items()}
    import xarray as xr  # 0.4 s, which another thread may spend while cells run

    # All variables at once: one by one they are aligned anew, 1 ms each.
    warn_of_failed(columns["status"][1], gamma, eps, frames=1)  # `with_nan`
    data = xr.Dataset(columns, coords={"gamma": gamma, "eps": eps, "time": np.asarray(ts)})
    data = describe(data, scene, accuracy=wanted, solver=name)
    if suprema:
        found = coefficients_jit(scene.potential)
        known = slide_data(scene, found, np.asarray(eps))
        data.attrs |= {} if known is None else known.attributes()
    return data


def _general(method: Any) -> Any:
    """A solver of diffrax."""
    from ..wiggly import solver_of  # and diffrax, 0.5 s

    return solver_of(method)


def _limit_values(scene: Scene, limit: LimitSolution) -> dict[str, np.ndarray]:
    found = coefficients_jit(scene.potential)
    rho_plus, rho_minus = float(found.rho_plus), float(found.rho_minus)
    load, lower, upper = strips_at(scene, rho_plus, rho_minus, np.asarray(limit.ts))
    values = {
        "z_limit": limit.z,
        "dissipation_limit": limit.dissipation,
        "load": load,
        "z_minus": lower,
        "z_plus": upper,
    }
    return {name: np.asarray(value) for name, value in values.items()}
