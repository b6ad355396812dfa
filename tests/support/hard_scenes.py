"""Random scenes from numbers in [0, 1], and what the mathematics guarantees about them.

A scene is drawn from a list of such numbers, so that a generator can try thousands and
hypothesis can shrink one. Everything random spans orders of magnitude.
"""

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np

import frictionjax as fx

BRISTLES = ("homothetic", "vertical", "slanted", "angular")
SUPPORTS = ("spring", "stiffening")
LOADS = ("sine", "triangle", "piecewise")
KINDS = [(b, s, load) for b in BRISTLES for s in SUPPORTS for load in LOADS]
GENES = 24
DURATION, TIMES = 2.0, np.linspace(0.0, 2.0, 41)
_HARMONICS, _KINKS = 3, 4


class Stiffening(eqx.Module):
    """`k (z^2/2 + s log cosh(z/s))`: twice as stiff at rest as far away."""

    stiffness: jax.Array
    size: jax.Array

    def __call__(self, z):
        u = jnp.abs(z / self.size)
        log_cosh = u + jnp.log1p(jnp.exp(-2 * u)) - math.log(2.0)
        return self.stiffness * (z**2 / 2 + self.size**2 * log_cosh)


class Case(NamedTuple):
    """A scene at one eps and gamma, and how its symmetric ones are made."""

    kind: tuple[str, str, str]
    numbers: dict[str, Any]
    eps: float
    gamma: float

    @property
    def scene(self) -> fx.Scene:
        return build(self.kind, self.numbers)

    def change(self, **numbers: Any) -> "Case":
        """The same with other numbers."""
        return self._replace(numbers=self.numbers | numbers)


def _log(gene: float, low: float, high: float) -> float:
    return float(low * (high / low) ** gene)


def _surface(genes: Sequence[float]) -> tuple[np.ndarray, np.ndarray]:
    """Coefficients of a profile whose steepest slope is 0.01 to 0.5."""
    orders = np.arange(1, _HARMONICS + 1)
    cos, sin = (2 * np.asarray(genes[:6]).reshape(2, 3) - 1) / orders**1.5
    sin[0] += 0.3  # never flat
    y = np.arange(256) / 256
    angle = 2 * np.pi * orders[:, None] * y
    slope = (2 * np.pi * orders[:, None]) * (
        sin[:, None] * np.cos(angle) - cos[:, None] * np.sin(angle)
    )
    scale = _log(genes[6], 0.01, 0.5) / np.abs(slope.sum(axis=0)).max()
    return cos * scale, sin * scale


def _bristle(kind: str, genes: Sequence[float], steep: float) -> dict[str, float]:
    """Numbers of a bristle that the surface admits, by a margin of 1e-3 to 1."""
    stiffness = _log(genes[0], 0.1, 10.0)
    margin = _log(genes[1], 1e-3, 1.0)
    sign = 1.0 if genes[2] < 0.5 else -1.0
    pull = _log(abs(2 * genes[2] - 1), 0.05, 1.0)
    if kind == "homothetic":
        return {"alpha": sign * pull * stiffness}
    if kind == "vertical":
        return {"stiffness": stiffness, "rest_length": 1 + sign * pull, "height": 1.0}
    if kind == "slanted":
        lean = min((1 - margin) / steep, 3.0)
        angle = math.atan(lean) * (1.0 if genes[3] < 0.5 else -1.0)
        rest = (1 + 0.9 * sign * pull) / math.cos(angle)
        numbers = {"stiffness": stiffness, "rest_length": rest, "height": 1.0}
        return {**numbers, "angle": angle}
    # cot(theta) < 1/steep and tan(theta) > steep.
    flat, upright = math.atan(steep), math.atan(1 / steep)
    theta = flat + (upright - flat) * (0.02 + 0.96 * genes[3])
    rest_angle = theta * (1 - pull)  # the theory wants theta_rest < theta_lim
    return {
        "stiffness": stiffness,
        "length": 1 / math.cos(theta),
        "height": 1.0,
        "rest_angle": rest_angle,
    }


