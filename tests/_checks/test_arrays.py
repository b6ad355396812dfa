"""Arrays as people have them: masked, of NumPy's integers, selected, rounded."""

import jax.numpy as jnp
import numpy as np
import pytest
from sweep_like import sweep_like

import frictionjax as fx
from frictionjax._checks.arguments import (
    as_real,
    known_numbers,
    require_whole,
    without_masked,
)
from frictionjax.model.scene import require_times

X = np.arange(400) * 1e-6
HEIGHTS = 2e-6 * np.sin(2 * np.pi * X / 5e-5) + 5e-7 * np.cos(4 * np.pi * X / 5e-5)
FILLED = 1e20  # what stands under a mask


def masked(values, where):
    values = np.array(values, dtype=float)
    values[where] = FILLED
    mask = np.zeros(values.shape, dtype=bool)
    mask[where] = True
    return np.ma.array(values, mask=mask)


MASKED = masked([0.0, 0.01, 0.0, -0.01, 0.0], 1)


@pytest.mark.parametrize("where", [7, slice(20, 30), slice(0, 5), slice(390, None)])
@pytest.mark.parametrize("both", [False, True])
def test_masked_samples_of_a_trace_of_heights_are_left_out(where, both):
    x = masked(X, slice(100, 104)) if both else X
    found = fx.profiles.Fourier.from_heights(x, masked(HEIGHTS, where), harmonics=3)
    whole = fx.profiles.Fourier.from_heights(X, HEIGHTS, harmonics=3)
    assert found.period == pytest.approx(whole.period, rel=1e-6)
    for name in ("sin", "cos"):
        one, other = getattr(found.profile, name), getattr(whole.profile, name)
        assert np.allclose(one, other, rtol=0, atol=1e-7)


def test_a_mask_over_the_same_part_of_every_period_is_refused():
    x = np.arange(400) / 400 * 4.0
    hidden = (x % 1.0 > 0.4) & (x % 1.0 < 0.7)
    heights = masked(np.sin(2 * np.pi * x), hidden)
    said = r"heights = '\d+ of 400 masked, none in 0\.3\d* of a period': needs samples in"
    with pytest.raises(ValueError, match=said):
        fx.profiles.Fourier.from_heights(x, heights, period=1.0, harmonics=4)
    with pytest.raises(
        ValueError, match="heights = '4 of 8 masked': needs 8 or more samples"
    ):
        fx.profiles.Fourier.from_heights(X[:8], masked(HEIGHTS[:8], slice(4, 8)))


def test_masked_samples_of_a_trace_are_left_out_and_counted():
    ts, force = np.linspace(0.0, 1.0, 11), np.linspace(1.0, 2.0, 11)
    trace = fx.Trace(masked(ts, 2), force=masked(force, slice(5, 7)), uncertainty=0.1)
    assert trace.ts.tolist() == np.delete(ts, [2, 5, 6]).tolist()
    assert trace.values.tolist() == np.delete(force, [2, 5, 6]).tolist()
    assert trace.uncertainty.shape == (8,)
    assert "3 masked samples left out" in repr(trace)
    plain = fx.Trace(ts, force=np.ma.array(force))
    assert plain.masked == 0
    assert plain.values.tolist() == force.tolist()
    errors = masked(np.full(11, 0.1), 0)
    assert fx.Trace(ts, z=force, uncertainty=errors).ts[0] == ts[1]


@pytest.mark.parametrize(
    "call",
    [
        lambda: fx.profiles.Spline(MASKED),
        lambda: fx.profiles.Spline([0.0, np.ma.masked, 0.1, 0.2]),
        lambda: fx.profiles.Fourier(MASKED, np.zeros(5)),
        lambda: fx.loads.PiecewiseLinear(np.arange(5.0), MASKED),
        lambda: fx.loads.PiecewiseLinear(masked(np.arange(5.0), 2), np.zeros(5)),
        lambda: fx.loads.Custom(jnp.sin, masked([1.0, 2.0], 1)),
        lambda: fx.loads.Sine(np.ma.array(1.0, mask=True), 3.0),
        lambda: fx.sweep(SCENE, masked([0.1, 0.05], 1), 1.0),
        lambda: fx.solve_limit(SCENE, masked([0.0, 0.1], 1)),
        lambda: fx.certify(SCENE, 0.1, 1.0, [0.0, 0.1], masked([0.0, 0.1], 1)),
        lambda: fx.certify(SCENE, 0.1, 1.0, [0.0, 0.1], [MASKED, MASKED]),
        lambda: fx.design_map(BRISTLE, ("angle", masked([0.1, 0.2], 0)), "height"),
        lambda: fx.Trace(np.arange(5.0), force=[MASKED, MASKED]),
    ],
)
def test_a_mask_is_never_dropped_without_a_word(call):
    with pytest.raises(ValueError, match=r"= a masked array \(\d+ of \d+ masked\): needs"):
        call()


