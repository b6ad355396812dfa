from .buckling import hinged_load as hinged_load
from .buckling import sprung_load as sprung_load
from .elastica import Elastica as Elastica
from .elastica import bent_between_hinges as bent_between_hinges
from .elastica_shape import bent_shape as bent_shape
from .elliptic import EllipticIntegrals as EllipticIntegrals
from .elliptic import complete_elliptic as complete_elliptic
from .turning_energy import TurningRod as TurningRod