def draw(kind: tuple[str, str, str], genes: Sequence[float]) -> Case:
    """The case of these numbers; raises `ValueError` where it is not admissible."""
    bristle, _, load = kind
    cos, sin = _surface(genes)
    profile = fx.profiles.Fourier(cos, sin)
    height = fx.friction(profile, fx.bristles.Homothetic(1.0))
    steep = max(float(height.omega_plus), -float(height.omega_minus)) * 1.0001
    numbers: dict[str, Any] = {"cos": cos, "sin": sin}
    numbers["bristle"] = _bristle(bristle, genes[7:11], steep)
    law = fx.friction(profile, _bristle_of(bristle, numbers["bristle"]))
    width = float(law.rho_plus - law.rho_minus)
    force, wells = width * _log(genes[12], 0.6, 20.0), _log(genes[22], 3.0, 300.0)
    gamma = 0.5 + 2.0 * genes[21]
    # By how long the tip takes to follow: of supports of 1e-3 to 1e3 N/m every fifth held
    # it where it was for all of the time.
    follow = DURATION * _log(genes[11], 1e-8, 1.0)
    stiffness = ((force / wells) ** gamma / follow) ** (1 / (1 + gamma))
    way = force / stiffness
    numbers["support"] = {"stiffness": stiffness, "size": way * _log(genes[13], 0.1, 10.0)}
    numbers["load"] = _load(load, genes[14:20], force)
    inside = float(law.rho_minus) + genes[20] * width
    start = _start(load, numbers["load"]) - inside
    numbers["z0"] = start / (stiffness * (1.0 if kind[1] == "spring" else 2.0))
    return Case(kind, numbers, way / wells, gamma)


def _load(kind: str, genes: Sequence[float], force: float) -> dict[str, Any]:
    if kind != "piecewise":
        return {"amplitude": force, "period": DURATION * _log(genes[0], 0.5, 2.0)}
    gaps = 0.02 + np.asarray(genes[:_KINKS])
    times = np.concatenate([[0.0], np.cumsum(gaps)]) * DURATION / gaps.sum()
    values = force * (2 * np.asarray(genes[1 : _KINKS + 2]) - 1)
    return {"times": times, "values": values}


def _start(kind: str, numbers: dict[str, Any]) -> float:
    return float(numbers["values"][0]) if kind == "piecewise" else 0.0


_BRISTLE = {
    "homothetic": fx.bristles.Homothetic,
    "vertical": fx.bristles.VerticalSpring,
    "slanted": fx.bristles.SlantedSpring,
    "angular": fx.bristles.AngularSpring,
}
_LOAD = {
    "sine": fx.loads.Sine,
    "triangle": fx.loads.Triangle,
    "piecewise": fx.loads.PiecewiseLinear,
}


def _bristle_of(kind: str, numbers: dict[str, float]):
    return _BRISTLE[kind](**numbers)


def build(kind: tuple[str, str, str], numbers: dict[str, Any]) -> fx.Scene:
    """The scene of these numbers."""
    bristle, support, load = kind
    spring = numbers["support"]
    held = fx.supports.Spring(spring["stiffness"])
    if support == "stiffening":
        size = jnp.asarray(spring["size"]), jnp.asarray(spring["stiffness"])
        held = fx.supports.Convex(Stiffening(stiffness=size[1], size=size[0]))
    return fx.Scene(
        fx.profiles.Fourier(numbers["cos"], numbers["sin"]),
        _bristle_of(bristle, numbers["bristle"]),
        held,
        _LOAD[load](**numbers["load"]),
        numbers.get("duration", DURATION),
        numbers["z0"],
    )


def scaled(case: Case, length: float, force: float) -> tuple[Case, float]:
    """The case in other units, and the unit of time that belongs to them.

    `eps^gamma z' = F` keeps its form where time is counted in
    `length^(1 + gamma)/force`.
    """
    old, time = case.numbers, length ** (1 + case.gamma) / force
    units = {
        "alpha": force,
        "stiffness": force / length,
        "rest_length": length,
        "length": length,
        "height": length,
    }
    if case.kind[0] == "angular":
        units["stiffness"] = force * length
    numbers = {
        "bristle": {k: v * units.get(k, 1.0) for k, v in old["bristle"].items()},
        "support": {
            "stiffness": old["support"]["stiffness"] * force / length,
            "size": old["support"]["size"] * length,
        },
        "z0": old["z0"] * length,
        "duration": DURATION * time,
    }
    per = {"amplitude": force, "values": force, "period": time, "times": time}
    numbers["load"] = {k: np.asarray(v) * per[k] for k, v in old["load"].items()}
    return case.change(**numbers)._replace(eps=case.eps * length), time


def reflected(case: Case) -> Case:
    """The case seen in a mirror: z -> -z."""
    old = case.numbers
    sign = {"amplitude": -1.0, "values": -1.0}
    bristle = dict(old["bristle"])
    if "angle" in bristle:
        bristle["angle"] = -bristle["angle"]
    return case.change(
        sin=-old["sin"],
        bristle=bristle,
        load={k: np.asarray(v) * sign.get(k, 1.0) for k, v in old["load"].items()},
        z0=-old["z0"],
    )
