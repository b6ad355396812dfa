from .force import AbstractForce as AbstractForce
from .force import AtTip as AtTip
from .force import Force as Force
from .force import ForceParts as ForceParts
from .force import force_of as force_of
from .tabulated import force_in_tables as force_in_tables
