"""A profile as tables: a Fourier series, or pieces of polynomials."""

import math
from functools import singledispatch
from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Complex, Float

from .._checks import ByIdentity
from .._compile import values_at
from ..profiles import AbstractProfile, Fourier, Polyline, Sine, Spline
from .pieces import Pieces, PiecewiseProfile, piecewise
from .polyline_pieces import polyline_pieces
from .profile_pieces import profile_in_pieces
from .settings import SETTINGS, size_for
from .waves import SeriesProfile, Waves


class ProfileTables(NamedTuple):
    """One profile as lanes evaluate it, a place after the other, and as planning does.

    `height`: the largest |w| of samples, in periods.
    """

    lanes: AbstractProfile
    planning: AbstractProfile
    height: float

    @property
    def is_table(self) -> bool:
        """Whether it is numbers alone; else programs are compiled for its class."""
        return isinstance(self.planning, SeriesProfile | PiecewiseProfile)


class Series(NamedTuple):
    """`mean`, and coefficients of cosines and sines from the first harmonic, (n,) each."""

    mean: float
    cos: Float[np.ndarray, " n"]
    sin: Float[np.ndarray, " n"]


_TABLES = ByIdentity()  # of profiles that are known


def profile_tables(profile: AbstractProfile) -> ProfileTables:
    """The tables of a profile of known numbers; itself where no table is exact.

    Exact is what is at rounding in places that the table was not made of.
    """
    known = _TABLES.get(profile)
    if known is None:
        known = _found(profile)
        # A note must not refer to what it is on.
        _TABLES.put(profile, known if known.is_table else known.height)
    return ProfileTables(profile, profile, known) if isinstance(known, float) else known


def _found(profile: AbstractProfile) -> ProfileTables:
    height = float(np.max(np.abs(values_at(profile, _places(profile.points)))))
    if isinstance(profile, PiecewiseProfile):
        return ProfileTables(profile, profile, height)
    shape = _shape_of(profile)
    if isinstance(shape, Series):
        return _in_series(shape, height)
    pieces = None if shape is None else piecewise(shape, profile.points)
    found = pieces or profile_in_pieces(profile) or profile
    return ProfileTables(found, found, height)


def _places(count: int) -> np.ndarray:
    return np.arange(count) / count


def _in_series(series: Series, height: float) -> ProfileTables:
    count = series.cos.size
    size = size_for(count, SETTINGS.harmonics) or count
    cos, sin = (jnp.asarray(np.pad(c, (0, size - count))) for c in (series.cos, series.sin))
    parts = jnp.asarray(series.mean), cos, sin
    alone = SeriesProfile(*parts)
    if size <= SETTINGS.written_out:
        return ProfileTables(alone, Waves(*parts), height)
    pieces = _pieces_of(series, alone) or alone
    return ProfileTables(pieces, pieces, height)


def _pieces_of(series: Series, profile: SeriesProfile) -> PiecewiseProfile | None:
    """Of a long series, as `waves_in_pieces`.

    What is left out is (pi n/pieces)^9/9! of harmonic n, 5e-18 for 64, and 1e-13 of its
    second derivative.
    """
    if profile.cos.shape[0] > SETTINGS.harmonics[-1]:
        return None
    return waves_in_pieces(series.mean, series.cos - 1j * series.sin, profile.points)


def waves_in_pieces(
    mean: float,
    waves: Complex[np.ndarray, " harmonics"],
    points: int,
    room: int = SETTINGS.pieces,
) -> PiecewiseProfile | None:
    """`mean + Re sum_n waves_n exp(2 pi i n y)`: Taylor polynomials about the middles of
    many pieces."""
    count = room - SETTINGS.few
    turn = 2j * np.pi * np.arange(1, waves.size + 1)
    waves = 0.5 * waves * np.exp(turn * 0.5 / count)
    middle = np.empty((SETTINGS.degree + 1, count))
    for power in range(SETTINGS.degree + 1):
        spectrum = np.zeros(count // 2 + 1, complex)
        spectrum[1 : turn.size + 1] = waves * turn**power / math.factorial(power)
        middle[power] = np.fft.irfft(count * spectrum, count)
    middle[0] += mean
    terms = _moved(middle, -0.5 / count)
    return piecewise(Pieces(_places(count), terms.T), points, (room,))


def room_of_waves(waves: Complex[np.ndarray, " harmonics"], most: float) -> int | None:
    """The smallest room in which slopes of the pieces are off by `most` at most."""
    n, order = np.arange(1, waves.size + 1), SETTINGS.degree
    slopes = 2 * np.pi * n * np.abs(waves)
    for room in SETTINGS.rooms:
        left_out = (np.pi * n / (room - SETTINGS.few)) ** order / math.factorial(order)
        if n[-1] < room // 2 and np.sum(slopes * left_out) <= most:
            return room
    return None


def _moved(
    terms: Float[np.ndarray, "powers n"], by: float
) -> Float[np.ndarray, "powers n"]:
    """The same polynomials in `t - by`."""
    count = terms.shape[0]
    return np.stack(
        [
            sum(math.comb(m, k) * by ** (m - k) * terms[m] for m in range(k, count))
            for k in range(count)
        ]
    )


@singledispatch
def _shape_of(profile: AbstractProfile) -> Series | Pieces | None:
    """What the profile is made of; of functions and classes of the user's, if a series."""
    return _series_of(profile)


@_shape_of.register
def _(profile: Sine) -> Series:
    # `2 * jnp.pi` divides in the same order in the profile itself.
    return Series(0.0, np.zeros(1), np.asarray(profile.slope)[None] / (2 * np.pi))


@_shape_of.register
def _(profile: Fourier) -> Series:
    cos, sin = np.asarray(profile.cos), np.asarray(profile.sin)
    used = int(np.max(np.flatnonzero((cos != 0) | (sin != 0)))) + 1
    return Series(0.0, cos[:used], sin[:used])


@_shape_of.register
def _(profile: Spline) -> Pieces:
    c = np.asarray(profile.coefficients)
    before, after, next_ = np.roll(c, 1), np.roll(c, -1), np.roll(c, -2)
    terms = np.stack(
        [
            (before + 4 * c + after) / 6,
            (after - before) / 2,
            (before - 2 * c + after) / 2,
            (next_ - 3 * after + 3 * c - before) / 6,
        ],
        axis=1,
    )
    return Pieces(np.arange(c.size) / c.size, terms * float(c.size) ** np.arange(4))


@_shape_of.register
def _(profile: Polyline) -> Pieces:
    return polyline_pieces(profile)


def _series_of(profile: AbstractProfile) -> Series | None:
    """The series that meets a profile at all its samples, twice its own at least."""
    count = SETTINGS.samples
    finer = max(2, -(-profile.points // count))
    values = values_at(profile, _places(finer * count))
    waves = np.fft.rfft(values[::finer]) / count
    waves[1:] *= 2
    # A height that all share has no friction, but rounds what is beside it.
    size, noise = float(np.ptp(values)), np.finfo(float).eps * float(np.max(np.abs(values)))
    least = max(SETTINGS.negligible * size, noise)
    used = int(np.max(np.flatnonzero(np.abs(waves) > least), initial=1))
    if used > SETTINGS.harmonics[-1] or not noise <= SETTINGS.met * size < np.inf:
        return None
    short = np.where(np.arange(waves.size) <= used, waves, 0)
    short[1:] /= 2
    fine = np.fft.irfft(short * finer * count, finer * count)
    if np.max(np.abs(fine - values)) > SETTINGS.met * size:
        return None
    return Series(float(waves[0].real), waves.real[1 : used + 1], -waves.imag[1 : used + 1])
