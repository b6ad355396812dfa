"""Figures of the paper: coefficients against the angle of the bristle."""

from collections.abc import Callable
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from matplotlib.figure import Figure

from ..bristles import AbstractBristle, AngularSpring, SlantedSpring
from ..coefficients import Coefficients
from ..model import friction
from ..profiles import Sine
from .style import GUIDE, colour, new_figure, styled

_OMEGA = 0.1  # the paper's omega_plus = -omega_minus
_STEEPEST = float(np.arctan(1 / _OMEGA))  # arccot 0.1
_FLATTEST = float(np.arctan(_OMEGA))
_HEIGHT, _NAP = 1.0, 0.3  # m, rad


def _over(angles: np.ndarray, bristle_of: Callable[[Any], AbstractBristle]) -> Coefficients:
    """Coefficients of the sine at each angle, shape (n,) each."""
    return _coefficients(jax.vmap(bristle_of)(jnp.asarray(angles)))


@jax.jit
@jax.vmap
def _coefficients(bristle: AbstractBristle) -> Coefficients:
    return friction(Sine(jnp.asarray(_OMEGA)), bristle)


def _inside(low: float, high: float) -> np.ndarray:
    """Angles of an open interval, closer together towards its ends."""
    shares = 0.5 - 0.5 * np.cos(np.linspace(0, np.pi, 402)[1:-1])
    return low + (high - low) * shares


def slanted(angle: Any) -> SlantedSpring:
    """The second model at this angle (rad), pressed so that alpha = 1 N."""
    stiffness, height = jnp.ones(()), jnp.asarray(_HEIGHT)
    return SlantedSpring(stiffness, height / jnp.cos(angle) + jnp.cos(angle), height, angle)


def angular(limit: Any, rest: float) -> AngularSpring:
    """The third model at theta_lim = `limit` (rad) over a root of fixed height."""
    stiffness, height = jnp.ones(()), jnp.asarray(_HEIGHT)
    return AngularSpring(stiffness, height / jnp.cos(limit), height, jnp.asarray(rest))


@styled
def draw_mu_slanted() -> Figure:
    """`mu_plus` and `mu_minus` against theta in the second model, omega = 0.1.

    >>> [text.get_text() for text in fx.plot.draw_mu_slanted().axes[0].texts]
    ['only up to arccot 0.1']
    """
    angles = _inside(0.0, _STEEPEST)
    found = _over(angles, slanted)
    figure, axes = _mu(angles, found, "Slanted spring", "bristle angle $\\theta$ (rad)")
    axes.set_ylim(-0.15, 0.5)
    _edge(axes, _STEEPEST, "only up to arccot 0.1", "right")
    return figure


@styled
def draw_mu_angular() -> Figure:
    """`mu_plus` and `mu_minus` against theta_lim in the third model, omega = 0.1.

    >>> [text.get_text() for text in fx.plot.draw_mu_angular().axes[0].texts]
    ['only from arctan 0.1', 'only up to arccot 0.1']
    """
    angles = _inside(_FLATTEST, _STEEPEST)
    found = _over(angles, lambda limit: angular(limit, 0.0))
    label = "limit angle $\\theta^{lim}$ (rad)"
    figure, axes = _mu(angles, found, "Angular spring", label)
    axes.set_ylim(-0.5, 0.15)
    _edge(axes, _FLATTEST, "only from arctan 0.1", "left")
    _edge(axes, _STEEPEST, "only up to arccot 0.1", "right")
    return figure


@styled
def draw_nap() -> Figure:
    r"""`rho_with`, `rho_against` the nap against theta_lim: the rest angle changes sign.

    >>> fx.plot.draw_nap().axes[0].get_legend_handles_labels()[1]
    ['against the nap, $\\theta^{rest}$ = -0.3 rad', 'with the nap, $\\theta^{rest}$ = ...
    """
    angles = _inside(_NAP, _STEEPEST)
    figure, grid = new_figure(1, 1, 6.4, 4.4)
    axes = grid[0, 0]
    for index, (name, rest) in enumerate((("against", -_NAP), ("with", _NAP))):
        rho = _over(angles, lambda limit, rest=rest: angular(limit, rest)).rho_plus
        label = f"{name} the nap, $\\theta^{{rest}}$ = {rest:.1f} rad"
        axes.plot(angles, rho, color=colour(1 - index), label=label)
    axes.set(xlabel="limit angle $\\theta^{lim}$ (rad)", ylabel="friction $\\rho_+$ (N)")
    axes.set_title("With and against the nap: k = 1 N m/rad, h = 1 m, $\\omega$ = 0.1")
    axes.set(xlim=(0, 0.5 * np.pi), ylim=(0, None))
    axes.legend(loc="upper right", bbox_to_anchor=(0.93, 1.0))
    _edge(axes, _NAP, "only above $\\theta^{rest}$ = 0.3 rad", "left")
    _edge(axes, _STEEPEST, "only up to arccot 0.1", "right")
    return figure


def _mu(angles, found: Coefficients, title: str, label: str) -> tuple[Figure, Any]:
    figure, grid = new_figure(1, 1, 6.4, 4.4)
    axes = grid[0, 0]
    axes.plot(angles, found.mu_plus, color=colour(0), label="$\\mu_+$")
    axes.plot(angles, found.mu_minus, color=colour(1), label="$\\mu_-$")
    for rho, normal, name in (
        (found.rho_plus, found.normal_plus, "friction/normal force of the slide"),
        (found.rho_minus, found.normal_minus, None),
    ):
        axes.plot(angles, rho / normal, "--", color=GUIDE, linewidth=1.1, label=name)
    axes.axhline(0, color=GUIDE, linewidth=0.8)
    axes.set(xlabel=label, ylabel="friction over $\\alpha$, $\\mu = \\rho/\\alpha$ (1)")
    axes.set(xlim=(0, 0.5 * np.pi), title=f"{title}, $\\omega_\\pm = \\pm 0.1$")
    axes.legend(loc="center")
    return figure, axes


def _edge(axes: Any, angle: float, name: str, side: str) -> None:
    """Where the admissible angles end; what lies beyond is shaded."""
    beyond = (angle, 0.5 * np.pi) if side == "right" else (0.0, angle)
    axes.axvspan(*beyond, color="#f2f2f2", zorder=0)
    axes.axvline(angle, color=GUIDE, linewidth=0.9, linestyle="--")
    axes.annotate(
        name,
        (0.5 * sum(beyond), 0.5),
        xycoords=axes.get_xaxis_transform(),
        rotation=90,
        ha="center",
        va="center",
        color="#666666",
    )
