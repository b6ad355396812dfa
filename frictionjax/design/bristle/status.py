"""How the search for a bristle ended."""

from ..._checks import Outcome


class FitStatus(Outcome):
    """Why a bristle does or does not give what was asked; `message` says it for people."""

    OK = 0, "found"
    TANGENT = 1, "found where the quantity turns: sensitivities are infinite there"
    INDIFFERENT = 2, "every admissible value gives it: the quantity does not depend on it"
    ROUNDED = 3, "met to less than 9 digits: the floats of the parameter are that coarse"
    MORE = 4, "found, but there are more solutions, or turns, than there is room for"
    UNREACHABLE = 5, "no admissible value gives it"
    INADMISSIBLE = 6, "no value in the bounds is admissible on this surface"
    UNKNOWN = 7, "not found, but not every value could be evaluated"
    PULLS = 8, "reached only by a bristle that pulls"


GOOD = (FitStatus.OK, FitStatus.TANGENT, FitStatus.INDIFFERENT, FitStatus.MORE)
