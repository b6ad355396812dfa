"""Both effects of the nap on one bristle under one load: with and without turning over."""

from typing import Any

import numpy as np

from .._checks import require
from ..effects import nap_flip_among
from ..limit import solve_limit
from ..model import Scene, require_times
from .nap_effect import Nap, nap
from .support_spring import support_rows

_WAYS = ("geometric", "energetic")


def nap_loops(scene: Scene, ts: Any = None) -> Any:
    """Limits of a scene with `effects.NapFlip` with it and without, as a data set.

    Over `effect` and `time` (s): "geometric", the rod stiff, so that it keeps its nap and
    friction is `rho_with` one way and `rho_against` the other; "energetic", the rod turning
    over, so that it slides with its nap both ways, with `rho_with` and `rho_flipped` (of
    `nap`; in N, attributes too). `z` in m, `force = l - Phi'(z)` on the root in N, `mode`,
    and the `dissipation` in J. `ts`: as in `solve_limit`.

    Raises `ValueError` as `solve_limit` does, and for a scene without the effect.
    """
    effect = nap_flip_among(scene.effects)
    require(effect is not None, "scene.effects", "none of NapFlip", "effects.NapFlip")
    assert effect is not None
    profile, rod = scene.profile, scene.bristle
    assert profile is not None
    assert rod is not None
    ts = require_times(scene, ts)
    bent = solve_limit(scene, ts)  # first: it refuses more
    stiff = solve_limit(scene.replace(effects=()), ts)
    law = nap(profile, rod, effect.bending_stiffness)
    import xarray as xr  # 0.4 s

    both = ("effect", "time")
    rows = [support_rows(scene, ts, one.z) for one in (stiff, bent)]
    modes = [np.ones(len(ts), int), bent.mode]
    columns = {
        "z": (both, _stacked([one.z for one in (stiff, bent)]), _told("m", "state")),
        "force": (
            both,
            _stacked([row.force for row in rows]),
            _told("N", "force on the root, l - Phi'(z)"),
        ),
        "mode": (both, _stacked(modes), _told("1", "1, -1: how the rod stands; 0: bent")),
        "dissipation": (
            both,
            _stacked([one.dissipation for one in (stiff, bent)]),
            _told("J", "energy lost since the start"),
        ),
    }
    coords = {"effect": list(_WAYS), "time": ("time", np.asarray(ts), {"units": "s"})}
    return xr.Dataset(columns, coords=coords, attrs=_frictions(law))


def _frictions(law: Nap) -> dict[str, float]:
    return {name: getattr(law, name) for name in ("rho_with", "rho_against", "rho_flipped")}


def _stacked(rows: list[Any]) -> np.ndarray:
    return np.stack([np.asarray(row) for row in rows])


def _told(unit: str, meaning: str) -> dict[str, str]:
    return {"units": unit, "long_name": meaning}
