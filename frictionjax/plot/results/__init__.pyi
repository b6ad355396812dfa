from .certificate import draw_certificate as draw_certificate
from .cost_prediction import draw_cost_prediction as draw_cost_prediction
from .crawler import draw_crawler as draw_crawler
from .explanation import draw_explanation as draw_explanation
from .order_cost import draw_order_cost as draw_order_cost
from .steady_slide import draw_steady_slide as draw_steady_slide
