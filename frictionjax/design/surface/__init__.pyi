from .fit import fit_profile as fit_profile
from .json import profile_to_json as profile_to_json
from .result import ProfileFit as ProfileFit
from .status import MET as MET
from .status import ProfileStatus as ProfileStatus
