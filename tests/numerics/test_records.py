"""Records of columns are cut and joined by their fields, nested ones too."""

from typing import NamedTuple

import numpy as np

from frictionjax.numerics import concatenated, rows_of, stacked


class Inner(NamedTuple):
    weight: np.ndarray


class Outer(NamedTuple):
    inner: Inner
    name: np.ndarray


WHOLE = Outer(Inner(np.array([0.1, 0.2, 0.3])), np.array(["a", "b", "c"], dtype=object))


def test_chosen_rows_keep_their_fields():
    some = rows_of(WHOLE, np.array([2, 0]))
    assert some.inner.weight.tolist() == [0.3, 0.1]
    assert some.name.tolist() == ["c", "a"]


def test_joined_parts_are_the_whole():
    parts = rows_of(WHOLE, slice(0, 1)), rows_of(WHOLE, slice(1, None))
    again = concatenated(parts)
    assert isinstance(again.inner, Inner)
    np.testing.assert_array_equal(again.inner.weight, WHOLE.inner.weight)
    np.testing.assert_array_equal(again.name, WHOLE.name)


def test_rows_of_numbers_become_columns():
    columns = stacked([Inner(1.0), Inner(2.0)])
    np.testing.assert_array_equal(columns.weight, [1.0, 2.0])
    assert columns.weight.dtype == float
