"""What a scene simulates, as one equation, and which effects its accuracy calls for."""

from .equation import composed_equation as composed_equation
from .explanation import Explanation as Explanation
from .explanation import explain as explain
