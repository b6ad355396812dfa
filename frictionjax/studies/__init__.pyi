from .convergence_study import Study as Study
from .convergence_study import study as study
