from .hybrid_motion import HybridMotion as HybridMotion
from .hybrid_motion import MotionSteps as MotionSteps
from .hybrid_motion import integrate_turning as integrate_turning
