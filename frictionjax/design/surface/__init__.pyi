from .fit import fit_profile as fit_profile
from .result import ProfileFit as ProfileFit
from .status import MET as MET
from .status import ProfileStatus as ProfileStatus
