from .bristle_fit import fit_slide as fit_slide
from .check import check_design as check_design
from .design_slides import MEANINGS as MEANINGS
from .design_slides import SlideNumbers as SlideNumbers
from .design_slides import slide_numbers as slide_numbers
from .design_slides import slides_of_designs as slides_of_designs
from .slide_friction import steady_slide as steady_slide
from .surface_fit import fit_slide_profile as fit_slide_profile
