"""Traces that no surface explains are told in a moment, by what is odd about them."""

import io
import time

import jax.numpy as jnp
import numpy as np
import pytest

import frictionjax as fx
from frictionjax.design.trace import fit as trace_fit
from frictionjax.design.trace.energy import scatter_of, seen_as, ways
from frictionjax.design.trace.gauss_newton import View
from frictionjax.design.trace.oddities import oddity_of
from frictionjax.design.trace.outliers import outliers_of
from frictionjax.design.trace.problem import trace_problem
from frictionjax.design.trace.report import _counted, _freedom
from frictionjax.design.trace.status import TraceStatus

EPS, LENGTH = 0.05, 6.0
SCENE = fx.Scene(
    fx.profiles.Sine(0.1),
    fx.bristles.Homothetic(1.0),
    fx.supports.Spring(1.0),
    fx.loads.Sine(1.0488, 3.0),
    LENGTH,
)
TIMES = np.linspace(0.01, 5.99, 300)


def load(ts, size=1.0488):
    return size * np.sin(2 * np.pi * ts / 3.0)


def states(ts, gamma=1.0, eps=EPS, step=5e-4, size=1.0488):
    """The scene's trajectory by Euler's method: no program to compile."""
    grid = np.arange(0, LENGTH + step, step)
    z = np.zeros(grid.size)
    for i, pull in enumerate(load(grid, size)[:-1]):
        force = pull - z[i] - 0.1 * np.cos(2 * np.pi * z[i] / eps)
        z[i + 1] = z[i] + step * force / eps**gamma
    return np.interp(ts, grid, z)


Z = states(TIMES)
FORCE = load(TIMES) - Z
SIZE = 0.5 * np.ptp(FORCE)


def noise(size, seed=0):
    return size * np.random.default_rng(seed).normal(size=TIMES.size)


def traced(values, uncertainty=None, ts=TIMES, quantity="force"):
    return fx.Trace(ts, **{quantity: values}, uncertainty=uncertainty)


def fitted(trace):
    return fx.fit_trace(trace, SCENE, EPS, harmonics=4)


def numbers_of(fit):
    """Every number that a fit reports, of itself and of its parts."""
    parts = {**vars(fit), "reduced_chi2": fit.reduced_chi2}
    parts |= fit.history._asdict() | fit.identifiability._asdict()
    kept = {k: v for k, v in parts.items() if isinstance(v, int | float | np.ndarray)}
    return kept | {"cos": np.asarray(fit.profile.cos), "sin": np.asarray(fit.profile.sin)}


