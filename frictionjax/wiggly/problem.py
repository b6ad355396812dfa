"""What `solve` hands to its engines."""

from typing import Any, NamedTuple

from jaxtyping import Array

from ..model import Scene


class Problem(NamedTuple):
    """A scene at one eps (m) and gamma, times (s), and the accuracy wanted, in eps.

    Trajectories have derivatives by all of them.
    """

    scene: Scene
    eps: Any
    gamma: Any
    ts: Array
    accuracy: Any
