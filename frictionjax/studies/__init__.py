"""A convergence study: what a sweep says about eps -> 0."""

from .convergence_study import Study as Study
from .convergence_study import study as study
