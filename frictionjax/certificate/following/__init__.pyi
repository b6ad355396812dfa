from .rests import FollowedCurve as FollowedCurve
from .rests import FromRests as FromRests
from .rests import distances_from_rests as distances_from_rests
