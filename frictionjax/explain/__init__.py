"""What a scene simulates, as one equation, and which effects its accuracy calls for."""

from .explanation import Explanation as Explanation
from .explanation import explain as explain
