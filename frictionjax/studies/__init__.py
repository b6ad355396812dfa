"""A convergence study: what a sweep says about eps -> 0."""

from .convergence_study import study as study
from .study_result import Study as Study
from .study_tables import failed_table as failed_table
from .study_tables import failures as failures
from .study_tables import flag_names as flag_names
from .study_tables import formatted as formatted
from .study_tables import lemma_table as lemma_table
from .study_tables import order_table as order_table
from .study_tables import spread_table as spread_table
from .study_tables import sweep_table as sweep_table
