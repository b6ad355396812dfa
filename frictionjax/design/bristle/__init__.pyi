from .angle import fit_angle as fit_angle
from .json import angle_entry as angle_entry
from .json import angle_fields as angle_fields
from .result import AngleFit as AngleFit
from .result import intervals_text as intervals_text
from .status import FitStatus as FitStatus
