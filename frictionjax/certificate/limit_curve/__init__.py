"""Whether a sampled curve solves the limit system: experiments, and other codes.

Nothing of `limit` is imported here."""

from .certification_of_limits import certify_limit as certify_limit
