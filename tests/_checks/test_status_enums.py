"""Results say how they ended: one of them, a batch, or a traced one."""

import warnings

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import frictionjax as fx
from frictionjax._checks import as_jax
from frictionjax._checks.status_enums import counted
from frictionjax.coefficients import Coefficients
from frictionjax.design.bristle.inverse import PulledParts
from frictionjax.design.bristle.result import AngleFit
from frictionjax.design.bristle.status import FitStatus
from frictionjax.design.slide.check import DesignCheck
from frictionjax.design.slide.slide_friction import SteadySlide
from frictionjax.limit.play import LimitSolution, LimitStatus
from frictionjax.wiggly import Solution
from frictionjax.wiggly.equation.status import FailedCells, warn_of_failed

SINE = fx.profiles.Sine(0.1)
BAD = int(fx.Status.MAX_STEPS)


def full(shape, value):
    """`jnp.full`, uncompiled."""
    return as_jax(np.full(shape, value))


def solution(codes):
    codes = jnp.asarray(codes)
    z, steps = full((*codes.shape, 3), 0.0), full(codes.shape, 7)
    return Solution(z, z, None, None, codes, {"steps": steps}, "by hand")


def limit(codes):
    by = jnp if isinstance(codes, jax.core.Tracer) else np
    z = jnp.asarray(by.where(by.asarray(codes)[..., None] == 0, np.zeros(3), np.nan))
    return LimitSolution(z, z, z)


def slide(codes):
    codes = jnp.asarray(codes)
    force = full(codes.shape, 1.0)
    return SteadySlide(force, force, force, force, force, codes, full(codes.shape, 0))


def angle_fit(codes):
    by = jnp if isinstance(codes, jax.core.Tracer) else np
    codes = jnp.asarray(by.where(codes == 0, 0, int(FitStatus.INADMISSIBLE)))
    one, ends = full(codes.shape, 1.0), full((1, 2), 1.0)
    roots = full((*codes.shape, 1), 1.0)
    known = one, one, one, one, roots, ends, ends, codes, PulledParts(one, one)
    return AngleFit(None, *known, None, None, "angle", "ratio")


KINDS = {
    solution: (fx.Status, "MAX_STEPS"),
    limit: (LimitStatus, "NOT_FINITE"),
    slide: (fx.Status, "MAX_STEPS"),
    angle_fit: (FitStatus, "INADMISSIBLE"),
}


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("codes", [0, BAD, [0, 0], [0, BAD, 0, 0], [[0, BAD], [0, 0]], []])
def test_a_result_shows_itself_alone_and_in_a_batch(kind, codes):
    statuses, name = KINDS[kind]
    codes, result = np.asarray(codes, dtype=int), kind(np.asarray(codes, dtype=int))
    failed = statuses[name]
    if codes.ndim == 0:
        assert result.ok is (int(codes) == 0)
        assert result.status is (failed if codes else statuses.OK)
        assert result.status.message in result.message
    else:
        assert np.array_equal(result.ok, codes == 0)
        expected = [failed if code else statuses.OK for code in codes.ravel()]
        assert result.status.ravel().tolist() == expected
        told = np.array(result.message, dtype=object).reshape(codes.shape)
        both = zip(result.status.ravel(), told.ravel(), strict=True)
        assert all(status.message in text for status, text in both)
        assert f"{int(np.sum(codes == 0))} of {codes.size} OK" in repr(result)
        assert (name in repr(result)) is bool(codes.any())
    assert len(repr(result)) < 200


@pytest.mark.parametrize("kind", KINDS)
def test_a_traced_result_shows_itself(kind):
    def run(codes):
        result = kind(codes)
        assert repr(result)
        assert result.message == ""
        return result.ok, result.status

    for codes in (jnp.asarray(BAD), jnp.asarray([0, BAD])):
        flags, found = jax.jit(run)(codes)
        assert np.array_equal(flags, codes == 0)
        assert np.array_equal(found == 0, codes == 0)


def law(alpha):
    return fx.friction(SINE, fx.bristles.Homothetic(alpha))


def check(codes):
    shape = jnp.shape(codes)[:-1]
    one = jnp.ones(shape)
    return DesignCheck(Coefficients(one, -one, one), slide(codes), one, one)


@pytest.mark.parametrize(
    ("alphas", "said"),
    [
        ([1.0, 2.0], "Coefficients(batch (2,): rho_plus=[0.1 0.2], "),
        ([1.0, -2.0], "alpha < 0 in 1 of 2: the bristle pulls on the surface)"),
        ([-1.0, -2.0, -3.0], "alpha < 0 in 3 of 3: the bristle pulls on the surface)"),
        ([], "Coefficients(batch (0,): "),
    ],
)
def test_coefficients_show_themselves_in_a_batch(alphas, said):
    single = law(1.0)
    some = jax.tree.map(lambda one: jnp.asarray(alphas) * one, single)
    text = repr(some)
    assert said in text
    assert ("pulls" in text) == any(alpha < 0 for alpha in alphas)
    pairs = jax.tree.map(lambda one: jnp.ones((2, 2)) * one, single)
    assert repr(pairs).startswith("Coefficients(batch (2, 2): ")


@pytest.mark.parametrize("transform", [jax.vmap, lambda fn: jax.jit(jax.vmap(fn))])
def test_friction_of_a_batch_shows_itself(transform):
    def one(alpha):
        found = law(alpha)
        assert repr(found)
        return found

    found = transform(one)(jnp.array([1.0, -1.0]))
    assert "alpha < 0 in 1 of 2" in repr(found)


def test_designs_checked_in_a_batch_show_themselves():
    assert repr(check(jnp.zeros((1,), int))).startswith("Steady slide, gamma = 1")
    batch = repr(check(jnp.array([[0, BAD], [0, 0]])))
    assert batch.startswith("DesignCheck(batch (2,): SteadySlide(")
    assert "3 of 4 OK, 1 MAX_STEPS" in batch


def test_outcomes_are_counted():
    assert counted(fx.Status, np.asarray(3)) == "NOT_FINITE"
    assert counted(fx.Status, [0, 0, 3, 1, 3]) == "2 of 5 OK, 1 MAX_STEPS, 2 NOT_FINITE"
    assert counted(fx.Status, [1, 1]) == "0 of 2 OK, 2 MAX_STEPS"


def test_failed_cells_are_one_warning_that_names_the_first():
    gamma, eps = np.array([0.5, 1.0]), np.array([0.1, 0.01, 0.001])
    codes = np.zeros((2, 3), dtype=np.int8)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warn_of_failed(codes, gamma, eps)
    codes[1, 2] = BAD
    one = r"^1 of 6 cells failed \(gamma = 1, eps = 0\.001: MAX_STEPS\), .* raise max_steps"
    with pytest.warns(FailedCells, match=one):
        warn_of_failed(codes, gamma, eps)
    with pytest.warns(UserWarning, match="^6 of 6 cells failed .* and 2 more"):
        warn_of_failed(np.full((2, 3), BAD), gamma, eps)