ODD = {
    "mN": (1e3 * FORCE, 1.0, TraceStatus.WRONG_SCALE, "1000 times too large, as if in mN"),
    "mN, noisy": (
        *(1e3 * (FORCE + noise(5e-3)), None, TraceStatus.WRONG_SCALE),
        "1000 times too large, as if in mN",
    ),
    "uN": (1e6 * FORCE, None, TraceStatus.WRONG_SCALE, "1000000 times too large, as if in"),
    "kN": (1e-3 * FORCE, None, TraceStatus.WRONG_SCALE, "too small, as if in kN"),
    "flipped": (-FORCE, 1e-3, TraceStatus.WRONG_SIGN, "obeys with its sign turned round"),
    "flipped, noisy": (-FORCE + noise(2e-3), None, TraceStatus.WRONG_SIGN, "sign turned"),
    "flipped, in mN": (-1e3 * FORCE, None, TraceStatus.WRONG_SIGN, "round; force is 1000"),
    "noise as large": (FORCE + noise(SIZE), None, TraceStatus.NOISE, "scatter, noise of"),
    "noise, said so": (FORCE + noise(SIZE), SIZE, TraceStatus.NOISE, "by its uncertainty"),
    "noise, not said": (FORCE + noise(SIZE), 1e-3, TraceStatus.NOISE, "samples scatter"),
    "noise alone": (noise(SIZE), None, TraceStatus.NOISE, "scatter"),
    "nothing": (0 * FORCE, None, TraceStatus.NOISE, "a friction of 0 N"),
    "a constant": (0 * FORCE + 0.1, 1e-3, TraceStatus.IMPOSSIBLE, "gain energy over whole"),
    "an offset": (FORCE + 1.0, 1e-3, TraceStatus.IMPOSSIBLE, "gain energy over whole"),
    "an outlier": (
        *(np.where(np.arange(TIMES.size) == 150, 5.0, FORCE), 1e-3, TraceStatus.OUTLIERS),
        "force = 5 N at t = 3.01 s; masked (numpy.ma) they are left out",
    ),
    "two outliers in mN": (
        *(1e3 * np.where(np.isin(TIMES, TIMES[[50, 90]]), -0.9, FORCE), None),
        *(TraceStatus.WRONG_SCALE, "as if in mN"),
    ),
    "outliers, noisy": (
        np.where(np.isin(TIMES, TIMES[[0, 1, 180]]), 0.9, FORCE + noise(2e-3)),
        *(None, TraceStatus.OUTLIERS, "force = 0.9 N at t = 0.01 s, the first of 3"),
    ),
    "the load": (load(TIMES), None, TraceStatus.NO_SLIDE, "as if it were the load"),
    "the load, noisy": (
        *(load(TIMES) + noise(1e-3), 1e-3, TraceStatus.NO_SLIDE),
        "z is constant while the force changes by 2.1",
    ),
    "the load, with an offset": (
        *(load(TIMES) + 0.02, None, TraceStatus.NO_SLIDE),
        "as if it were the load",
    ),
    "too late": (np.roll(FORCE, 37), 1e-3, TraceStatus.IMPOSSIBLE, "start in time"),
}


@pytest.mark.parametrize("name", ODD)
def test_an_odd_trace_is_told_in_a_moment(name):
    values, uncertainty, status, said = ODD[name]
    began = time.perf_counter()
    fit = fitted(traced(values, uncertainty))
    assert time.perf_counter() - began < 10.0
    assert fit.status == status
    assert not fit.success
    assert said in fit.message
    assert fit.message.endswith("; no slope is determined")
    assert not fit.identifiability.determined.any()
    for key, value in numbers_of(fit).items():
        assert not np.any(np.isnan(value)), key
    assert np.isfinite(fit.reduced_chi2)
    assert "nan" not in repr(fit)


@pytest.mark.parametrize(
    ("factor", "status", "said"),
    [
        (1e3, TraceStatus.WRONG_SCALE, "z is 1000 times too large, as if in mm"),
        (-1.0, TraceStatus.WRONG_SIGN, "z obeys with its sign turned round"),
    ],
)
def test_positions_are_looked_at_too(factor, status, said):
    fit = fitted(traced(factor * Z, quantity="z"))
    assert fit.status == status
    assert said in fit.message


def test_what_is_odd_is_kept_in_json_and_drawn():
    fit = fitted(traced(-FORCE))
    again = type(fit).from_json(fit.to_json())
    assert again.message == fit.message
    assert repr(again) == repr(fit)
    fit.plot().savefig(io.BytesIO(), format="png", dpi=40)


@pytest.mark.parametrize("samples", [25, 75, 300, 1200])
@pytest.mark.parametrize("gamma", [0.5, 1.0])
@pytest.mark.parametrize("size", [0.0, 1e-3, 4e-3])
def test_traces_of_a_surface_are_not_odd(samples, gamma, size):
    """Also with several slips from one sample to the next."""
    ts = np.linspace(0.01, 5.99, samples)
    values = load(ts) - states(ts, gamma)
    values = values + size * np.random.default_rng(1).normal(size=samples)
    problem = trace_problem(traced(values, size or None, ts), SCENE, EPS, gamma, 4, 1e-3)
    assert oddity_of(traced(values, size or None, ts), problem) is None


