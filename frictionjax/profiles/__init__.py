"""Surface profiles `w`: 1-periodic, C^2, dimensionless (height and y in periods)."""

from .custom import Custom as Custom
from .fourier import Fourier as Fourier
from .polyline import Polyline as Polyline
from .profile import AbstractProfile as AbstractProfile
from .sine import Sine as Sine
from .slope_errors import SlopeErrors as SlopeErrors
from .slope_errors import SlopesUndetermined as SlopesUndetermined
from .spline import Spline as Spline
