"""Corners: branches far narrower than others, which steps go over and see from beyond."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import frictionjax as fx
from frictionjax.wiggly.equation import Status

PLACES, HEIGHTS, RADIUS = [0.1, 0.4, 0.7], [0.0, 0.02, -0.01], 0.002
HELD, PRESSED = 1.6, 1.0  # N/m and N: of the support, and of the bristle on a plane
TIMES, LOADS = [0.0, 1.0, 3.0], [0.0, 0.4, -0.4]
TS = np.linspace(0.1, 3.0, 30)


def scene():
    return fx.Scene(
        fx.profiles.Polyline(PLACES, HEIGHTS, RADIUS),
        fx.bristles.VerticalSpring(1.0, 2.0, 1.0),
        fx.supports.Spring(HELD),
        fx.loads.PiecewiseLinear(TIMES, LOADS),
        duration=3.0,
    )


def slopes_and_heights():
    """By NumPy, with arcs for corners: as narrow as they are, the rounding is not felt."""
    ends = np.append(PLACES, PLACES[0] + 1), np.append(HEIGHTS, HEIGHTS[0])
    flanks = np.diff(ends[1]) / np.diff(ends[0])
    half = 0.5 * RADIUS * np.abs(flanks - np.roll(flanks, 1))
    x = np.ravel(np.column_stack([PLACES - half, PLACES + half]))
    w = np.ravel(np.column_stack([np.roll(flanks, 1), flanks]))
    x = np.concatenate([x[-1:] - 1, x, x[:1] + 1])
    w = np.concatenate([w[-1:], w, w[:1]])
    rise = np.append(0.0, np.cumsum(0.5 * (w[1:] + w[:-1]) * np.diff(x)))

    def at(y):
        y = y - np.floor(y)
        place = np.searchsorted(x, y) - 1
        more = y - x[place]
        bend = (w[place + 1] - w[place]) / (x[place + 1] - x[place])
        return w[place] + bend * more, rise[place] + (w[place] + 0.5 * bend * more) * more

    # Flanks go through the points given.
    middle = 0.5 * (PLACES[0] + PLACES[1])
    off = at(middle)[1] - 0.5 * (HEIGHTS[0] + HEIGHTS[1])
    return lambda y: (at(y)[0], at(y)[1] - off)


def states_by_radau(eps, gamma):
    surface = slopes_and_heights()

    def speed(t, z):
        slope, height = surface(z[0] / eps)
        pull = np.interp(t, TIMES, LOADS) - HELD * z[0]
        return [(pull - (PRESSED + eps * height) * slope) / eps**gamma]

    options = {"method": "Radau", "rtol": 1e-8, "atol": 1e-8 * eps, "max_step": 1e-2}
    with np.errstate(divide="ignore"):  # SciPy's, where tips rest
        first = solve_ivp(speed, (0.0, 1.0), [0.0], t_eval=TS[TS <= 1], **options)
        then = solve_ivp(speed, (1.0, 3.0), first.y[:, -1], t_eval=TS[TS > 1], **options)
    return np.concatenate([first.y[0], then.y[0]])


@pytest.mark.parametrize(
    ("gamma", "eps", "most"),
    [
        (0.4, 0.05, 3e3),  # 1.1e3; 1.2e5 where corners count as branches
        pytest.param(0.4, 0.01, 1.5e4, marks=pytest.mark.slow),
        pytest.param(1.5, 0.01, 1.5e4, marks=pytest.mark.slow),
    ],
)
def test_few_steps_go_over_a_corner_and_none_goes_over_a_well(gamma, eps, most):
    found = fx.sweep(scene(), [eps], [gamma], ts=TS)
    assert found.status.item() == int(Status.OK)
    assert found.steps.item() < most
    off = np.abs(found.z.values.ravel() - states_by_radau(eps, gamma))
    assert np.max(off) < 1e-3 * eps


@pytest.mark.parametrize(
    ("gamma", "eps", "most"),
    [
        (0.4, 1e-6, 5e5),  # 2.3e5; open brackets where a corner is not resolved
        pytest.param(0.3, 1e-5, 5e5, marks=pytest.mark.slow),
        pytest.param(0.5, 1e-8, 2e6, marks=pytest.mark.slow),
    ],
)
def test_fast_slides_over_corners_are_known_by_slip_maps(gamma, eps, most):
    found = fx.sweep(scene(), [eps], [gamma], ts=TS)
    assert found.status.item() == int(Status.OK)
    assert found.steps.item() < most


@pytest.mark.parametrize(
    "eps", [[1e-5], pytest.param([1e-3, 1e-4, 1e-6], marks=pytest.mark.slow)]
)
def test_balances_close_where_tips_leave_a_corner(eps):
    """Steps out of a corner are short, but end a hundred times as fast as they are far."""
    found = fx.sweep(scene(), eps, [1.5, 2.0, 3.0], ts=TS)
    assert np.all(found.status == int(Status.OK))
    assert np.all(found.residual < 1e-3 * found.dissipation.isel(time=-1))


def test_slip_maps_over_corners_agree_with_every_slip():
    eps, gamma = 1e-4, 0.4
    by_map, every = (
        fx.solve(scene(), eps, gamma, TS, 1e-3, method)
        for method in ("windowed", "resolved")
    )
    assert by_map.stats["steps"] < 0.1 * every.stats["steps"]
    assert np.max(np.abs(by_map.z - every.z)) < 1e-3 * eps


def test_cells_over_corners_are_what_they_are_alone():
    """Nodes of slip maps are as many for all cells as for the one that needs most."""
    eps, gamma = [1e-2, 1e-4, 1e-5], 0.4
    together = fx.sweep(scene(), eps, [gamma], ts=TS)
    for one in eps:
        alone = fx.sweep(scene(), [one], [gamma], ts=TS)
        off = together.z.sel(eps=one) - alone.z.sel(eps=one)
        assert float(np.abs(off).max()) < 1e-3 * one
        # Where a map made in company is wrong, lanes find out, and go through every slip.
        assert together.steps.sel(eps=one).item() < 1.2 * alone.steps.item()
