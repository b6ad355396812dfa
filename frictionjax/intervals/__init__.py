"""Bounds of functions over whole intervals: what samples cannot prove."""

from . import interval as interval
from .enclosure import Enclosure as Enclosure
from .enclosure import NoRuleError as NoRuleError
from .enclosure import TooMuchWorkError as TooMuchWorkError
from .enclosure import enclosure_of as enclosure_of
from .interval import Interval as Interval
from .jet import Jet as Jet
from .program import work_of as work_of
