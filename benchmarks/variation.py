"""Trajectory and its derivative by one coefficient, sharing no line with the library.

The equation in the tip coordinate and its variational equation under a slanted spring,
written by hand, in compiled LSODA (numbalsoda) from kink to kink of the load.
"""

import math

import numpy as np
from numba import cfunc
from numbalsoda import lsoda, lsoda_sig

STEPS = 10**8


def slanted_variation(waves, bristle, eps, kinks, loads, ts, index, tolerance):
    """`z` and `dz/dc` at the times, gamma = 1, k_h = 1, z(0) = 0; shapes (n,).

    `waves`: cos and sin, one after the other; `index`: of the coefficient c in them.
    `bristle`: stiffness, rest length, height and angle. `loads` at the times `kinks`.
    """
    count, viscosity = waves.size // 2, eps**2
    cos, sin = waves[:count].copy(), waves[count:].copy()
    stiffness, rest, height, angle = bristle
    lean, press = math.tan(angle), stiffness / math.cos(angle)
    turn, odd = 2 * math.pi * (index % count + 1), index >= count

    @cfunc(lsoda_sig)
    def rates(t, state, rate, load):
        y, s = state[0], state[1]
        w, slope, bend = 0.0, 0.0, 0.0
        for n in range(count):
            a = 2 * math.pi * (n + 1)
            c, d = math.cos(a * y), math.sin(a * y)
            w += cos[n] * c + sin[n] * d
            slope += a * (sin[n] * c - cos[n] * d)
            bend -= a * a * (cos[n] * c + sin[n] * d)
        b, b_slope = math.cos(turn * y), -turn * math.sin(turn * y)
        if odd:
            b, b_slope = math.sin(turn * y), turn * math.cos(turn * y)
        stretch = 1 - lean * slope
        climb = press * (rest - (height - eps * w) / math.cos(angle))
        stiff = press / math.cos(angle)
        z = eps * (y - lean * w)
        force = load[1] + load[2] * (t - load[0]) - z - climb * slope / stretch
        rate[0] = force / (viscosity * stretch)
        # Of the force and of 1/G, by y and by c.
        steep = climb / stretch**2
        by_y = -eps * stretch - stiff * eps * slope**2 / stretch - steep * bend
        by_c = eps * lean * b - stiff * eps * b * slope / stretch - steep * b_slope
        pull = (by_y + force * lean * bend / stretch) * s
        pull += by_c + force * lean * b_slope / stretch
        rate[1] = pull / (viscosity * stretch)

    turns = 2 * np.pi * np.arange(1, count + 1)

    def surface(y):
        """w, w' and the wave of the coefficient."""
        angles = np.outer(np.atleast_1d(y), turns)
        w = np.cos(angles) @ cos + np.sin(angles) @ sin
        slope = np.cos(angles) @ (turns * sin) - np.sin(angles) @ (turns * cos)
        phase = turn * np.atleast_1d(y)
        return w, slope, np.sin(phase) if odd else np.cos(phase)

    y = 0.0
    for _ in range(50):  # z = eps (y - lean w(y)) = 0
        w, slope, wave = (float(v[0]) for v in surface(y))
        y -= (y - lean * w) / (1 - lean * slope)
    state = np.array([y, lean * wave / (1 - lean * slope)])
    found = np.full((ts.size, 2), np.nan)
    for i in range(len(kinks) - 1):
        begin, end = kinks[i], kinks[i + 1]
        inside = (ts >= begin) & (ts < end)
        line = np.array([begin, loads[i], (loads[i + 1] - loads[i]) / (end - begin)])
        path, good = lsoda(
            rates.address,
            state,
            np.concatenate([[begin], ts[inside], [end]]),
            line,
            rtol=tolerance,
            atol=0.01 * tolerance,
            mxstep=STEPS,
        )
        if not good:
            raise RuntimeError(f"LSODA gave up in [{begin}, {end}] s")
        found[inside], state = path[1:-1], path[-1].copy()
    w, slope, wave = surface(found[:, 0])
    by = (1 - lean * slope) * found[:, 1] - lean * wave
    return eps * (found[:, 0] - lean * w), eps * by
