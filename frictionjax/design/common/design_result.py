"""What inverse designs return."""

from typing import Any, ClassVar, Self

from ..._checks import Result, as_text
from ..._text import Named
from ...io import Document, written


class DesignResult(Result):
    """Base of results of inverse designs; `document` declares their JSON."""

    __slots__ = ()
    document: ClassVar[Document]

    @property
    def success(self) -> Any:
        """Whether it is what was asked for: one bool, or one a target; as `ok`."""
        return self.ok

    def to_json(self, path: Any = None) -> str:
        r"""Everything as JSON, but iterates' shapes; written to `path` where given.

        >>> fx.fit_angle(scene.profile, scene.bristle, ratio=1.5).to_json("fit.json")[:38]
        '{\n "kind": "frictionjax.AngleFit",\n "m'
        """
        return written(self.document.text(self), path)

    @classmethod
    def from_json(cls, source: Any) -> Self:
        """The result again, from the text or the path of its JSON.

        A bristle or a surface given as functions is None, iterates' shapes are empty.
        Raises `ValueError` for what is no such JSON.

        >>> fit = fx.fit_angle(scene.profile, scene.bristle, ratio=1.5)
        >>> type(fit).from_json(fit.to_json())
        AngleFit(angle=1.10715: ratio = 1.5: found, angle = 1.10715)
        """
        return cls(**cls.document.parse(source))


def named_forces(kind: str, forces: Any, targets: Any) -> list[Named]:
    """Forces (targets, 2) to the right and to the left in N, beside those wanted."""
    told = []
    for index, (found, wanted) in enumerate(zip(forces, targets, strict=True)):
        which = f" {index + 1}" if len(targets) > 1 else ""
        for side, name in enumerate(("plus", "minus")):
            asked = f"wanted {as_text(wanted[side])} N"
            told.append(Named(f"{kind}_{name}{which}", found[side], "N", asked))
    return told
