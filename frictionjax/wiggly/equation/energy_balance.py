"""Energy-dissipation balance of a numerical solution, one step at a time."""

from collections.abc import Callable
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool

from ..._checks import Real
from ...numerics import cubic, cubic_slope
from .field import Point, TipField
from .settings import SETTINGS

_NODES = (0.5 - 0.5 / 3**0.5, 0.5 + 0.5 / 3**0.5)  # two-point Gauss on [0, 1]


class Balance(NamedTuple):
    """Running integrals over [0, t], in J.

    `work`: int l' (z - reference), with which `E(0) - E(t) - work` is the energy dissipated
    where the reference is 0. `viscous`: int eps^gamma z'^2 of the interpolated curve, an
    independent second value. `residual`: int (eps^gamma z' + D E)^2/(2 eps^gamma), zero for
    a solution only.
    """

    work: Real
    viscous: Real
    residual: Real


def slopes_between(
    start: Point, end: Point, step: Real, way: Real
) -> tuple[Real, Real, Bool[Array, ""]]:
    """Slopes for interpolating a step over `way` periods, and whether it ends in a rest.

    On a step from a slip deep into the rest behind it, the first slope is a spike through
    which the cubic would swing without bound; out of a rest on a corner, the last one is;
    where a rest is on a fold, any. Steps on which the tip turns are steep for their way
    too, but nearly parabolas. (Taken for spikes: 0.4% of the dissipation of three wells
    lost behind a kink, at any tolerance.)
    """
    slope0, _ = _end_slope(start, step)
    slope1, rest = _end_slope(end, step)
    chord = way / step
    steepest = SETTINGS.steep * jnp.abs(chord)
    size0, size1 = jnp.abs(slope0), jnp.abs(slope1)
    twist = jnp.abs(slope0 + slope1 - 2 * chord)
    spiked = twist > SETTINGS.twist * jnp.maximum(size0, size1)
    slope0 = jnp.where(spiked & (size0 > steepest), chord, slope0)
    slope1 = jnp.where(spiked & (size1 > steepest), chord, slope1)
    return slope0, slope1, rest


def _end_slope(point: Point, step: Real) -> tuple[Real, Bool[Array, ""]]:
    """Slope for interpolating a step's end, and whether the step is a rest there.

    On a rest the computed velocity is the position error over a relaxation time, which
    over a long step swings the interpolant by up to half a period at gamma = 2. The
    slope of the equilibrium branch, -y'_t/y'_y, is what the solution follows.
    """
    rest = -step * point.by_state > SETTINGS.stiff
    branch = -point.by_time / jnp.where(rest, point.by_state, 1.0)
    return jnp.where(rest, branch, point.velocity), rest


def _settled(point: Point, step: Real) -> tuple[Real, Real]:
    """How far a rest is from its branch, in periods, and what settling adds to int y'^2.

    Nothing where the force bends on the way. The cubic of a step through such a fall has
    2.4 relaxation times over the step of what that dissipates: where the fall is less than
    the tolerance, a start on a support of 1000 N/m lost half of all its dissipation.
    """
    slope, rest = _end_slope(point, step)
    rate = jnp.where(rest, -point.by_state, 1.0)
    off = point.velocity - slope
    left = off / rate
    near = rest & (jnp.abs(left) < SETTINGS.near)
    return jnp.where(near, left, 0.0), jnp.where(near, left * (0.5 * off + 2 * slope), 0.0)


def arrival(field: TipField, t0: Real, step: Real, end: Point) -> Point:
    """The end of a step from t0 as the step comes to it: the load's slope from the left.

    A point has the slope from the right, which at a kink is another: the rest before a
    plateau then seemed to stop. On a support of 1e4 N/m a quarter of the dissipation was
    missing. From the two nodes, where slopes are taken anyway.
    """
    first, second = (field.load_slope(t0 + s * step) for s in _NODES)
    slope = second + (1 - _NODES[1]) / (_NODES[1] - _NODES[0]) * (second - first)
    return end._replace(by_time=slope / (field.viscosity * field.eps * end.stretch))


def _at_zero(t: Real) -> Real:
    return jnp.zeros_like(t)


