from .augmented_solver import AbstractObserver as AbstractObserver
from .integration import field_of as field_of
from .integration import integrate as integrate
from .own_methods import MAX_STEPS as MAX_STEPS
from .own_methods import OURS as OURS
from .own_methods import is_ours as is_ours
from .rosenbrock_solvers import Rodas4P2 as Rodas4P2
from .solvers_by_name import solver_of as solver_of
