"""The wiggly potential without what is of higher order in eps."""

from .abstract import AbstractEffect


class LeadingOrder(AbstractEffect):
    """`V_eps = eps W(z/eps)`: Lemma 2 without `eps^2 Q`.

    With it, what Q does to a scene can be measured: coefficients and limit stay the same,
    friction at finite eps changes by `eps Q'` at the steepest place of W.

    >>> bare = scene.replace(effects=(fx.effects.LeadingOrder(),))
    >>> print(fx.explain(bare, eps=0.01, gamma=1.0).equation)
    eps^gamma z' = l(t) - Phi'(z) - V_eps'(z)
      V_eps(z) = eps W(z/eps): its leading part alone (Lemma 2 without Q)
      eps = 0.01 m, gamma = 1, eps^gamma = 0.01 N s/m
    """
