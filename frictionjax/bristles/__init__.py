"""Bristles: tip offset `A(eta)` and energy `F(eta)`, nothing else.

- `VerticalSpring`, `SlantedSpring`, `AngularSpring`: the three models of the paper.
- `Homothetic`: the surface's shape as it is (Prandtl-Tomlinson); `Linear`: any bristle to
  leading order.
- `Custom(offset, energy)`: your own two functions; or derive from `AbstractBristle`.
"""

from .angular_spring import AngularSpring as AngularSpring
from .bristle import AbstractBristle as AbstractBristle
from .bristle import Rod as Rod
from .bristle import Stance as Stance
from .custom import Custom as Custom
from .homothetic import Homothetic as Homothetic
from .linear import Linear as Linear
from .pulling import normal_force as normal_force
from .pulling import pulling_note as pulling_note
from .pulling import pulling_text as pulling_text
from .pulling import swapped_text as swapped_text
from .slanted_spring import SlantedSpring as SlantedSpring
from .vertical_spring import VerticalSpring as VerticalSpring
