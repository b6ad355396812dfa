"""What the columns of a data set of `work_precision` mean: units and words."""

RUN = {
    "seconds": ("s", "median time of a warm run"),
    "seconds_low": ("s", "fastest warm run"),
    "seconds_high": ("s", "slowest warm run"),
    "runs": ("1", "warm runs timed"),
    "compile_seconds": ("s", "what the first run took longer: tracing and compilation"),
    "error": ("1", "largest error of z outside slips, in eps"),
    "slip_error": ("1", "mean error of z over a whole slip period, in eps"),
    "end_error": ("1", "error of z at the last time asked for, in eps"),
    "dissipation_error": ("1", "largest error of the dissipation over its last value"),
    "residual": ("1", "residual of the energy-dissipation balance over that of one slip"),
    "mescd": ("1", "-log10(|z - z_ref|/(eps + |z_ref|)) at the last time asked for"),
    "steps": ("1", "steps tried"),
    "rejected": ("1", "steps rejected"),
    "calls_share": ("1", "share of the seconds in calls of the field from Python"),
    "status": (None, "how the run ended"),
    "wrong": ("1", "1 where success is reported half an eps off, and more than asked"),
}
REFERENCE = {
    "reference_error": ("1", "distance of the reference from a second one, in eps"),
    "reference_slip_error": ("1", "the same over a whole slip period"),
    "reference_end_error": ("1", "the same at the last time asked for"),
    "reference_dissipation_error": ("1", "the same for the dissipation"),
    "reference_mescd": ("1", "mescd of the second one"),
    "reference_ways": (None, "methods of the two references"),
}
COORDINATES = {
    "eps": ("m", "period of the surface, length scale eps"),
    "gamma": ("1", "exponent of the viscosity eps^gamma"),
    "solver": (None, "method"),
    "accuracy": ("1", "accuracy asked for: error of z in eps; atol of SciPy's"),
}