def test_work_over_wells_is_what_viscosity_takes():
    """Of a path known exactly: a slide at constant speed under a force of its own."""
    ts = np.linspace(0, 1, 401)
    z = 10 * EPS * ts
    force = 0.3 + 0.1 * np.cos(2 * np.pi * z / EPS)
    work, length = ways(z, force, EPS)
    assert length == EPS
    np.testing.assert_allclose(work, 0.3 * EPS, rtol=1e-3)
    back, _ = ways(-z, force, EPS)
    np.testing.assert_allclose(back, -0.3 * EPS, rtol=1e-3)
    still, _ = ways(0 * z, force, EPS)
    assert still.size == 0


def test_scatter_is_that_of_one_sample():
    assert scatter_of(noise(0.2)) == pytest.approx(0.2, rel=0.15)
    assert scatter_of(3.0 + 2.0 * TIMES) == pytest.approx(0.0, abs=1e-12)


def odd(trace):
    return oddity_of(trace, trace_problem(trace, SCENE, EPS, 1.0, 4, 1e-3))


def test_a_few_samples_that_are_wrong_hide_no_wrong_sign():
    values = FORCE.copy()
    values[[50, 180]] += 1.0
    assert odd(traced(values, 1e-3)).status == TraceStatus.OUTLIERS
    assert odd(traced(-values, 1e-3)).status == TraceStatus.WRONG_SIGN
    values = np.ma.masked_array(values, np.isin(TIMES, TIMES[[50, 180]]))
    assert odd(traced(values, 1e-3)) is None


def test_outliers_are_far_from_their_neighbours_and_from_all_others():
    saw = np.tile([0.0, 1.0, 2.0, 3.0], 25)
    assert outliers_of(saw).size == 0
    assert outliers_of(np.zeros(9)).size == 0
    spike = np.append([5.0, 0.0], 0.1 * np.sin(np.arange(98.0)))
    spike[1] = 0.0
    assert outliers_of(spike, 0.0).tolist() == outliers_of(spike).tolist() == [0]
    far = saw.copy()
    far[[10, 11]] = 90.0, -70.0
    assert outliers_of(far).tolist() == [10, 11]
    knock = 30 * np.exp(-(((np.arange(100) - 50) / 4) ** 2))  # a peak of many samples
    assert outliers_of(saw + knock).size == 0


WEAK = 0.005  # N: nothing slides


@pytest.mark.parametrize("quantity", ["force", "z"])
@pytest.mark.parametrize("samples", [300, 3000])
def test_a_start_that_relaxes_into_its_well_is_no_outlier(quantity, samples):
    """z0 = 0 is between two wells, a quarter of eps from the next one."""
    ts = np.linspace(0.0, 5.98, samples)
    z = states(ts, step=2e-4, size=WEAK)
    values = z if quantity == "z" else load(ts, WEAK) - z
    scene = SCENE.replace(load=fx.loads.Sine(WEAK, 3.0))

    def found(values):
        trace = traced(values, None, ts, quantity)
        return oddity_of(trace, trace_problem(trace, scene, EPS, 1.0, 4, 1e-3))

    assert outliers_of(values).size
    assert found(values) is None or found(values).status == TraceStatus.NO_SLIDE
    wrong = values.copy()
    wrong[2] = 3 * values[-1]  # not on the way
    assert found(wrong).status == TraceStatus.OUTLIERS


def test_a_tip_that_falls_into_its_well_is_not_called_constant():
    """By half an eps, and slowly: forces change by more than the load does."""
    z = -0.5 * EPS * (1 - np.exp(-TIMES / 0.5))
    scene = SCENE.replace(load=fx.loads.Sine(WEAK, 3.0))
    trace = traced(load(TIMES, WEAK) - z, 1e-5)
    found = oddity_of(trace, trace_problem(trace, scene, EPS, 1.0, 4, 1e-3))
    assert found.status == TraceStatus.NO_SLIDE
    assert "z moves by 0.39 eps while the force changes by 0.029" in found.text
    assert "constant" not in found.text


FROM_ZERO = np.linspace(0.0, 5.98, 300)
FORCE_FROM_ZERO = load(FROM_ZERO) - states(FROM_ZERO)