ALL = np.ones(400, bool)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: fx.profiles.Spline(MASKED), "4 or more heights, .*, none of them masked"),
        (
            lambda: fx.profiles.Spline.smoothed(MASKED, 0.5),
            r"\(1 of 5 masked\).*none of them",
        ),
        (
            lambda: fx.profiles.Polyline(np.arange(5.0) / 5, MASKED, 0.01),
            r"of x, none of them masked",
        ),
        (lambda: fx.loads.PiecewiseLinear(np.arange(5.0), MASKED), "none of them masked"),
        (lambda: fx.profiles.Fourier(np.zeros(5), MASKED), "none of them masked"),
        (
            lambda: fx.profiles.Fourier.from_heights(X, masked(HEIGHTS, ALL)),
            "heights = '400 of 400 masked': needs 8 or more samples that are not",
        ),
        (
            lambda: fx.profiles.Fourier.from_heights(
                X, np.ma.array([HEIGHTS] * 2, mask=[~ALL, ALL])
            ),
            "heights, row 1 = '400 of 400 masked': needs 8 or more",
        ),
        (
            lambda: fx.Trace(X, force=masked(HEIGHTS, ALL)),
            "trace.ts = '0 times, 400 masked': needs 4 or more times",
        ),
        (
            lambda: fx.profiles.Fourier.from_heights(X[:5], HEIGHTS[:5]),
            "x = '5 positions': needs 8 or more",
        ),
    ],
)
def test_what_is_missing_is_said(call, message):
    with pytest.raises(ValueError, match=message):
        call()


def test_masks_that_hide_nothing_are_arrays():
    values = np.ma.array([0.0, 0.01, 0.0, -0.01])
    assert known_numbers(values).tolist() == values.tolist()
    assert np.allclose(fx.profiles.Spline(values).heights, values.data)
    assert without_masked(values, None, 0.1)[1] == 0


SURFACE, BRISTLE = fx.profiles.Sine(0.1), fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 0.5)
SPRING, LOAD = fx.supports.Spring(1.0), fx.loads.Ramp(1.0)
SCENE = fx.Scene(SURFACE, BRISTLE, SPRING, LOAD, 0.3)
NUMBERS = {
    "duration": lambda v: fx.Scene(SURFACE, BRISTLE, SPRING, LOAD, v),
    "z0": lambda v: fx.Scene(SURFACE, BRISTLE, SPRING, LOAD, 1.0, v),
    "support.stiffness": fx.supports.Spring,
    "profile.slope": fx.profiles.Sine,
    "profile.cos": lambda v: fx.profiles.Fourier([v, 0.1], [0.1, 0.1]),
    "profile.heights": lambda v: fx.profiles.Spline([0.0, v, 0.0, 0.2]),
    "alpha": fx.bristles.Homothetic,
    "angle": lambda v: fx.bristles.SlantedSpring(1.0, 2.4, 1.0, v),
    "rest_angle": lambda v: fx.bristles.AngularSpring(1.0, 2.0, 1.0, v),
    "rest_length": lambda v: fx.bristles.VerticalSpring(1.0, v, 0.5),
    "load.rate": fx.loads.Ramp,
    "load.period": lambda v: fx.loads.Sine(1.0, v),
    "load.amplitude": lambda v: fx.loads.Triangle(v, 1.0),
    "load.times": lambda v: fx.loads.PiecewiseLinear([0.0, v], [0.0, 1.0]),
    "load.values": lambda v: fx.loads.PiecewiseLinear([0.0, 1.0], [v, 0.5]),
    "load.turning_points": lambda v: fx.loads.Custom(jnp.sin, [v, 2.0]),
    "period": lambda v: fx.profiles.Fourier.from_heights(X, HEIGHTS, v),
    "eps": lambda v: fx.certify(SCENE, v, 1.0, [0.0, 0.1], [0.0, 0.0]),
    "gamma": lambda v: fx.solve(SCENE, 0.1, v),
    "accuracy": lambda v: fx.solve(SCENE, 0.1, accuracy=v),
    "ts": lambda v: fx.solve_limit(SCENE, [0.0, v]),
    "budget": lambda v: fx.fit_budget(SCENE, [0.1], 1.0, v),
    "size": lambda v: fx.steady_slide(SURFACE, BRISTLE, 0.01, rate=v),
    "noise": lambda v: fx.simulate_trace(SCENE, 0.1, noise=v),
}


@pytest.mark.parametrize("name", NUMBERS)
@pytest.mark.parametrize("truth", [True, np.True_])
def test_a_truth_is_no_number(name, truth):
    with pytest.raises(ValueError, match=r"= .*True.*: needs|= 'none admissible'"):
        NUMBERS[name](truth)


