"""Loads `l(t)`: what pulls the far end of the support, as a force.

- `Sine`, `Triangle`, `Ramp`, `PiecewiseLinear`: the usual ones.
- `Pulled(position, rest_length)`: given by where the far end of the spring is.
- `Custom(fn)`: your own function, whose turning points are found (`UnprovedLoad` warns
  where a short pulse may have gone unseen); or derive from `AbstractLoad`.
"""

from .completeness import UnprovedLoad as UnprovedLoad
from .completeness import turning_points_of as turning_points_of
from .custom import Custom as Custom
from .load import AbstractLoad as AbstractLoad
from .load import AbstractPull as AbstractPull
from .piecewise_linear import PiecewiseLinear as PiecewiseLinear
from .pulled import Pulled as Pulled
from .ramp import Ramp as Ramp
from .sine import Sine as Sine
from .steep import steep_times as steep_times
from .triangle import Triangle as Triangle
