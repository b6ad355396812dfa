"""Brackets that know of no landings: their lanes set off two slips behind the tip."""

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
import pytest

from frictionjax.wiggly import plan


@contextmanager
def without_landings() -> Iterator[None]:
    """Plans made meanwhile have none."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(plan, "latest_landings", _unknown)
        yield


def _unknown(wells, lag, *pulls):
    return np.full(lag.shape, np.inf)
