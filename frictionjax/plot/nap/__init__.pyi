from .nap_loops import draw_nap_loops as draw_nap_loops
from .own_nap import draw_own_nap as draw_own_nap
from .strokes import draw_strokes as draw_strokes
from .turning import draw_turning as draw_turning
