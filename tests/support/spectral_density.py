"""Friction with noise a second time: Fourier in space, backward differences in time.

Shares nothing with the library: densities as trigonometric polynomials on a box that they
vanish at the ends of, wells of a sine in closed form, differentiation by full matrices.
"""

import numpy as np
from scipy.linalg import lu_factor, lu_solve

_BDF = 12 / 25, np.array([48, -36, 16, -3]) / 25  # order 4


def differentiation(count, length):
    """First and second derivatives of even samples of a periodic function."""
    waves = 2 * np.pi / length * np.fft.fftfreq(count, 1 / count)
    once = waves.copy()
    once[count // 2] = 0.0  # of the highest cosine
    return tuple(
        np.real(np.fft.ifft(factor[:, None] * np.fft.fft(np.eye(count), axis=0), axis=0))
        for factor in (1j * once, -(waves**2))
    )


def spectral_friction(
    speed, temperature, *, cells, box, steps, rounds=2, stiffness=1.0, eps=0.1, rho=0.1
):
    """Mean of k (v t - z) less drag, viscosity 1, wells `-eps rho/(2 pi) cos(2 pi z/eps)`.

    `cells` of a period; `box`: ends in periods; `steps` in time of a period.
    """
    count = int(np.rint((box[1] - box[0]) * cells))
    z = eps * (box[0] + np.arange(count) / cells)
    first, second = differentiation(count, eps * count / cells)
    wells = rho * np.sin(2 * np.pi * z / eps)
    still = first * (stiffness * z + wells) + temperature * second
    step = eps / speed / steps
    ahead, behind = _BDF
    density = np.exp(-0.5 * ((z + 0.06 / stiffness) / (0.1 * eps)) ** 2)
    history = [density / density.sum()] * 4
    for _ in range(rounds):
        forces = []
        for n in range(1, steps + 1):
            pulled = stiffness * speed * n * step
            matrix = np.eye(count) - ahead * step * (still - pulled * first)
            known = sum(b * p for b, p in zip(behind, history, strict=True))
            density = lu_solve(lu_factor(matrix, check_finite=False), known)
            history = [density / density.sum(), *history[:3]]
            forces.append(pulled - stiffness * z @ history[0])
        history = [np.concatenate([p[cells:], np.zeros(cells)]) for p in history]
    return np.mean(forces) - speed
