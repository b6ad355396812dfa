"""What is known of methods before diffrax is imported, 0.5 s: names, steps allowed."""

from .settings import SETTINGS

MAX_STEPS = SETTINGS.max_steps
OURS = ("auto", "resolved", "windowed")


def is_ours(method: object) -> bool:
    """Whether `method` names one of the library's own ways."""
    return isinstance(method, str) and method in OURS
