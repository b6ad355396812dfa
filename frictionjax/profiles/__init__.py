"""Surface profiles `w`: 1-periodic, C^2, dimensionless (height and y in periods)."""

from .custom import Custom as Custom
from .fourier import Fourier as Fourier
from .polyline import Polyline as Polyline
from .profile import AbstractProfile as AbstractProfile
from .sine import Sine as Sine
from .spline import Spline as Spline
