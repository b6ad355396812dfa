"""The limit system: the play operator that friction is for eps -> 0 (eq. 2.3)."""

from .play import LimitSolution as LimitSolution
from .play import play_operator as play_operator
from .play import play_step as play_step
from .play import require_start_in_strip as require_start_in_strip
from .play import solve_limit as solve_limit
from .play import strip as strip
