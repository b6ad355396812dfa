"""Thousands to a hundred million wells."""

from entry import every_slip
from quasi_static import quasi_static
from shortened import shortened, shortened_with
from springs import SINE, Spring, slopes

# Where the load turns, no fold is met exactly.
_FAR = (0.0, *[0.903719314159] * 2, *[-0.812332171828] * 2, *[0.407917732051] * 2)
_MILLION = tuple(2.2e4 * v for v in _FAR)
_HOURS = {"values": _MILLION, "pace": 2.2e4, "methods": ("auto",)}
_SWIFT = shortened_with(quasi_static(SINE, 1.0))
_THOUSANDS = {"values": _FAR, "truth": every_slip, "slow": True}

LONG_SLIDES = {
    "3000 slips": Spring("3000 slips in a row", 1e-3, **_THOUSANDS),
    "3000 slips, gamma 2": Spring(
        "slips of 1e-5 of the time between", 1e-3, 2.0, **_THOUSANDS
    ),
    "3000 slips, gamma 1/2": Spring("lags of several wells", 1e-3, 0.5, **_THOUSANDS),
    "3000 slips, alpha < 0": Spring(
        "3000 slips over two folds each",
        1e-3,
        surface=slopes(0.05, 0.1, 0.0, 0.0),
        alpha=-0.5,
        **_THOUSANDS,
    ),
    "1e6 slips": Spring("a horizon of 1e6 slips, 18 hours", truth=shortened, **_HOURS),
    "1e6 slips, gamma 1/2": Spring(
        "1e6 slips, starts forgotten slowly",
        gamma=0.5,
        truth=shortened_with(stay=800),
        **_HOURS,
    ),
    "1e6 slips in 3 s": Spring(
        "eps = 1e-6 m", 1e-6, values=_FAR, truth=_SWIFT, methods=("auto",)
    ),
    "eps 1e-8": Spring(
        "3e8 slips of 1e-15 s", 1e-8, values=_FAR, truth=_SWIFT, methods=("auto",)
    ),
    "slips shorter than floats": Spring(
        "slips of 1e-19 s, 1e-16 s between floats",
        1e-4,
        4.0,
        values=_FAR,
        truth=quasi_static(SINE, 1.0),
        methods=("auto",),
    ),
}
