"""The surface behind a measured friction trace, through the dynamics."""

from .fit import fit_trace as fit_trace
