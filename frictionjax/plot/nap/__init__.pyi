from .nap_loops import draw_nap_loops as draw_nap_loops
from .own_nap import draw_own_nap as draw_own_nap
from .turning import draw_turning as draw_turning
