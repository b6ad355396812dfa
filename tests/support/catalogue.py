"""All hard scenes by name."""

from few_wells import FEW_WELLS
from long_slides import LONG_SLIDES
from other_parts import OTHER_PARTS
from springs import entry_of

HARD = {name: entry_of(one) for name, one in FEW_WELLS.items()}
HARD |= OTHER_PARTS
HARD |= {name: entry_of(one) for name, one in LONG_SLIDES.items()}
