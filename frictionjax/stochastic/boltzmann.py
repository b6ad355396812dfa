"""Boltzmann's density of a tip at rest: what a bath leaves under a constant load."""

from typing import NamedTuple

import jax
import numpy as np
from jaxtyping import Array, Float
from numpy.polynomial import legendre

from .._checks import Real, require
from .._compile import Interpreted, in_chunks
from ..model import AbstractPotential
from ..supports import AbstractSupport
from .potential_samples import sampled_potential
from .settings import SETTINGS


class AtRest(NamedTuple):
    """What stands still in a bath: `load` in N, `eps` in m, `temperature` (T_eps) in J."""

    potential: AbstractPotential
    support: AbstractSupport
    load: float
    eps: float
    temperature: float


class BoltzmannShares(NamedTuple):
    """`shares` (bins,) of the whole in each bin, and the energy in J whose weight is 1/m:
    the density at z is `exp((level - U(z))/T)`."""

    shares: Float[np.ndarray, " bins"]
    level: float


def energies_at_rest(rest: AtRest, z: Float[np.ndarray, "*z"]) -> Float[np.ndarray, "*z"]:
    """`U = Phi(z) - l z + V_eps(z)` in J."""
    wells, _ = sampled_potential(rest.potential, rest.eps, z / rest.eps)
    return _held(rest, z) + wells


def boltzmann_shares(rest: AtRest, edges: Float[np.ndarray, " edges"]) -> BoltzmannShares:
    """Of `exp(-U/T)/Z` between each two of the rising `edges` (m), to 1e-10 of the whole.

    Gauss-Legendre on panels that are short against the standard deviation of a well's
    density and against a well, over all of z where the weight is above `SETTINGS.tail`.

    Raises `ValueError` naming eps where that takes more than `SETTINGS.most_nodes_at_rest`.
    """
    low, high = _reach(rest)
    inside = np.clip(edges, low, high)
    places, weights, bins = _nodes(np.concatenate([[low], inside, [high]]), _panel(rest))
    energy = energies_at_rest(rest, places)
    lowest = float(np.min(energy))
    mass = weights * np.exp((lowest - energy) / rest.temperature)
    per_bin = np.bincount(bins, mass, minlength=edges.size + 1)
    whole = float(np.sum(per_bin))
    level = lowest - rest.temperature * np.log(whole)
    return BoltzmannShares(per_bin[1:-1] / whole, level)


@Interpreted
def _held_energy(
    support: AbstractSupport, load: Real, z: Float[Array, " n"]
) -> Float[Array, " n"]:
    return jax.vmap(support.energy)(z) - load * z


@Interpreted
def _centre(support: AbstractSupport, load: Real) -> tuple[Real, Real]:
    """Where the support alone would rest, and how stiff it is there."""
    z = support.state_of(load)
    return z, support.stiffness_at(z)


def _held(rest: AtRest, z: np.ndarray) -> np.ndarray:
    """`Phi(z) - l z` in J."""
    fixed = rest.support, np.asarray(rest.load, dtype=float)
    return np.reshape(
        in_chunks(_held_energy, SETTINGS.sampled, fixed, (np.ravel(z),)), np.shape(z)
    )


def _reach(rest: AtRest) -> tuple[float, float]:
    """Beyond which Boltzmann's weight is below the tail's, whatever the wells do."""
    centre, stiffness = map(float, _centre(rest.support, np.asarray(float(rest.load))))
    wells, _ = sampled_potential(rest.potential, rest.eps, np.arange(1024) / 1024)
    drop = 1.1 * float(np.ptp(wells)) - rest.temperature * np.log(SETTINGS.tail_at_rest)
    near = np.sqrt(2 * drop / stiffness)  # of a spring, exactly
    away = near * 2.0 ** (np.arange(-40, 80) / 4)
    floor = float(_held(rest, np.array([centre]))[0])
    ends = []
    for side in (-1, 1):
        risen = np.flatnonzero(_held(rest, centre + side * away) - floor >= drop)
        needs = "a support that holds the tip at this temperature"
        require(risen.size > 0, "temperature", rest.temperature, needs)
        ends.append(centre + side * float(away[risen[0]]))
    return ends[0], ends[1]


def _panel(rest: AtRest) -> float:
    """Longest panel in m: half a standard deviation of the narrowest well."""
    count = max(1024, rest.potential.points)
    _, force = sampled_potential(rest.potential, rest.eps, np.arange(count) / count)
    _, stiffness = map(float, _centre(rest.support, np.asarray(float(rest.load))))
    steepest = count / rest.eps * float(np.max(np.abs(np.diff(force))))
    deviation = np.sqrt(rest.temperature / (steepest + stiffness))
    return min(0.5 * deviation, rest.eps / SETTINGS.panels_a_well)


def _nodes(
    edges: Float[np.ndarray, " edges"], longest: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Places and weights of panels between edges, and which interval each is in."""
    widths = np.diff(edges)
    counts = np.ceil(widths / longest)
    total = float(np.sum(counts)) * SETTINGS.panel_nodes
    few = total <= SETTINGS.most_nodes_at_rest
    needs = f"wells of a density with at most {SETTINGS.most_nodes_at_rest} places"
    require(few, "eps", f"one that takes {total:.3g}", needs)
    counts = counts.astype(int)
    of_panel = np.repeat(np.arange(widths.size), counts)
    first = np.cumsum(counts) - counts
    length = (widths / np.maximum(counts, 1))[of_panel]
    start = edges[of_panel] + length * (np.arange(of_panel.size) - first[of_panel])
    nodes, weights = legendre.leggauss(SETTINGS.panel_nodes)
    places = start[:, None] + length[:, None] * 0.5 * (1 + nodes)
    shares = length[:, None] * 0.5 * weights
    return places.ravel(), shares.ravel(), np.repeat(of_panel, nodes.size)
