"""The wiggly potential without what is of higher order in eps."""

from .abstract import AbstractEffect


class LeadingOrder(AbstractEffect):
    """`V_eps = eps W(z/eps)`: Lemma 2 without `eps^2 Q`.

    With it, what Q does to a scene can be measured: coefficients and limit stay the same,
    friction at finite eps changes by `eps Q'` at the steepest place of W.
    """
