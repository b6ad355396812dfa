"""What every result tells: whether it can be trusted, how it ended, and why."""

from typing import Any, ClassVar

import numpy as np

from .arguments import by_numpy, has_numbers, is_known
from .status_enums import Outcome, counted, flags, outcomes


class Result:
    """Base of results, which have a `status`: a member of an enum of outcomes.

    `_good`: the outcomes with which the numbers are what was asked for.
    """

    __slots__ = ()
    _good: ClassVar[tuple[Outcome | int, ...]] = (0,)
    status: Any

    @property
    def _codes(self) -> Any:
        """How it ended, as an integer or an array of them."""
        return self.status

    @property
    def ok(self) -> Any:
        """One bool; of a batch (`jax.vmap`), or where traced, an array of them."""
        codes = by_numpy(self._codes)
        good = codes == int(self._good[0])
        for other in self._good[1:]:
            good = good | (codes == int(other))
        return flags(good)

    @property
    def message(self) -> Any:
        """Why, for people."""
        return self.status.message


class CodedResult(Result):
    """Base of results that may be batched or traced: of integers `_codes` of `_outcomes`.

    An implementer says in `_in_words` what of it is printed where its numbers are known.
    """

    __slots__ = ()
    _outcomes: ClassVar[type[Outcome]]

    @property
    def status(self) -> Any:
        """An outcome with `.message`; of a batch an array; integers where traced."""
        return outcomes(self._outcomes, self._codes)

    @property
    def message(self) -> Any:
        """Why, for people: one text, or a list of them of a batch; empty where traced."""
        if not is_known(self._codes):
            return ""
        codes = np.asarray(self._codes)
        told = [self._outcomes.of(code).message for code in codes.ravel()]
        return np.reshape(np.array(told, dtype=object), codes.shape).tolist()

    @property
    def _ended(self) -> str:
        """How it ended, in words."""
        return counted(self._outcomes, self._codes)

    def _in_words(self) -> str:
        raise NotImplementedError

    def __repr__(self) -> str:
        told = has_numbers(self) and self._codes is not None
        return self._in_words() if told else super().__repr__()
