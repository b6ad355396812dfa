"""Bristles: tip offset `A(eta)` and energy `F(eta)`, nothing else."""

from .angular_spring import AngularSpring as AngularSpring
from .bristle import AbstractBristle as AbstractBristle
from .custom import Custom as Custom
from .homothetic import Homothetic as Homothetic
from .slanted_spring import SlantedSpring as SlantedSpring
from .vertical_spring import VerticalSpring as VerticalSpring
