"""From what lanes found to the values of each cell: states, energies, deviations."""

from .results import CellResults as CellResults
from .results import Sums as Sums
from .results import evaluate as evaluate
from .results import nothing_found as nothing_found
