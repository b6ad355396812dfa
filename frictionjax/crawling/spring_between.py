"""The scene behind a crawler: one foot, pulled by the spring whose other end is held."""

from typing import Any

from .._checks import kind_of, require, require_real
from ..bristles import AbstractBristle
from ..loads import AbstractLoad, Pulled
from ..model import Scene
from ..profiles import AbstractProfile
from ..supports import Spring


def foot_on_spring(
    profile: AbstractProfile,
    bristle: AbstractBristle,
    stiffness: Any,
    breathing: AbstractLoad,
    duration: Any,
    length: Any,
) -> Scene:
    """`Phi = k z^2/2` and `l = k L(t)`: z is how long the spring is, L its rest length.

    L is `length` in m and what `breathing` adds.

    The limit of a crawler is the play operator of that scene with the smaller of both
    frictions on both sides, and its feet slip as this one does. Raises `ValueError` for
    parts that no scene accepts.
    """
    for name, part, kind, needs in (
        ("profile", profile, AbstractProfile, "a part of frictionjax.profiles"),
        ("bristle", bristle, AbstractBristle, "a part of frictionjax.bristles"),
        ("breathing", breathing, AbstractLoad, "a part of frictionjax.loads, read as m"),
    ):
        require(isinstance(part, kind), name, kind_of(part), needs)
    needs = "another load than Pulled, read as the rest length in m"
    require(not isinstance(breathing, Pulled), "breathing", "Pulled", needs)
    require_real("stiffness", stiffness, "stiffness > 0", lambda k: k > 0)
    require_real("length", length, "any length in m")
    # Pulled: l = k (q - rest_length + c), and c belongs to a bristle on a spring.
    load = Pulled(breathing, rest_length=bristle.root_constant() - length)
    return Scene(profile, bristle, Spring(stiffness), load, duration)
