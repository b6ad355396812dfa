"""What theory says of a slide: errors predicted at each eps, orders and constants.

In a slide the force F = l - Phi'(z) that drives the tip over the wells obeys
`dF/dY = eps k (v eps^gamma/(F - W'(Y)) - 1)`, with k = Phi'' and v the speed of the limit.
Its periodic solution says how far the tip lags behind the limit and runs ahead of it, at
every eps and gamma; its limits for eps -> 0 are the laws of the orders.
"""

from .ingredients import LAW_DIMS as LAW_DIMS
from .ingredients import SlideData as SlideData
from .ingredients import slide_data as slide_data
from .predictions import NO_LAW as NO_LAW
from .predictions import Law as Law
from .predictions import Prediction as Prediction
from .predictions import predict_errors as predict_errors
