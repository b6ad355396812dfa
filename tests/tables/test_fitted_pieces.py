"""Functions met by polynomials on pieces."""

import numpy as np
import pytest
from numpy.polynomial import Chebyshev

from frictionjax.tables.fitted_pieces import fitted_pieces
from frictionjax.tables.settings import SETTINGS

RNG = np.random.default_rng(3)
PLACES = np.sort(np.concatenate([RNG.uniform(0, 1, 4000), np.arange(64) / 64]))
WHOLE = np.array([0.0, 1.0])
FUNCTIONS = {
    "constant": (lambda y: np.full_like(y, 0.7), WHOLE, 1),
    "polynomial": (lambda y: 3 * y**8 - y + 0.2, WHOLE, 1),
    "wave": (lambda y: np.sin(2 * np.pi * y + 0.3), WHOLE, 32),
    "bump": (lambda y: y + 0.1 * np.exp(-(((y - 0.4) / 0.02) ** 2)), WHOLE, 80),
    "twenty waves": (lambda y: np.sin(40 * np.pi * y), WHOLE, 1024),
    "kinks": (
        lambda y: np.abs(y - 0.3) + np.sin(9 * np.abs(y - 0.71)),
        np.array([0.0, 0.3, 0.71, 1.0]),
        32,
    ),
}


def values_of(pieces, places):
    which = np.searchsorted(pieces.left, places, side="right") - 1
    t = places - pieces.left[which]
    return sum(pieces.terms[which, k] * t**k for k in range(pieces.terms.shape[1]))


@pytest.mark.parametrize("name", FUNCTIONS)
def test_pieces_are_the_function_to_rounding_and_few(name):
    fn, edges, most = FUNCTIONS[name]
    found = fitted_pieces(fn, edges)
    assert found.left.size <= most
    assert found.left[0] == 0
    assert np.all(np.diff(found.left) > 0)
    assert np.isin(edges[:-1], found.left).all()
    expected = fn(PLACES)
    size = np.abs(expected).max()
    steepest = np.max(np.abs(np.diff(expected) / np.diff(PLACES)))
    allowed = 4e-15 * size + 1e-15 * steepest
    assert np.max(np.abs(values_of(found, PLACES) - expected)) < allowed
    # And its slopes, to what differences of values leave of them.
    step = 1e-6
    inside = PLACES[np.min(np.abs(PLACES[:, None] - edges), axis=1) > 2 * step]
    slopes = [
        (f(inside + step) - f(inside - step)) / (2 * step)
        for f in (fn, lambda y: values_of(found, y))
    ]
    assert np.max(np.abs(slopes[0] - slopes[1])) < 1e-7 * max(size, steepest)


def test_a_kink_inside_takes_ever_shorter_pieces():
    found = fitted_pieces(lambda y: np.abs(y - 0.3) ** 1.5, WHOLE)
    widths = np.diff(np.append(found.left, 1.0))
    assert widths.min() < 1e-8
    assert widths.max() > 0.01


@pytest.mark.parametrize("at", [0.5, 0.3137, 0.75])
def test_a_rise_between_two_nodes_is_not_stepped_over(at):
    """At the end of two halves both saw a line."""

    def fn(y):
        return y + 0.05 * (1 + np.tanh((y - at) / 3e-5))

    found = fitted_pieces(fn, WHOLE)
    places = np.append(PLACES, at + np.linspace(-2e-4, 2e-4, 201))
    assert np.max(np.abs(values_of(found, places) - fn(places))) < 1e-11


@pytest.mark.parametrize(
    "fn",
    [
        lambda y: np.where(y < 0.3, 0.0, np.nan),
        lambda y: y + 1e-9 * RNG.normal(size=y.shape),
        lambda y: np.sin(2e5 * y),
    ],
    ids=["no number", "noise", "too many waves"],
)
def test_what_polynomials_do_not_meet_has_no_pieces(fn):
    assert fitted_pieces(fn, WHOLE) is None


def test_what_lies_between_the_nodes_is_seen():
    """A polynomial that vanishes at all of them."""
    count = SETTINGS.degree + 1
    found = fitted_pieces(Chebyshev.basis(count, domain=[0, 1]), WHOLE)
    assert found.left.size > 1
