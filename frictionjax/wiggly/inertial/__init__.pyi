from .cells_with_mass import CellsWithMass as CellsWithMass
from .cells_with_mass import integrate_with_mass as integrate_with_mass
