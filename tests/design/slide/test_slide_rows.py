"""Slides of known parts in one program."""

import jax
import numpy as np
import pytest

import frictionjax as fx
from frictionjax.design.slide.slide_rows import find_slides, rows_of_slides, slide_table
from frictionjax.wiggly import Status

SLANTED = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0)
BOTH = np.array([1.0, -1.0])


def surfaces(count):
    rng = np.random.default_rng(0)
    for _ in range(count):
        harmonics = rng.integers(1, 6)
        rows = 0.008 * rng.normal(size=(2, harmonics)) / np.arange(1, harmonics + 1) ** 2
        yield fx.profiles.Fourier(*rows)


def test_slides_of_the_least_viscosity_are_found():
    """A third was not: steps of a landing did not replay but from where they were made."""
    profiles, eps = list(surfaces(24)), 1e-7
    tables = [slide_table(fx.potential(one, SLANTED), eps) for one in profiles]
    which = np.repeat(np.arange(24), 2)
    rows = rows_of_slides(which, eps, 2.0, 1.0, 1.0, np.tile(BOTH, 24))
    sides = find_slides(tables, rows)
    good = sides.code == int(Status.OK)
    assert np.mean(good) > 0.95
    laws = [fx.friction(one, SLANTED) for one in profiles]
    rho = np.array([[float(law.rho_plus), float(law.rho_minus)] for law in laws]).ravel()
    # A slip lowers the force by k_h eps.
    off = sides.mean / (rho - np.tile(BOTH, 24) * eps / 2) - 1
    assert np.max(np.abs(off[good])) < 1e-6


def test_other_parts_are_other_rows_of_the_same_program():
    """Parts of any class: what is compiled for one serves all."""
    parts = [
        (fx.profiles.Sine(0.1), SLANTED),
        (fx.profiles.Fourier([0.01, 0.0], [0.0, 0.003]), SLANTED),
        (fx.profiles.Sine(0.1), fx.bristles.AngularSpring(1.0, 1.5, 1.0, 0.2)),
        (fx.profiles.Sine(0.2), fx.bristles.VerticalSpring(1.0, 2.0, 1.0)),
    ]
    shapes = {
        tuple(np.shape(leaf) for leaf in jax.tree_util.tree_leaves(slide_table(p, 1e-2)))
        for p in (fx.potential(*pair) for pair in parts)
    }
    assert len(shapes) == 1


def test_a_row_is_what_it_is_alone_whatever_stands_beside_it():
    tables = [
        slide_table(fx.potential(profile, SLANTED), 1e-2)
        for profile in (fx.profiles.Sine(0.1), *surfaces(2))
    ]
    eps = np.array([1e-2, 1e-3, 5e-3, 1e-4, 1e-2])
    which, sign = np.array([0, 1, 2, 1, 0]), np.array([1.0, 1.0, -1.0, -1.0, -1.0])
    rows = rows_of_slides(which, eps, 1.0, 2.0, 0.5, sign)
    found = find_slides(tables, rows)
    for n in range(5):
        one = rows_of_slides(0, eps[n : n + 1], 1.0, 2.0, 0.5, sign[n])
        alone = find_slides([tables[which[n]]], one)
        assert found.mean[n] == pytest.approx(alone.mean[0], rel=1e-13)
        assert found.peak[n] == pytest.approx(alone.peak[0], rel=1e-13)


def test_more_harmonics_than_tables_have_are_as_many_as_there_are():
    sizes = [
        slide_table(fx.potential(fx.profiles.Fourier(cos, 0 * cos), SLANTED), 1e-2)
        for cos in (1e-3 * 0.9 ** np.arange(n) / np.arange(1, n + 1) for n in (3, 100))
    ]
    assert [table.profile.cos.size for table in sizes] == [8, 100]


@pytest.mark.slow  # programs for the parts
def test_what_no_table_holds_goes_as_it_is():
    own = fx.profiles.Custom(
        lambda y: 0.02 * jax.numpy.abs(jax.numpy.sin(np.pi * y)) ** 2.5
    )
    potential = fx.potential(own, SLANTED)
    table = slide_table(potential, 1e-2)
    sides = find_slides([table], rows_of_slides(0, 1e-2, 1.0, 1.0, 1.0, BOTH))
    slide = fx.steady_slide(own, SLANTED, 1e-2)
    assert float(slide.mean_plus) == pytest.approx(sides.mean[0], rel=1e-12)
    assert np.all(sides.code == int(Status.OK))
