"""Measured surfaces: files of instruments, their periodic profile, their friction."""

from .files import Measured as Measured
from .files import MeasuredWarning as MeasuredWarning
from .files import heights_of as heights_of
from .files import read_heights as read_heights
from .fit import RowCoefficients as RowCoefficients
from .fit import fit_profile as fit_profile
from .fit import row_coefficients as row_coefficients
