"""Gauss quadrature on [0, 1]: exact for polynomials of degree 5."""

import numpy as np

THREE_NODES = np.array([0.5 - 0.15**0.5, 0.5, 0.5 + 0.15**0.5])
THREE_WEIGHTS = np.array([5.0, 8.0, 5.0]) / 18
