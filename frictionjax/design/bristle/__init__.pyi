from .angle import fit_angle as fit_angle
from .result import AngleFit as AngleFit
from .result import intervals_text as intervals_text
from .status import FitStatus as FitStatus
