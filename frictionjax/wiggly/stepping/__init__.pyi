from .computed_once import materialise as materialise
from .settings import SETTINGS as SETTINGS
from .step_control import Control as Control
from .step_control import ControlState as ControlState
from .step_control import StepVerdict as StepVerdict
from .step_control import judge as judge
from .step_sizes import rounded_down as rounded_down
from .step_sizes import step_of as step_of
