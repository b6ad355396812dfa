"""Effects: what a scene may call for beyond the plain system, one a file.

- `LeadingOrder`: without what is of higher order in eps.
- `Inertia(mass)`: slips that run on; `Noise(temperature)`: thermal noise.
- `RigidArray(offsets)`, `CompliantArray(offsets)`: many bristles on one root.
- `AxialLoad(bending_stiffness)`: how near a rod is to buckling; `NapFlip`: it turns over.
- Your own: derive from `AbstractEffect`.
"""

from .abstract import AbstractEffect as AbstractEffect
from .abstract import Stage as Stage
from .axial_load import AxialLoad as AxialLoad
from .compliant_array import CompliantArray as CompliantArray
from .engines import Engine as Engine
from .engines import does as does
from .engines import engine_of as engine_of
from .engines import require_bristle as require_bristle
from .engines import require_done as require_done
from .engines import require_together as require_together
from .inertia import Inertia as Inertia
from .inertia import inertia_among as inertia_among
from .leading_order import LeadingOrder as LeadingOrder
from .nap_flip import NapFlip as NapFlip
from .nap_flip import nap_flip_among as nap_flip_among
from .noise import Noise as Noise
from .noise import noise_among as noise_among
from .rigid_array import RigidArray as RigidArray
