from .axial import AxialReading as AxialReading
from .axial import axial_reading as axial_reading
from .axial import largest_compression as largest_compression
from .forces import TipForces as TipForces
from .forces import limit_forces as limit_forces
from .forces import tip_forces as tip_forces
from .readings import mechanics as mechanics
