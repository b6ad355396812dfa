from .manufacturing import tolerance as tolerance
from .maps import design_map as design_map
