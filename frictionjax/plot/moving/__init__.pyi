from .film import animate as animate
from .force_course import friction_levels as friction_levels
from .frames import frame_rows as frame_rows
from .places import Places as Places
from .places import places_along as places_along
from .shapes import coil as coil
from .shapes import rod_between as rod_between
from .still import draw_bristle as draw_bristle
