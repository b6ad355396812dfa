"""Results that draw themselves, by pictures that stand on a floor above them."""

import sys
from typing import Any, ClassVar

from .._checks import is_known, require


def require_no_axes(ax: Any) -> None:
    """Raise `ValueError` for axes where a picture has several of its own."""
    needs = "None, as the picture has several axes: figure takes a Figure or SubFigure"
    require(ax is None, "ax", ax, needs)


class SelfDrawn:
    """Base of results with a picture of one axis.

    An implementer names in `_picture` the function of `frictionjax.plot` that draws it,
    and is given the result and `ax`. It is looked up when somebody draws, on the library's
    face, which imports what is used and when: results know nothing of pictures.
    """

    __slots__ = ()
    _picture: ClassVar[str]

    def plot(self, ax: Any = None) -> Any:
        r"""The picture, as a matplotlib Figure; drawn into `ax`, where there is one, which
        is then returned.

        What is drawn, and what is refused with `ValueError`: `fx.plot`, whose functions
        have the results' names. Of a trace there is none.

        >>> figure = fx.friction(scene).plot()
        >>> [text.get_text() for text in figure.axes[0].texts]
        ['$\\rho_+$ = 0.12 N', '$\\rho_-$ = -0.0879 N']
        """
        kind = type(self).__name__
        require(is_known(self), kind, "a trace", "known numbers")
        pictures = sys.modules[__name__.partition(".")[0]].plot
        return getattr(pictures, self._picture)(self, ax=ax)
