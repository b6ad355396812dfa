"""Tolerances of steps and what energies may err by: measured, with what lost."""

from typing import NamedTuple


class Settings(NamedTuple):
    """Of plans of steps and of energy balances."""

    # Plans of steps (`step_plan.py`).
    # Accuracy over tolerance. At 100 and `in_slips` of 0.1, errors at gamma = 0.65 were 1.6
    # times as large, and 3e-3 eps where 1e-3 was asked for, for 7% fewer steps.
    safety: float = 200.0
    # Of tolerances, periods: looser ones save little (46 steps a slip for 58), as guard and
    # folds rule.
    loosest: float = 1e-4
    tightest: float = 1e-13
    least_asked: float = 1e-10  # accuracy, eps
    # Share of the way to a fold, half a percent of a slip period before it, that one step
    # may err by. At 0.6 slips came up to 3% of a period early, with closed brackets (eps =
    # 1e-5 to 1e-7, gamma = 2); at 0.2 none did.
    fold: float = 0.03
    # Speed at folds below which tolerances are tighter in proportion, where slips add up.
    # At gamma = 1/2, eps = 1e-4 (0.006) errors were 2.4e-3 eps without, where 1e-3 was
    # asked for.
    creep: float = 0.025
    # Before a slip, in slip periods: the last instants that count as outside it.
    before: float = 0.005
    # Half a percent of a period before a slip the tip runs up to five times as fast as the
    # slide, and an error of a step is one in time: tolerances are tighter by this share of
    # that speed over the one at the fold. Without, errors of such instants were up to 3.9
    # times the accuracy asked for (slanted spring, gamma = 3/4, eps = 1e-4, accuracy 1e-6);
    # at 0.007 up to 1.7. Steps of windows: 1% more at gamma = 1, 4 to 9% at 3/4.
    haste: float = 0.012
    fastest_counted: float = 5.0  # slide speeds: instants with a faster tip are in a slip
    # Errors of a few slips, added up; those of all add up to 1e4 at eps = 1e-8, gamma =
    # 1/4. At 4, surveys at gamma = 0.4 were 4e-3 eps off; 16 to 500 gave the same to 1e-5
    # eps.
    few_add: float = 30.0
    # Of the accuracy: error of a step in the middle of a slip. At 0.2 steps are 4% fewer,
    # and brackets at eps = 1e-8 stay open.
    in_slips: float = 0.05
    # Wells of a slide from which on its dissipation is as good as its states. (What is
    # dissipated within a well, on the way from one rest to the next, was 2e-5 off where
    # 1e-5 was asked for, and 1.4e-6 where 1e-6 was.)
    many_wells: float = 100.0
    # Tightest tolerance for fewer, over that of many, and the power of the share of wells
    # that it goes with. In slides of few wells on supports that hold the tip, and where
    # nothing slides, less than a hundredth of a slip is dissipated: up to 100 times the
    # accuracy off with the share of the wells itself, 1e-2 at least; 0.16 with its power
    # 3/2, 1e-4 at least, for twice the steps.
    fewest: float = 1e-4
    power: float = 1.5
    # The same where tolerances are near the rounding of z.
    roughest: float = 1e-2
    rounded: float = 2e-11  # over |z|: tolerances times `safety` that are near it
    double_spacing: float = 2.0**-50  # shortest step over the duration: four of floats
    # Times narrower than those on both sides: a branch that is a corner (`landscape.py`).
    # With corners as branches a polyline took 8 to 160 times as many steps, for states that
    # are no nearer to another code's than the accuracy (120 random surfaces, by hand).
    corner: float = 8.0

    # Where the load turns at folds (`turns_at_folds.py`).
    cancelled: float = 2.0**-48  # of forces: their rounding where they cancel
    flat: float = 1e-300  # N: added to curvatures that may be 0

    # Energies (`energy_balance.py`).
    # Distance in periods from its equilibrium up to which a rest counts as one: tolerances
    # are up to 1e-4, and 1e-6 with a viscosity of 1e-12 would look like a residual of 0.1
    # slips.
    at_rest: float = 1e-4
    near: float = 1e-2  # periods from a rest: up to there forces are linear
    # Over the mean: slopes, at most. (With 1e-3 periods a step more, 9 of 75 balances at
    # corners of 1e-4 of a period and more did not close, gamma of 3/2 and more; now all.)
    steep: float = 10.0
    # Of the steeper slope: what no parabola has of both, where they are no spike.
    twist: float = 0.5
    stiff: float = 3.0  # steps longer than this many relaxation times count as rest
    # Error of the direct sum of a dissipation, over the root of residual and dissipation:
    # at most, in 99.9% of random scenes with few slips.
    of_sum: float = 0.25
    # Error of energies, over accuracy, eps and what the load goes. (The same or fewer out
    # anywhere from 3e-5 to 3e-4.)
    of_energies: float = 1e-4
    rounding: float = 1e-15  # of energies

    # Warnings (`status.py`).
    named: int = 4  # cells in the text


SETTINGS = Settings()
