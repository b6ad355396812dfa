from .certificate import draw_certificate as draw_certificate
from .cost_prediction import draw_cost_prediction as draw_cost_prediction