@pytest.mark.parametrize("dtype", [np.int64, np.int32, np.uint8])
def test_whole_numbers_of_numpy_are_whole_numbers(dtype):
    found = fx.profiles.Fourier.from_heights(X, HEIGHTS, harmonics=dtype(2))
    assert found.profile.cos.shape == (2,)
    assert fx.profiles.Custom(lambda y: jnp.sin(2 * jnp.pi * y), dtype(64)).points == 64
    assert (
        fx.GivenPotential(lambda Y: jnp.sin(2 * jnp.pi * Y), points=dtype(64)).points == 64
    )
    assert as_real(dtype(2)).dtype == float
    require_whole("starts", dtype(2))


@pytest.mark.parametrize("value", [True, np.True_, 2.0, "2", None, np.float64(2), [2]])
@pytest.mark.parametrize(
    ("name", "call"),
    [
        ("harmonics", lambda v: fx.profiles.Fourier.from_heights(X, HEIGHTS, None, v)),
        ("profile.points", lambda v: fx.profiles.Custom(jnp.sin, v)),
        ("potential.points", lambda v: fx.GivenPotential(jnp.sin, points=v)),
        ("samples", lambda v: fx.tolerance(SURFACE, BRISTLE, {"angle": 0.1}, samples=v)),
        ("seed", lambda v: fx.simulate_trace(SCENE, 0.1, seed=v)),
        ("max_steps", lambda v: fx.solve(SCENE, 0.1, max_steps=v)),
        ("starts", lambda v: fx.fit_profile(fx.Target(BRISTLE, 0.1, -0.1), starts=v)),
    ],
)
def test_what_is_no_whole_number_is_named(name, call, value):
    with pytest.raises(ValueError, match=rf"{name} = .*: needs a whole number >= \d"):
        call(value)


DATA = sweep_like(failed=False)
SELECTED = {
    "gamma by value": DATA.sel(gamma=1.0),
    "gamma by place": DATA.isel(gamma=1),
    "gamma by place, and a run": DATA.assign_coords(run=3).isel(gamma=1),
    "gamma as a list": DATA.sel(gamma=[1.0]),
    "the last time": DATA.isel(gamma=1, time=-1),
}


@pytest.mark.parametrize("name", SELECTED)
def test_a_data_set_of_which_one_gamma_was_selected_is_studied(name):
    expected = fx.study(DATA).orders.sel(gamma=[1.0])
    found = fx.study(SELECTED[name]).orders
    for variable in ("order", "order_low", "order_high", "constant", "C0"):
        assert found[variable].values == pytest.approx(expected[variable].values)
    assert found.gamma.values.tolist() == [1.0]


def test_a_data_set_of_which_one_eps_was_selected_is_studied():
    found = fx.study(DATA.isel(eps=2))
    assert found.dataset.sup_error.dims == ("eps", "gamma")
    assert np.all(np.isnan(found.orders.order))
    assert fx.study(DATA.isel(eps=2, gamma=0)).orders.gamma.values.tolist() == [0.5]


def test_a_selected_gamma_is_drawn():
    one = DATA.sel(gamma=1.0)
    assert fx.plot.draw_convergence(one, fx.study(one).orders).axes
    assert fx.plot.draw_trajectories(one).axes


@pytest.mark.parametrize("name", ["gamma", "eps", "time"])
def test_a_value_that_was_dropped_is_asked_for(name):
    with pytest.raises(ValueError, match=rf"one without the coordinate {name}'.*drop=True"):
        fx.study(DATA.isel({name: 0}, drop=True))


@pytest.mark.parametrize(
    "ts",
    [
        np.arange(4) * 0.1,
        [0.0, 3 * 0.1],
        np.cumsum(np.full(3000, 1e-4)) * (1 + 1e-13),
        [-1e-17, 0.1],
        jnp.arange(4) * 0.1,
    ],
)
def test_times_that_exceed_the_duration_by_rounding_are_accepted(ts):
    given, found = np.asarray(ts), np.asarray(require_times(SCENE, ts))
    assert found[0] >= 0
    assert found[-1] <= 0.3
    assert np.max(np.abs(found - given)) < 1e-12
    assert np.all(np.isfinite(fx.solve_limit(SCENE, ts).z))


@pytest.mark.parametrize("ts", [[0.0, 0.3 + 1e-12], [-1e-12, 0.1], [0.0, 0.31]])
def test_times_that_exceed_it_by_more_are_not(ts):
    with pytest.raises(ValueError, match=r"ts = .*: needs times in \[0, duration\]"):
        require_times(SCENE, ts)
    with pytest.raises(ValueError, match=r"ts = .*: needs times in \[0, duration\]"):
        fx.certify(SCENE, 0.1, 1.0, ts, [0.0, 0.0])


def test_a_curve_that_ends_by_rounding_after_the_duration_is_certified():
    ts = np.linspace(0.0, 1.0, 7) * (3 * 0.1)
    assert ts[-1] > 0.3
    found = fx.certify(SCENE, 0.1, 1.0, ts, np.full(7, np.nan))
    assert found.status.name == "NOT_FINITE"
