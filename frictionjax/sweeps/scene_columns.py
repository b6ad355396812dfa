"""Values of all cells eps x gamma of one scene, by their names in a data set."""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Array, Float, UInt32

from .._checks import cells_of, viscosity_of
from ..effects import (
    AxialLoad,
    Inertia,
    NapFlip,
    Noise,
    inertia_among,
    nap_flip_among,
    noise_among,
)
from ..limit import LimitSolution, solve_limit
from ..model import Scene, coefficients_jit, scene_of_tables, strips_at, tabulated_scene
from ..slide_laws import slide_data
from ..wiggly import Status, integrate_scene
from .noiseless import without_noise

DIMS = ("gamma", "eps", "time")
SUPREMA = ("sup_error", "strip_excess", "survey_error")

Columns = dict[str, tuple[tuple[str, ...], Any]]


class SweepRequest(NamedTuple):
    """What is asked of every scene, checked.

    `eps` (m) falling, `gamma` rising, `ts` in s, `accuracy` in eps. `method`: of the lanes;
    `solver`: of diffrax, instead, where one is asked for. `key`: of scenes with noise, its
    two words.
    """

    eps: Float[np.ndarray, " e"]
    gamma: Float[np.ndarray, " g"]
    ts: Float[Array, " n"]
    accuracy: float
    method: str
    solver: Any
    balanced: bool
    suprema: bool
    key: UInt32[np.ndarray, " 2"] | None


class SceneColumns(NamedTuple):
    """Columns of one scene with their dims, what the laws need, and who has integrated.

    `compiled_for`: parts of it that lanes needed programs of their own for, in words.
    `missing`: why variables are NaN, by name.
    """

    columns: Columns
    laws: dict[str, Any]
    method: str
    compiled_for: str
    missing: dict[str, str]


def scene_columns(
    scene: Scene, request: SweepRequest, report: Callable[[float], None]
) -> SceneColumns:
    """Solve all cells of a scene; `report` is told each share that is done."""
    limit = solve_limit(without_noise(scene), request.ts)
    values, method, own = None, request.method, ""
    inertia, turning = inertia_among(scene.effects), nap_flip_among(scene.effects)
    noise = noise_among(scene.effects)
    apart: Columns = {}
    if noise is not None:
        values, apart = _with_noise(scene, noise, request, report)
    elif request.solver is None:
        if turning is not None:
            from .turning_columns import turning_values  # nothing else needs it

            values = turning_values(scene, turning, request, report)
        elif inertia is not None:
            values = _with_mass(scene, inertia, request, report)
        else:
            values = _by_lanes(scene, request, report)
        own = tabulated_scene(scene, request.eps).untabulated
    if values is None:
        values, method = _by_diffrax(scene, request, report)
    if not request.suprema:
        values = {name: v for name, v in values.items() if name not in SUPREMA}
    shape = request.gamma.size, request.eps.size
    columns: Columns = {
        name: (DIMS[: value.ndim + 1], value.reshape(*shape, *value.shape[1:]))
        for name, value in values.items()
    }
    columns |= apart
    columns["viscosity"] = (DIMS[:2], viscosity_of(request.eps, request.gamma[:, None]))
    known = _limit_values(scene, turning, limit)
    columns |= {name: (DIMS[2:][: v.ndim], v) for name, v in known.items()}
    modes = None if turning is None else columns["mode"][1]
    reading = _compression_of(scene, request.eps, columns["z"][1], modes)
    if reading is not None:
        columns["compression"] = DIMS[:2], reading.compression
        share = "buckling_share" if turning is None else "sprung_share"
        columns[share] = DIMS[:2], reading.share
    if turning is not None:
        from .turning_columns import NOTHING_OF_IT, attributes  # nothing else needs it

        facts = attributes(scene, turning)
        return SceneColumns(columns, facts, method, own, NOTHING_OF_IT)
    of_slides = None
    if request.suprema and inertia is None and noise is None:
        # Laws are of overdamped slides without noise.
        found = coefficients_jit(scene.potential)
        of_slides = slide_data(scene, found, np.asarray(request.eps))
    laws = {} if of_slides is None else of_slides.attributes()
    return SceneColumns(columns, laws, method, own, {})