@pytest.mark.parametrize("offset", [0.05, -0.05, 0.02, -0.1, 0.004, -0.002])
@pytest.mark.parametrize("size", [0.0, 1e-3])
def test_an_offset_is_told_by_where_the_trace_starts(offset, size):
    """Of whole wells too, which gain no energy."""
    found = odd(traced(FORCE_FROM_ZERO + offset + noise(size), size or None, FROM_ZERO))
    if abs(offset) < 0.1 * EPS:
        assert found is None
        return
    assert found.status == TraceStatus.IMPOSSIBLE
    if "gain" not in found.text:
        assert "at t = 0 s z is " in found.text
        assert "where the scene starts at 0 m, as with an offset of " in found.text
        assert "or another z0" in found.text


def test_another_start_is_told_by_its_position():
    trace = traced(states(FROM_ZERO), None, FROM_ZERO, "z")
    assert odd(trace) is None
    problem = trace_problem(trace, SCENE.replace(z0=0.05), EPS, 1.0, 4, 1e-3)
    assert "z is 0 m, where the scene starts at 0.05 m" in oddity_of(trace, problem).text


def test_a_tip_that_follows_the_force_in_its_well_is_not_odd():
    """The load stays below what a slide takes."""
    z = EPS * np.arcsin(load(TIMES) / 2) / (2 * np.pi)
    assert odd(traced(load(TIMES) - z, 1e-3)) is None
    assert odd(traced(load(TIMES) - z + noise(1e-3), 1e-3)) is None


def test_a_support_that_has_no_such_force_is_no_trace_in_another_unit():
    bounded = fx.supports.Convex(lambda z: jnp.sqrt(1 + z**2))  # |Phi'| < 1
    slow = fx.loads.Sine(0.8, 3.0)
    scene = fx.Scene(SCENE.profile, SCENE.bristle, bounded, slow, LENGTH)
    trace = traced(0.0 * FORCE, 1e-3)
    problem = trace_problem(trace, scene, EPS, 1.0, 4, 1e-3)
    assert not np.isfinite(seen_as(problem, traced(FORCE), 1e3).z).any()


@pytest.mark.parametrize(
    ("used", "clear", "counted"), [(9, 15, 9), (8, 15, 15), (3, 8, 20), (0, 0, 20)]
)
def test_chi2_is_of_more_samples_than_coefficients(used, clear, counted):
    """A fit with every sample in another well has a finite one, and a large one."""
    place = np.arange(20)
    rows = np.zeros(20), np.ones(20), np.ones(20), place < clear, place < used, place < 0
    some = _counted(View(*rows, 1.0), 8)
    assert np.sum(some) == counted
    assert _freedom(some, 8) == counted - 8
    assert _freedom(some[:4], 8) == 1


def test_no_descent_is_begun_after_so_many_steps(monkeypatch):
    """Descents made by hand: each takes a third of the steps, and explains nothing."""
    begun = []

    class Step:
        objective = 1.0

    class Found:
        steps = [Step]

        def _replace(self, drawn):
            return self

    def descend(seen, numbers, flow, programs, most, progress):
        begun.append(numbers)
        programs.run(numbers)
        return Found()

    class Flow:
        steps = 600_000

    class Problem:
        def run(self, numbers):
            return Flow

        read = admissible = held = staticmethod(lambda *_: None)
        observed = staticmethod(lambda: None)

    monkeypatch.setattr(trace_fit, "gauss_newton", descend)
    monkeypatch.setattr(trace_fit, "explains", lambda *_: False)
    monkeypatch.setattr(
        trace_fit, "_starts", lambda *_: [(None, i, None) for i in range(5)]
    )
    monkeypatch.setattr(trace_fit, "_drawn", lambda *_: iter(()))
    best, left = trace_fit._descent(None, Problem(), 8, 100, lambda step: None)
    assert begun == [0, 1, 2]
    assert isinstance(best, Found)
    assert left == "tried 3 of 8 starts, after 1.8e+06 steps"
