"""How far a trajectory by diffrax may go, what it keeps, what steers it."""

from typing import NamedTuple


class Settings(NamedTuple):
    """Of steps, of what is kept of them, of solvers of others."""

    # Integration (`integration.py`).
    max_steps: int = 2**30  # a bound, not a buffer: nothing is allocated for it
    # Of the energy dissipated: residual of a balance that is good. Solutions leave about
    # 1e-6 of it.
    residual: float = 0.05
    # Times that there is room for in the smallest program; in the next, four times as many.
    # (One gradient at one time takes as long with room for 64 as for 1024, but each lane of
    # a batch has it. Without room, gradients at 50 times after one: 9.4 CPU s, now 0.4.)
    times: int = 256

    # Derivatives in reverse mode (`way_adjoint.py`).
    # Steps of a piece, all of which are kept. Memory of all is cleared for each piece: 2^14
    # took 1.3 to 2.3 times as long.
    piece: int = 3840
    more: int = 256  # there is room for, when it is made again with other roundings
    most_pieces: int = 2**12  # kept; through more than that derivatives are NaN

    # Solvers (`solvers_by_name.py`).
    newton: float = 0.03  # of the step's tolerance


SETTINGS = Settings()
