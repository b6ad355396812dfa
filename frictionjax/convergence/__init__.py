"""Orders of convergence: measured by regression, predicted by the laws of a slide."""

from .law_orders import ENERGY as ENERGY
from .law_orders import STATE as STATE
from .law_orders import LawFit as LawFit
from .law_orders import Trust as Trust
from .law_orders import fit_with_law as fit_with_law
from .order import Fit as Fit
from .order import Verdict as Verdict
from .order import local_orders as local_orders
