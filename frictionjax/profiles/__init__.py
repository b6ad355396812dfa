"""Surface profiles `w`: 1-periodic, C^2, dimensionless (height and y in periods).

- `Sine(slope)`, `Fourier(cos, sin)`: waves; `Polyline`: straight flanks with round corners.
- `Spline(heights)`, `Fourier.from_heights(x, heights)`: surfaces known by samples, which
  say how well these determine the steepest slopes (`SlopeErrors`, `SlopesUndetermined`).
- `Custom(fn)`: your own function; or derive from `AbstractProfile`.
"""

from .custom import Custom as Custom
from .fourier import Fourier as Fourier
from .fourier import fit_series as fit_series
from .heights import HeightsFit as HeightsFit
from .heights import SeriesFit as SeriesFit
from .heights import find_period as find_period
from .polyline import Polyline as Polyline
from .profile import AbstractProfile as AbstractProfile
from .profile import require_smooth as require_smooth
from .rows import complex_series as complex_series
from .rows import fit_rows_in_phase as fit_rows_in_phase
from .rows import mean_in_phase as mean_in_phase
from .sine import Sine as Sine
from .slope_errors import AbstractSampled as AbstractSampled
from .slope_errors import SlopeErrors as SlopeErrors
from .slope_errors import SlopesUndetermined as SlopesUndetermined
from .slope_errors import warn_of as warn_of
from .spline import Spline as Spline
