from .rodas4p2 import RODAS4P2 as RODAS4P2
from .rodas5p import RODAS5P as RODAS5P
from .step import Linearised as Linearised
from .step import Tableau as Tableau
from .step import combine as combine
from .step import dense_output as dense_output
from .step import rosenbrock_step as rosenbrock_step
