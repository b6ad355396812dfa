"""The scenes of calibration.py in closed form by Taylor series, through every slip.

By heyoka, and nothing of the library. In the tip coordinate y, with `s` for the dissipation
over eps; the lanes of a batch are gammas. On the angular spring at eps = 1e-3, gamma 0.1 to
0.5, results of tolerances 1e-15 and 1e-12 are 5e-9 eps apart. Explicit steps a slip grow
like eps^-gamma, so this is for gamma up to about 1/2 where eps is small. Harmonics by the
addition theorem took 1.2 to 1.8 times as long as sines and cosines of each.
"""

import math
from functools import cache
from types import SimpleNamespace

import numpy as np
from scipy.optimize import brentq

TWO_PI = 2 * math.pi
DURATION, AMPLITUDE = 3.0, 1.0488
_QUARTER = DURATION / 4
_RATE = AMPLITUDE / _QUARTER

_FOUR = ((0.004, -0.002, 0.0, 0.0005), (0.008, 0.003, -0.001, 0.0))  # cos, sin
_SINE = ((0.0,), (0.1 / TWO_PI,))


def _homothetic(m, eta):
    return 0.0, 0.0, 1.0


def _vertical(m, eta):
    return 0.0, 0.0, 1.0 + eta


def _slanted(m, eta, rest=2.4, height=1.0, angle=0.6):
    ahead, cosine = math.tan(angle), math.cos(angle)
    return -eta * ahead, -ahead, (rest - (height - eta) / cosine) / cosine


def _angular(m, eta, length=1.5, height=1.0, rest=0.2):
    above = height - eta
    reach = m.sqrt(length**2 - above * above)
    flat = math.sqrt(length**2 - height**2)
    offset = eta * (2 * height - eta) / (reach + flat)
    return offset, above / reach, (m.acos(above * (1 / length)) - rest) / reach


# Surface, and (A, A', F') of the height by the functions of a module, in SI units.
_PARTS = {
    "homothetic": (_FOUR, _homothetic),
    "vertical": (_SINE, _vertical),
    "slanted": (_FOUR, _slanted),
    "angular": (_FOUR, _angular),
}
# Begin and end in s, and the load as `l0 + l1 t + amplitude sin(2 pi t/3)`.
_LOADS = {
    "sine": [(0.0, DURATION, 0.0, 0.0, AMPLITUDE)],
    "triangle": [
        (0.0, _QUARTER, 0.0, _RATE, 0.0),
        (_QUARTER, 3 * _QUARTER, 2 * AMPLITUDE, -_RATE, 0.0),
        (3 * _QUARTER, DURATION, -4 * AMPLITUDE, _RATE, 0.0),
    ],
}


def _surface(m, name: str, y):
    """w and w' at the phase y."""
    height = slope = 0.0
    for n, (c, s) in enumerate(zip(*_PARTS[name][0], strict=True), start=1):
        cosine, sine = m.cos(TWO_PI * n * y), m.sin(TWO_PI * n * y)
        height = height + c * cosine + s * sine
        slope = slope + TWO_PI * n * (s * cosine - c * sine)
    return height, slope


def _state(name: str, eps: float, y):
    m = SimpleNamespace(cos=np.cos, sin=np.sin, sqrt=np.sqrt, acos=np.arccos)
    return eps * y + _PARTS[name][1](m, eps * _surface(m, name, y)[0])[0]


@cache
def _lanes(name: str, tolerance: float):
    import heyoka as hy

    y, s = hy.make_vars("y", "s")
    eps, viscosity, constant, rate, amplitude = (hy.par[i] for i in range(5))
    height, slope = _surface(hy, name, y)
    offset, ahead, climb = _PARTS[name][1](hy, eps * height)
    stretch = 1.0 + ahead * slope
    load = constant + rate * hy.time + amplitude * hy.sin(TWO_PI / DURATION * hy.time)
    drive = load - eps * y - offset - climb * slope / stretch
    drag = viscosity * eps
    rates = [(y, drive / (drag * stretch)), (s, drive * drive / drag)]
    width = hy.recommended_simd_size()
    start, numbers = np.zeros((2, width)), np.ones((5, width))
    return hy.taylor_adaptive_batch(rates, start, pars=numbers, tol=tolerance)


def _few(name: str, load: str, eps: float, gamma: np.ndarray, ts, tolerance: float):
    """As `solved`, for no more gammas than a batch has lanes; equal times once."""
    lanes = _lanes(name, tolerance)
    lanes.set_time(0.0)
    lanes.state[0] = brentq(lambda y: _state(name, eps, y) / eps, -1.0, 1.0, xtol=1e-15)
    lanes.state[1] = 0.0
    lanes.pars[0], lanes.pars[1] = eps, eps ** np.resize(gamma, lanes.batch_size)
    found = np.empty((ts.size, 2, lanes.batch_size))
    for begin, end, *numbers in _LOADS[load]:
        lanes.pars[2:] = np.array(numbers)[:, None]
        mine = (ts >= begin) & (ts <= end)
        grid = np.unique(np.concatenate([[begin], ts[mine], [end]]))
        columns = np.repeat(grid[:, None], lanes.batch_size, axis=1)
        _, values = lanes.propagate_grid(columns)
        found[mine] = values[np.searchsorted(grid, ts[mine])]
        lanes.state[:] = values[-1]
        lanes.set_time(end)
    y, spent = np.moveaxis(found[..., : gamma.size], 0, 2)
    return _state(name, eps, y), eps * spent


def solved(name: str, load: str, eps: float, gamma: np.ndarray, ts, tolerance: float):
    """z in m and dissipation in J over (gamma, ts), by z = 0 at t = 0."""
    width = _lanes(name, tolerance).batch_size
    parts = [
        _few(name, load, eps, gamma[i : i + width], ts, tolerance)
        for i in range(0, gamma.size, width)
    ]
    z, spent = zip(*parts, strict=True)
    return np.concatenate(z), np.concatenate(spent)
