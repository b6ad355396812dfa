"""How profiles are looked at, fitted and trusted: with what lost."""

from typing import NamedTuple


class Settings(NamedTuple):
    """Lengths in periods, noise in standard deviations, unless said otherwise."""

    # What repeats as a C^2 function (`profile.py`).
    inside: float = 1e-7  # before the seam
    seam: float = 1e-6  # of the largest value
    jump: float = 1e-9  # of it: between neighbouring samples, beyond what slopes explain

    places: int = 64  # looked at in the periods beside: is it the same there?

    together: int = 1024  # samples that a function is asked for at once

    # Polylines (`polyline.py`).
    a_corner: int = 8  # samples in the narrowest corner, and on the shortest flank
    fewest: int = 256  # samples a period
    most: int = 8192
    unseen: int = 4096  # where traced numbers cannot be looked at
    narrowest: float = 1e-12  # where two flanks go on as one there is nothing to round
    thinnest: float = 1e-9  # corner that is sampled

    # Traces of heights (`heights.py`).
    frequency_step: float = 0.1  # of the grid of frequencies, of one wave in the trace
    longest: float = 2.9  # in the trace that a multiple of the strongest wave needs
    # Of the variance of what is left: less by that, a multiple of the period is the period,
    # if that was more than this share of the heights'.
    halves: float = 0.5
    repeats: float = 0.5  # of the variance: heights of which less is periodic do not repeat
    worth: float = 1e-6
    # Chance that noise passes for waves of a longer period, and how many waves beside them
    # say what noise has (`subharmonics.py`).
    by_chance: float = 1e-4
    controls: int = 16
    period_found: float = 1e-9  # of the trace
    most_deciding: int = 16  # harmonics that decide on the period
    rounding: float = 1e-12  # of the largest height: what varies less
    beyond: int = 4  # times the harmonics asked for, to see the rest
    seen: int = 128  # harmonics, at most

    # Rows of maps (`rows.py`).
    blocks: int = 10  # of neighbouring rows, which are not independent of each other

    # Rows in phase (`alignment.py`).
    passes: int = 50
    in_phase: float = 1e-9  # periods that no row moves by any more

    # The Gaussian filter (`smoothing.py`).
    least_left: float = 1e-2  # of the fundamental: less is no surface any more

    # Steepest slopes of samples (`steepest.py`).
    ladder: tuple[int, ...] = (2, 4, 8)  # windows, of the last harmonic that stands out
    certain: float = 2.0
    # Of what windows and interpolant differ by: they err a little themselves.
    share: float = 1.1
    apart: float = 3.5  # of a band above its noise, and a little more
    a_little: float = 4.0
    # A flank of 2 samples is known to half, one of 1 not at all.
    few: float = 3.0
    too_few: float = 0.6
    octaves: float = 1.5  # of the slopes of the last octave of waves: those beyond
    # Of the steepest slope, beyond the waves seen: with more windows decide.
    resolved: float = 0.5
    let_through: float = 0.75  # of the noise of slopes, by windows
    fine: int = 16  # places in the shortest wave
    newton: int = 3  # steps from the best of them
    noise_floor: float = 1e-15  # of the range of heights

    # What filters take off (`filtered.py`).
    # Of the error. Of 360 surfaces with noise of 1%, stated errors hold of 96.5% (of 98% at
    # 0.3%); with half this margin of 94.7%.
    margin: float = 0.5
    # Of the slope: where noise leaves the waves before the filter open by more they only
    # bound what is said. (With a margin there too, a sine with 0.6% of noise was called
    # open in one of ten, now in one of 25.)
    known: float = 0.2

    # Errors of steepest slopes (`slope_errors.py`).
    warned: float = 0.1  # of a steepest slope: friction is about as wrong
    fewest_heights: int = 8  # that say anything of what is between them
    designed: int = 16  # heights: fewer are points of a design, whose spline is meant
    same: float = 1e-9  # of the range: an end point that was copied
    alike: float = 0.02  # of the range: one that was measured again
    ends: int = 8  # of heights that are looked for at the other end
    other: float = 10.0  # times that they differ: by less ends are flat, not repeated
    # The seam without the point, in terms of with it.
    clearly: float = 0.9  # as smooth, but for rounding, is no sign
    smoother: float = 0.3
    as_sharp: float = 2.0


SETTINGS = Settings()
