"""Whether a sampled curve solves the wiggly system, judged from the scene alone.

Nothing of `wiggly` is imported here: a certificate is worth something because it comes
from elsewhere."""

from .certification import certify as certify
