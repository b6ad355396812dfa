"""Whether a sampled curve solves the wiggly system, or the limit, by the scene alone.

Nothing of `wiggly` or `limit` is imported here: a certificate is worth something because
it comes from elsewhere."""

from .certification import certify as certify
from .limit_curve import certify_limit as certify_limit
