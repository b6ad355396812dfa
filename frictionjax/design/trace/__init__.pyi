from .fit import fit_trace as fit_trace
