from .curves import friction_curve as friction_curve
