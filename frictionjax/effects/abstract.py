"""What an effect is."""

import enum
from typing import Any, ClassVar

from .._checks import Part


class Stage(enum.IntEnum):
    """Where an effect comes in; effects are composed in this order, before tracing.

    >>> [stage.name for stage in fx.effects.Stage]
    ['POTENTIAL', 'STATE', 'READING']
    """

    POTENTIAL = 0
    STATE = 1
    READING = 2


class AbstractEffect(Part):
    """Something that a scene calls for beyond the plain system of the paper.

    An implementer keeps these rules:

    1. Its numbers are fields, converted by `eqx.field(converter=as_real)`, checked in
       `__check_init__`, and named there as `effects.Kind.number`. All are read by
       something: a number that nothing reads is an error.
    2. It has no options in words, and no flags.
    3. `stage` says where it comes in. `POTENTIAL`: `changed` returns another wiggly
       potential, in Python, before anything is traced; all that is built on potentials
       follows. `STATE`: what moves is another system, which engines have to know of.
       `READING`: it changes no trajectory, and is read off one.
    4. Effects of the stages `POTENTIAL` and `READING` are done by all engines but those
       that `effects/engines.py` excepts: designs go by formulas, of effects that they know.
       Of those of `STATE` each lists there what it does, and refuses others by name.
    5. A scene without it runs the programs that it would run if the class did not exist.
    6. `of_bristle` names the class of bristles that it is about, where it is about one.

    >>> fx.effects.Noise.stage, fx.effects.AxialLoad.of_bristle
    (<Stage.STATE: 1>, 'AngularSpring')
    """

    stage: ClassVar[Stage] = Stage.POTENTIAL
    of_bristle: ClassVar[str] = ""

    def changed(self, potential: Any) -> Any:
        """The wiggly potential with this effect; itself where the stage is another."""
        return potential
