"""Gauss nodes of panels, and what leads from values there to Legendre series."""

import numpy as np

GAUSS_POINTS = 10  # Gauss nodes of a panel
GAUSS_NODES, GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(GAUSS_POINTS)
TO_LEGENDRE = np.linalg.inv(np.polynomial.legendre.legvander(GAUSS_NODES, GAUSS_POINTS - 1))

# From Legendre polynomials to their integrals from -1, one degree higher.
PRIMITIVE = np.polynomial.legendre.legint(np.eye(GAUSS_POINTS), lbnd=-1, axis=1).T
