from .results import CellResults as CellResults
from .results import evaluate as evaluate
