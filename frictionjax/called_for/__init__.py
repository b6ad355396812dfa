"""Which effects of a scene its accuracy calls for: what each changes, from above."""

from .estimates import Estimate as Estimate
from .estimates import estimate_of as estimate_of
from .inertia_number import inertia_numbers as inertia_numbers
from .left_out import ALL as ALL
from .left_out import Simulated as Simulated
from .left_out import left_out_in_words as left_out_in_words
from .left_out import simulated as simulated
from .plain_system import HigherOrder as HigherOrder
from .plain_system import finite_speed as finite_speed
from .plain_system import higher_order as higher_order
from .setting import AWAY as AWAY
from .setting import Setting as Setting
from .setting import setting_of as setting_of
from .turns_on_folds import bristle_places as bristle_places
from .turns_on_folds import turns_on_folds as turns_on_folds
