"""How finely densities and paths are computed: with what lost."""

from typing import NamedTuple


class Settings(NamedTuple):
    """Counts, unless said otherwise."""

    sampled: int = 1024  # places of one compiled call of a potential

    # Constant force (`constant_force.py`).
    panel_nodes: int = 8  # Gauss-Legendre; with 4 the speeds of the tests lose 3 digits
    panel_rise: float = 1.0  # of the exponent inside a panel
    least_panels: int = 32
    most_panels: int = 2**15  # a second for a dozen forces

    # At rest (`boltzmann.py`, `histograms.py`).
    panels_a_well: int = 16
    tail_at_rest: float = 1e-18  # of Boltzmann's weight
    most_nodes_at_rest: int = 2**22  # a few seconds
    least_expected: float = 5.0  # paths in a bin of chi^2: the usual rule
    fine: int = 801  # places of the density's curve

    # Steady drive (`smoluchowski.py`, `driven_period.py`).
    accuracy: float = 1e-4  # of the largest force of the wells
    # Cells of a standard deviation in a well, on the coarsest grid. At 1.5, 3 and 6 the six
    # frictions of the tests are off by at most 8e-5, 1e-5 and 3e-6 N before extrapolation.
    cells_a_deviation: float = 1.5
    least_cells: int = 32  # of a period
    most_carried: float = 4.0  # drag times a cell over temperature: cells diffuse beyond 2
    steps: int = 64  # of a period in time, on the coarsest grid
    most_work: int = 2**23  # cells times steps of one period: 1 s for each of its rounds
    # The same of all periods that a slide marches, on all of its grids, 50 s, and a third
    # of what is left for a grid that has no other to be held against. Fast slides in soft
    # springs forget slowly: of 45 that end well, at 1e-4 to 50 m/s and with 1e-2 to 1e-8 J,
    # the slowest takes 48 times most_work (by hand).
    most_marched: int = 7 * 2**26
    share_of_one: float = 1 / 3
    grids: int = 5  # each of twice the cells and steps of the last
    rougher: int = 8  # than the first: where mass is
    tail: float = 1e-12  # of Gaussian mass outside of the window
    no_mass: float = 1e-18  # in periods that the next grid leaves out
    # Densities a period apart differ by less. Rounding of slow drives leaves 1e-11.
    periodic: float = 1e-9
    most_periods: int = 250
    # Densities that Anderson's acceleration combines. Periods for 1e-10 with 0, 5 and 12:
    # 206, 46, 36 (fast, few wells), 54, 17, 14, and 120, 99, 121 (slow, a hundred wells).
    combined: int = 8
    lost: float = 1e-6  # mass through the ends of the window, or to rounding

    # Paths (`path_steps.py`, `paths.py`).
    # Step times the largest curvature of the energy over viscosity. Means at rest allow
    # 0.25, rates do not: with 0.25, 0.1 and 0.05 free tips on a sine that is four
    # temperatures deep diffuse 13%, 7% and 3% (+- 2%) too slowly, at two 8%, 4% and 1%.
    step_curvature: float = 0.05
    # Root mean square of a step of free diffusion, in periods: hot tips see the wells too.
    # With 0.1 and 0.05 diffusion over wells of 0.3 temperatures is the same to 0.1%.
    step_diffusion: float = 0.1
    table_nodes: int = 1024  # of the force, the least, doubled until its error is
    table_error: float = 1e-7  # of the largest force
    most_nodes: int = 2**16
    block: int = 64  # steps whose noise comes from one key
    # Paths side by side. Nanoseconds of a path's step with 8, 16, 64 and 256: 20, 18, 18
    # and 17 with the flags of `use_fast_cpu`, 117, 80, 51 and 33 without; one path alone
    # pays for all.
    lanes: int = 16
    moments: int = 512  # of the load, at which the support's stiffness is looked at
    guesses: int = 4097  # times at which it is guessed where a path in tiles is
    times: int = 64  # of one compiled call; more are in rooms four times as large each
    most_steps: int = 2**31 - 2  # of a path: they are counted in 32 bits
    confidence: float = 0.95


SETTINGS = Settings()