def _by_lanes(
    scene: Scene, request: SweepRequest, report: Callable[[float], None]
) -> dict | None:
    """Values of all cells, by name; None where lanes do not serve."""
    lane_eps, lane_gamma = cells_of(request.eps, request.gamma)
    found, apart = integrate_scene(
        scene=scene,
        eps=lane_eps,
        gamma=lane_gamma,
        ts=np.asarray(request.ts),
        accuracy=request.accuracy,
        method=request.method,
        balanced=request.balanced,
        report=report,
        suprema=request.suprema,
    )
    if found is None:
        return None
    values = found._asdict()
    if apart is not None:
        values["z_spread"] = apart
    values["status"] = values["status"].astype(np.int8)
    values["how"] = values["how"].astype(np.int8)
    values["bracket"] = values.pop("gap")
    failed = ~np.isin(values["status"], (Status.OK, Status.UNBALANCED, Status.ROUGH_SURVEY))
    for name in ("residual", "dissipation_gap", "dissipation_error", *SUPREMA):
        values[name] = np.where(failed, np.nan, values[name])
    unused = ["running_residual", "survey_work_error"]
    if not request.balanced:
        unused += ["dissipation", "dissipation_error", "residual", "dissipation_gap"]
    return {name: value for name, value in values.items() if name not in unused}


def _with_mass(
    scene: Scene,
    inertia: Inertia,
    request: SweepRequest,
    report: Callable[[float], None],
) -> dict[str, np.ndarray]:
    """Values of all cells with inertia, by name; NaN for what tells of brackets."""
    from ..wiggly import MAX_STEPS, integrate_with_mass  # nothing else needs it

    found = integrate_with_mass(
        scene,
        *cells_of(request.eps, request.gamma),
        inertia=inertia,
        ts=np.asarray(request.ts),
        accuracy=request.accuracy,
        suprema=True,
        budget=MAX_STEPS,
        report=report,
    )
    values = found._asdict()
    left = values.pop("running_residual")[:, -1]
    values["status"] = values["status"].astype(np.int8)
    values["how"] = np.zeros(left.size, dtype=np.int8)
    nothing = np.full(left.size, np.nan)
    values |= {"bracket": values["spread"] * np.nan, "sampled": nothing}
    values |= {"survey_error": nothing}
    if not request.balanced:
        return {k: v for k, v in values.items() if not k.startswith("dissipation")}
    return values | {"residual": left, "dissipation_gap": left}


def _with_noise(
    scene: Scene, noise: Noise, request: SweepRequest, report: Callable[[float], None]
) -> tuple[dict[str, np.ndarray], Columns]:
    """Values of all cells with noise, and what has dims of its own.

    No energies: `int eps^gamma z'^2` of a path is infinite. No brackets, no samples.
    """
    from .noisy_cells import noisy_columns  # nothing else needs it

    assert request.key is not None
    found = noisy_columns(
        scene,
        noise,
        request.eps,
        request.gamma,
        ts=np.asarray(request.ts),
        key=request.key,
        suprema=request.suprema,
        report=report,
    )
    shape = request.gamma.size, request.eps.size
    return found.values, {
        "path_key": ((*DIMS[:2], "word"), found.keys.reshape(*shape, -1)),
        "thermal_share": (DIMS[:2], found.share.reshape(shape)),
    }


def _by_diffrax(
    scene: Scene, request: SweepRequest, report: Callable[[float], None]
) -> tuple[dict[str, np.ndarray], str]:
    """Values of all cells, and the name of the solver."""
    from ..wiggly import solver_of  # and diffrax, 0.5 s
    from .diffrax_blocks import run_blocks

    solver = solver_of(request.method) if request.solver is None else request.solver
    values = run_blocks(
        scene=scene_of_tables(scene, request.eps),
        eps=request.eps,
        gamma=request.gamma,
        ts=request.ts,
        accuracy=request.accuracy,
        solver=solver,
        balanced=request.balanced,
        report=report,
    )
    return values, type(solver).__name__


def _compression_of(scene: Scene, eps: np.ndarray, z: Any, modes: Any) -> Any:
    """What rods of the cells come to, of a scene that asks for it; else None."""
    if not any(isinstance(effect, AxialLoad) for effect in scene.effects):
        return None
    from ..contact import largest_compression  # nothing else needs it

    return largest_compression(scene, eps, z, modes)


def _limit_values(
    scene: Scene, turning: NapFlip | None, limit: LimitSolution
) -> dict[str, np.ndarray]:
    if turning is not None:
        from .turning_columns import limit_values  # nothing else needs it

        return limit_values(scene, turning, limit)
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
