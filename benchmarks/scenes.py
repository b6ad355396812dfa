"""The two scenes of the benchmarks, and their fields in the words of each peer.

In the tip coordinate, `y' = (l - k_h (eps y + A) - F' w'(y)/G)/(eps^(gamma+1) G)` with A
and F at the height `eta = eps w(y)` and `G = 1 + A' w'`; k_h = 1. Numbers only: nothing
here imports JAX unless a scene of the library is asked for.
"""

import math
from functools import cache
from types import SimpleNamespace

import numpy as np

PERIOD, AMPLITUDE = 3.0, 1.0488
TWO_PI = 2 * math.pi
TIMES = np.linspace(0.0, PERIOD, 61)
FASTEST = AMPLITUDE * TWO_PI / PERIOD  # N/s, of the load

# A vertical spring with alpha = 1 on a sine: rho = +-0.1 N.
SLOPE = 0.1
EDGES = np.array(SLOPE), np.array(-SLOPE)  # N, of the strip
# A rod on an angular spring, four harmonics: rho = 0.079 N and -0.137 N, alpha = 0.57 N.
STIFFNESS, LENGTH, HEIGHT, REST = 1.0, 1.5, 1.0, 0.2
COS = (0.0, 0.00384, 0.0, 0.00192)
SIN = (0.01536, 0.0, -0.00384, 0.00096)
NAMES = ("vertical", "angular")


def scene(name: str, load=None):
    """The scene for our own solver, with the sine load where no other is given."""
    import frictionjax as fx

    profile, bristle = {
        "vertical": lambda: (
            fx.profiles.Sine(SLOPE),
            fx.bristles.VerticalSpring(1.0, 2.0, 1.0),
        ),
        "angular": lambda: (
            fx.profiles.Fourier(list(COS), list(SIN)),
            fx.bristles.AngularSpring(STIFFNESS, LENGTH, HEIGHT, REST),
        ),
    }[name]()
    load = load or fx.loads.Sine(AMPLITUDE, PERIOD)
    return fx.Scene(profile, bristle, fx.supports.Spring(1.0), load, PERIOD)


def _vertical(m, t, y, eps):
    """Drive `l - Phi' - V'` in N and `G`, from the functions of the module `m`."""
    phase = TWO_PI * y
    normal = 1.0 + eps * (SLOPE / TWO_PI) * m.sin(phase)
    load = AMPLITUDE * m.sin(TWO_PI / PERIOD * t)
    return load - eps * y - SLOPE * m.cos(phase) * normal, 1.0


def _angular(m, t, y, eps):
    phase = TWO_PI * y
    height, slope = 0.0, 0.0
    for n in (1, 2, 3, 4):
        c, s = m.cos(n * phase), m.sin(n * phase)
        height = height + COS[n - 1] * c + SIN[n - 1] * s
        slope = slope + TWO_PI * n * (SIN[n - 1] * c - COS[n - 1] * s)
    eta = eps * height
    above = HEIGHT - eta
    reach = m.sqrt(LENGTH**2 - above * above)
    flat = math.sqrt(LENGTH**2 - HEIGHT**2)
    offset = eta * (2 * HEIGHT - eta) / (reach + flat)
    climb = STIFFNESS * (m.acos(above * (1 / LENGTH)) - REST) / reach
    stretch = 1.0 + above / reach * slope
    load = AMPLITUDE * m.sin(TWO_PI / PERIOD * t)
    return load - eps * y - offset - climb * slope / stretch, stretch


_FIELDS = {"vertical": _vertical, "angular": _angular}


def state(name: str, y, eps: float):
    """`z = eps y + A(eps w(y))` in m."""
    if name == "vertical":
        return eps * y
    turns = TWO_PI * np.arange(1, 5) * np.asarray(y)[..., None]
    eta = eps * (np.cos(turns) @ np.array(COS) + np.sin(turns) @ np.array(SIN))
    reach = np.sqrt(LENGTH**2 - (HEIGHT - eta) ** 2)
    return eps * y + eta * (2 * HEIGHT - eta) / (reach + math.sqrt(LENGTH**2 - HEIGHT**2))


@cache
def start(name: str, eps: float) -> float:
    """The tip coordinate of z = 0."""
    from scipy.optimize import brentq

    return float(brentq(lambda y: state(name, y, eps) / eps, -1.0, 1.0, xtol=1e-15))


def jax_field(name: str):
    """`y'` for diffrax, `args = (eps, drag)`."""
    import jax.numpy as jnp

    m = SimpleNamespace(sin=jnp.sin, cos=jnp.cos, sqrt=jnp.sqrt, acos=jnp.arccos)

    def rate(t, y, args):
        eps, drag = args
        force, stretch = _FIELDS[name](m, t, y, eps)
        return force / (drag * stretch)

    return rate


def heyoka_field(name: str):
    """`(y, y')` as heyoka's expressions; parameters eps and 1/drag."""
    import heyoka as hy

    y = hy.make_vars("y")
    force, stretch = _FIELDS[name](hy, hy.time, y, hy.par[0])
    return y, force / stretch * hy.par[1]


@cache
def numba_field(name: str):
    """`y'` compiled: fn(t, y, eps, drag), all floats."""
    return {"vertical": _numba_vertical, "angular": _numba_angular}[name]()


def _numba_vertical():
    from numba import njit

    @njit(fastmath=False, error_model="numpy")
    def rate(t, y, eps, drag):
        phase = TWO_PI * y
        normal = 1.0 + eps * (SLOPE / TWO_PI) * math.sin(phase)
        load = AMPLITUDE * math.sin(TWO_PI / PERIOD * t)
        return (load - eps * y - SLOPE * math.cos(phase) * normal) / drag

    return rate


def _numba_angular():
    from numba import njit

    flat = math.sqrt(LENGTH**2 - HEIGHT**2)
    c1, c2, c3, c4 = COS
    s1, s2, s3, s4 = SIN

    @njit(fastmath=False, error_model="numpy")
    def rate(t, y, eps, drag):
        phase = TWO_PI * y
        c, s = math.cos(phase), math.sin(phase)
        # Higher harmonics by the addition theorem: two calls, not eight.
        cc, ss = c * c - s * s, 2 * s * c
        ccc, sss = cc * c - ss * s, ss * c + cc * s
        cccc, ssss = cc * cc - ss * ss, 2 * ss * cc
        height = c1 * c + s1 * s + c2 * cc + s2 * ss
        height += c3 * ccc + s3 * sss + c4 * cccc + s4 * ssss
        slope = s1 * c - c1 * s + 2 * (s2 * cc - c2 * ss)
        slope += 3 * (s3 * ccc - c3 * sss) + 4 * (s4 * cccc - c4 * ssss)
        slope *= TWO_PI
        eta = eps * height
        above = HEIGHT - eta
        reach = math.sqrt(LENGTH**2 - above * above)
        offset = eta * (2 * HEIGHT - eta) / (reach + flat)
        climb = STIFFNESS * (math.acos(above / LENGTH) - REST) / reach
        stretch = 1.0 + above / reach * slope
        load = AMPLITUDE * math.sin(TWO_PI / PERIOD * t)
        force = load - eps * y - offset - climb * slope / stretch
        return force / (drag * stretch)

    return rate