def advance(
    field: TipField,
    balance: Balance,
    t0: Real,
    step: Real,
    y0: Real,
    y1: Real,
    start: Point,
    end: Point,
    reference: Callable[[Real], Real] = _at_zero,
) -> Balance:
    """The integrals after the step from (t0, y0) to y1, along a cubic between.

    `reference`: any curve in m, from which the work is counted. `end`: see `arrival`.
    The nodes in a loop: half the program.
    """
    viscosity = field.viscosity
    slope0, slope1, rest = slopes_between(start, end, step, y1 - y0)
    (left0, fall0), (left1, fall1) = _settled(start, step), _settled(end, step)
    falls = start.stretch**2 * fall0 - end.stretch**2 * fall1
    along = (left1 - left0) / step  # the branch, at both nodes, instead of the cubic
    ends = y0, y1, slope0, slope1

    def add(total: tuple, s: Real) -> tuple[tuple[Real, Real, Real], None]:
        y, velocity = _cubic(s, step, *ends)
        t = t0 + s * step
        force, stretch, state, _ = field.driven(t, y)
        drawn, speed = (field.eps * stretch * v for v in (velocity, velocity + along))
        work, viscous, defect = total
        work += 0.5 * step * field.load_slope(t) * (state - reference(t))
        viscous += 0.5 * step * viscosity * speed**2
        defect += 0.25 * step * (viscosity * drawn - force) ** 2 / viscosity
        return (work, viscous, defect), None

    none = jnp.zeros_like(y0)
    total = none, viscosity * field.eps**2 * falls, none
    (work, viscous, defect), _ = jax.lax.scan(add, total, jnp.array(_NODES))
    # On a rest the cubic is good to the tolerance but not to the relaxation time: the
    # defect is taken at the step's end, where the solver put the solution.
    drag = viscosity * field.eps * end.stretch
    at_end = drag * (slope1 - end.velocity)
    missing = jnp.abs(slope1 - end.velocity) / jnp.where(rest, jnp.abs(end.by_state), 1.0)
    settled = jnp.where(missing < SETTINGS.at_rest, 0.0, 0.5 * step * at_end**2 / viscosity)
    defect = jnp.where(rest, settled, defect)
    return Balance(
        work=balance.work + work,
        viscous=balance.viscous + viscous,
        residual=balance.residual + defect,
    )


def _cubic(s: Any, step: Real, y0: Real, y1: Real, slope0: Real, slope1: Real):
    """Value and slope of the cubic Hermite interpolant at the share s of the step."""
    ends = y1 - y0, step * slope0, step * slope1
    return y0 + cubic(s, *ends), cubic_slope(s, *ends) / step


def at_rest() -> Balance:
    """The integrals over an empty interval."""
    zero = jnp.zeros(())
    return Balance(zero, zero, zero)


class Errors(NamedTuple):
    """Estimates in J for a dissipation: by the direct sum, and from energies."""

    of_sum: Real
    of_energies: Real

    @property
    def sum_is_closer(self) -> Bool[Array, ""]:
        """Whether the direct sum is to be taken."""
        return self.of_sum < self.of_energies


def errors_of_sums(
    viscous: Real, residual: Real, size: Real, unit: Real | float, pulled: Real | float
) -> Errors:
    """Of the direct sum `viscous` (J), and of what energies give instead.

    `residual` (J): what steps left of the balance. `size` (J): of the energies of which
    differences are taken; `unit` (m): accuracy times eps; `pulled` (N): what the load goes
    up and down in all. Where nothing folds, the sum is closer: a support of 1000 N/m, eps =
    0.1, accuracy 1e-3: 2e-3 off from energies, 3e-5 by the direct sum. Where a start falls
    into its well, energies are. (Of 8000 random solutions with few slips or none 885 were
    out by the direct sum, 9 by energies, 113 by the sum where less than a tenth of eps
    pulled is dissipated, 8 by this.)
    """
    of_sum = SETTINGS.of_sum * abs(residual * viscous) ** 0.5  # surveys may undershoot 0
    return Errors(of_sum, SETTINGS.of_energies * unit * pulled + SETTINGS.rounding * size)


def dissipated(
    field: TipField, balance: Balance, t: Real, y: Real, start_energy: Real
) -> Real:
    """`int_0^t eps^gamma z'^2` in J from the energy lost: exact where slips are short.

    The direct sum resolves a force squared over slips; this one only `int l' z`, which is
    smooth, and energies at points where the force is small: 6 times closer at the same
    steps (4e-6 against 2.6e-5 of the final value, eps = 1e-2, gamma = 1).
    """
    return jnp.asarray(start_energy - field.energy(t, y) - balance.work)
