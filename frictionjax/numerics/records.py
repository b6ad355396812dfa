"""Records whose arrays share their first axis: some rows of one, all rows of several."""

from collections.abc import Iterable
from typing import Any, TypeVar

import jax
import numpy as np

Record = TypeVar("Record")


def rows_of(record: Record, rows: Any) -> Record:
    """Some rows of every array: an index, indices, a mask, or a slice."""
    return jax.tree_util.tree_map(lambda column: np.asarray(column)[rows], record)


def concatenated(records: Iterable[Record]) -> Record:
    """All rows of records of one kind, in their order."""
    return jax.tree_util.tree_map(lambda *columns: np.concatenate(columns), *records)


def stacked(records: Iterable[Record]) -> Record:
    """A record of columns from one record a row."""
    return jax.tree_util.tree_map(lambda *values: np.array(values), *records)
