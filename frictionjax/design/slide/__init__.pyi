from .bristle_fit import fit_slide as fit_slide
from .check import check_design as check_design
from .slide_friction import steady_slide as steady_slide
from .surface_fit import fit_slide_profile as fit_slide_profile
