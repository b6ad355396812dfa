"""Some tens of wells: parameters, surfaces, loads and starts that are hard."""

from springs import CALM, SUMMIT, Spring, slopes

PARAMETERS = {
    "gamma 4": Spring("slips 1000 times shorter than what is between", 0.1, 4.0),
    "gamma 0.05": Spring("hardly stiff, lags of about twenty wells", gamma=0.05),
    "soft support": Spring("7 km of way, eps of 100 m, 9 years", 100.0, k=1e-4, pace=1e8),
    "stiff support": Spring("eps of 5e-6 m, forces of 1 N", 5e-6, 0.1, k=1e4),
    "no folds": Spring(
        "a support stiffer than wells: 7 kN against 0.1 N",
        k=1e4,
        values=tuple(1e4 * v for v in CALM),
    ),
    "alpha near 0": Spring(
        "wiggles of 1e-6 of the bristle's stiffness",
        5e-8,
        0.5,
        alpha=1e-6,
        values=tuple(1e-6 * v for v in CALM),
    ),
    "alpha < 0": Spring("folds change sides", alpha=-0.5),
}

SURFACES = {
    "two folds": Spring(
        "two folds a period", surface=slopes(0.05, 0.1, 0.0, 0.0), shows_surface=True
    ),
    "equal folds": Spring(
        "two folds, equal within 0.2%",
        surface=slopes(1e-4, 0.1, 0.0, 0.0),
        shows_surface=True,
    ),
    "flat": Spring(
        "a flat stretch, where w' and its next two derivatives vanish",
        surface=slopes(0.0375, 0.06, 0.0225, 0.0),
        shows_surface=True,
    ),
    "steep": Spring(
        "barriers that the load never climbs", surface=slopes(2.0, 0.0, 0.5, 0.0)
    ),
}

LOADS = {
    "kinks and plateaus": Spring("rests on which values have to stay"),
    "fast part": Spring(
        "the load jumps within 1e-6 s",
        times=(0.0, 1.0, 1.000001, 1.5, 2.0, 2.5, 3.0),
        values=(0.0, 0.2, 0.9, 0.9, 0.4, 0.4, 0.1),
        window=(0.9, 1.2),
    ),
    "slow part": Spring(
        "a load of 1e-3 N/s after one of 1 N/s",
        times=(0.0, 0.8, 3.0 - 1e-3, 2.9995, 2.9997, 2.9999, 3.0),
        values=(0.0, 0.8, 0.802, 0.802, 0.802, 0.802, 0.802),
    ),
    "tiny reversals": Spring(
        "turns that move the load by 0.01 wells",
        times=(0.0, 1.0, 1.1, 1.2, 1.3, 1.4, 3.0),
        values=(0.0, 0.61, 0.6095, 0.61, 0.6095, 0.61, -0.5),
        window=(0.8, 1.7),
    ),
    "on the edge": Spring(
        "the load stops on the strip's edge", values=(0.0, 0.1, 0.1, -0.1, -0.1, 0.1, 0.1)
    ),
    "hardly moves": Spring(
        "a load worth 90 m moves z by millimetres",
        eps=19.0,
        gamma=1.34,
        alpha=0.28,
        k=2.4e-3,
        values=tuple(0.22 * v for v in CALM),
    ),
}

STARTS = {
    "far from the origin": Spring(
        "1e-6 wells of way, 4700 wells from 0: sums cancel",
        eps=19.0,
        gamma=2.4,
        alpha=0.28,
        k=2.4e-3,
        values=tuple(216.0 + 0.022 * v for v in CALM),
        z0=9e4,
    ),
    "far above": Spring("a start 400 wells outside the strip", z0=20.0),
    "far below": Spring("a start 400 wells outside the strip", gamma=2.0, z0=-20.0),
    "on a summit": Spring(
        "a start on an unstable equilibrium", z0=SUMMIT, window=(0.0, 0.6)
    ),
    "on the strip's edge": Spring("a start exactly on the edge of the strip", z0=-0.1),
}

UNITS = {
    "micrometres, 1e-6 N/m": Spring(
        "bristles of 1 um and 1e-12 N", length=1e-6, force=1e-12
    ),
    "micrometres, 1e6 N/m": Spring(
        "bristles of 1 um and 1 N: slips of 1e-14 s", length=1e-6, force=1.0
    ),
    "kilometres, 1e-6 N/m": Spring(
        "wells of 50 m, 12 orders softer than the last", length=1e3, force=1e-3
    ),
}

FEW_WELLS = PARAMETERS | SURFACES | LOADS | STARTS | UNITS
