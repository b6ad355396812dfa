"""Heights of a profile as a machine tool follows them."""

import io
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from ..._checks import require_real, require_whole, write_whole
from ...profiles import AbstractProfile


def surface_heights(
    profile: AbstractProfile, period: Any, samples: int = 1024
) -> Float[np.ndarray, "rows 2"]:
    """Positions and heights in m over one period, shape (samples + 1, 2).

    A surface of this `period` (m, the eps of the theory) has the height
    `period w(x/period)`; the last row closes the period. Heights are counted from the
    lowest sample.

    Raises `ValueError` for a period that is not positive, or fewer samples than resolve
    the profile (a quarter of `profile.points`, and 16).
    """
    require_real("period", period, "period > 0 in m", lambda v: v > 0)
    least = max(16, profile.points // 4)
    require_whole("samples", samples, least, " to resolve the surface")
    y = np.arange(samples + 1) / samples
    w = np.asarray(jax.vmap(profile)(jnp.asarray(y)))
    w = w - np.min(w)
    w[-1] = w[0]
    return np.column_stack([float(period) * y, float(period) * w])


def write_heights(path: Path, profile: AbstractProfile, period: Any, samples: int) -> None:
    """Write `surface_heights` as CSV with the header `x_m,height_m`."""
    rows = surface_heights(profile, period, samples)
    text = io.StringIO()
    np.savetxt(text, rows, fmt="%.12e", delimiter=",", header="x_m,height_m", comments="")
    write_whole(path, text.getvalue())
