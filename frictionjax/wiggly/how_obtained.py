"""How the values of a trajectory were obtained, in words."""

from typing import Any

import numpy as np

from .._checks import is_known
from ..called_for import left_out_in_words


def how_in_words(words: str, counts: dict[str, Any]) -> str:
    """What a solution's `counts` say of it; `words`: what they do not.

    Where it is traced, without numbers.
    """
    known, left_out = is_known(counts), counts.get("left_out")
    if "how" in counts:
        lanes = "from lanes"
        if known:
            lanes = _of_lanes(np.asarray(counts["how"]), np.asarray(counts["sampled"]))
        words = lanes + words
    if left_out:
        named = left_out_in_words(left_out) if known else ", ".join(left_out)
        words += f"; without {named}"
    return words


def _of_lanes(how: np.ndarray, sampled: np.ndarray) -> str:
    if not how.any():
        return "resolved, every slip since z0, by one lane"
    share = f"{np.mean(how > 0):.0%} of them from brackets that closed"
    if np.any(how == 2):
        share += f", {np.mean(how == 2):.0%} set off from a slip map"
    if np.all(np.isnan(sampled)):
        return f"windowed, values at the times alone; {share}"
    part = float(np.nanmean(sampled))
    if part:
        return f"windowed, {share}; {part:.0%} of the way known from some of its slips"
    return f"resolved, every slip, in tiles; {share}"
