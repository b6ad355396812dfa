from .bristle_on_surface import draw_parts as draw_parts
from .friction_law import draw_friction_law as draw_friction_law
from .load_and_well import draw_forces as draw_forces
from .well import draw_coefficients as draw_coefficients
