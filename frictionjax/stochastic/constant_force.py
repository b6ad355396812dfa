"""Drift and diffusion of a tip without a spring, under a constant force."""

from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import legendre

from .._checks import no_less, require, require_numbers, require_real
from ..model import AbstractPotential
from .potential_samples import sampled_potential
from .settings import SETTINGS


class _Panels(NamedTuple):
    """Gauss-Legendre nodes of a period and what integrates up to each of them.

    `place` (panels, nodes) in periods; `weights` (nodes,) and `partial` (nodes, nodes) for
    a panel: integrals over it, and from its start to each node.
    """

    place: np.ndarray
    weights: np.ndarray
    partial: np.ndarray


def _panels(count: int) -> _Panels:
    nodes, weights = legendre.leggauss(SETTINGS.panel_nodes)
    start = np.arange(count)[:, None] / count
    values = legendre.legvander(nodes, nodes.size - 1)
    degrees = np.eye(nodes.size)
    integrals = [legendre.legval(nodes, legendre.legint(d, lbnd=-1)) for d in degrees]
    partial = np.stack(integrals, axis=1) @ np.linalg.inv(values)
    half = 0.5 / count
    return _Panels(start + half * (1 + nodes), half * weights, half * partial)


def _panels_of(force: float, period: float, temperature: float) -> _Panels:
    """As many as the exponent asks for, whose slope is `force/temperature`."""
    least = force * period / (SETTINGS.panel_rise * SETTINGS.most_panels)
    allowed = f"temperature >= {no_less(least, 4)} J for these forces and wells"
    require(temperature >= least, "temperature", temperature, allowed)
    rises = force * period / (SETTINGS.panel_rise * temperature)
    count = max(SETTINGS.least_panels, int(np.ceil(rises)))
    return _panels(1 << (count - 1).bit_length())


def _log_sum(values: np.ndarray) -> Any:
    return np.logaddexp.reduce(values, axis=None)


def _log_resistance(push: np.ndarray, rise: float, panels: _Panels) -> float:
    """Logarithm of `int_0^1 dY e^(-a(Y)) int_-inf^Y dY' e^(a(Y'))`, `a = (F z - V)/T`.

    `push`: a at the nodes, which grows by `rise` > 0 in a period. All terms are positive
    and added as logarithms, so that nothing overflows and no digit is lost to barriers.
    """
    top = push.max(axis=1, keepdims=True)
    scaled = np.exp(push - top)
    inside = top[:, 0] + np.log(scaled @ panels.weights)
    # Integrals up to a period's start repeat in periods before, less by exp(-rise) each.
    before = _log_sum(inside) - rise - np.log(-np.expm1(-rise))
    starts = np.logaddexp.accumulate(np.append(before, inside[:-1]))
    here = top + np.log(scaled @ panels.partial.T)
    inner = np.logaddexp(starts[:, None], here)
    return _log_sum(inner - push + np.log(panels.weights))


def mean_speed(
    potential: AbstractPotential,
    forces: Any,
    *,
    eps: float,
    viscosity: float,
    temperature: float,
) -> np.ndarray:
    """Mean speed in m/s of a tip under constant forces (N), of the shape of `forces`.

    `viscosity dz = (F - V_eps'(z)) dt + sqrt(2 viscosity T) dB`; `viscosity` in N s/m,
    `temperature` T in J, eps in m. The two integrals of the closed form by Gauss-Legendre
    on panels, to 1e-10.

    Raises `ValueError` for numbers out of range, and for temperatures so low that the
    integrals would take more than 2^15 panels: deterministic to every digit by then.

    Source: R. L. Stratonovich, Radiotekhnika i Elektronika 3, 497 (1958); V. Ambegaokar
    and B. I. Halperin, Phys. Rev. Lett. 22, 1364 (1969).
    """
    _require_bath(eps, viscosity, temperature)
    require_numbers("forces", forces, "finite numbers in N", lambda v: np.isfinite(v))
    asked = np.asarray(forces, dtype=float)
    steepest = _steepest(potential, eps) + float(np.max(np.abs(asked)))
    panels = _panels_of(steepest, eps, temperature)
    energy, _ = sampled_potential(potential, eps, panels.place)
    mirrored, _ = sampled_potential(potential, eps, 1 - panels.place)

    def speed(force: float) -> float:
        rise = abs(force) * eps / temperature
        if rise == 0:
            return 0.0
        well = energy if force > 0 else mirrored
        push = rise * panels.place - well / temperature
        log_time = np.log(viscosity * eps / temperature) + _log_resistance(
            push, rise, panels
        )
        return float(np.sign(force) * np.exp(-log_time))

    return np.reshape([speed(float(f)) for f in asked.ravel()], asked.shape)


def diffusion_ratio(
    potential: AbstractPotential, *, eps: float, temperature: float
) -> float:
    """Effective over free diffusivity of a tip without a force and without a spring.

    `1/(<exp(V/T)> <exp(-V/T)>)`, means over a period of z; `1/I_0(U/T)^2` for a sine of
    amplitude U. Raises `ValueError` as `mean_speed` does.

    Source: S. Lifson and J. L. Jackson, J. Chem. Phys. 36, 2410 (1962).
    """
    _require_bath(eps, 1.0, temperature)
    panels = _panels_of(_steepest(potential, eps), eps, temperature)
    energy, _ = sampled_potential(potential, eps, panels.place)
    log_weights = np.log(panels.weights)
    up, down = (_log_sum(s * energy / temperature + log_weights) for s in (1, -1))
    return float(np.exp(-up - down))


def _steepest(potential: AbstractPotential, eps: float) -> float:
    """Largest |V_eps'| in N."""
    _, force = sampled_potential(potential, eps, np.arange(1024) / 1024)
    return float(np.max(np.abs(force)))


def _require_bath(eps: float, viscosity: float, temperature: float) -> None:
    require_real("eps", eps, "eps > 0 in m", lambda v: v > 0)
    require_real("viscosity", viscosity, "viscosity > 0 in N s/m", lambda v: v > 0)
    require_real("temperature", temperature, "temperature > 0 in J", lambda v: v > 0)
