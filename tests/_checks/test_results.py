"""All results tell by the same three names whether they can be trusted, how, and why."""

import jax
import numpy as np
import pytest

from frictionjax._checks.results import CodedResult, Result
from frictionjax._checks.status_enums import Outcome
from frictionjax.certificate.certification import Certificate, CertificateStatus
from frictionjax.coefficients import Coefficients
from frictionjax.design.bristle.result import AngleFit
from frictionjax.design.slide.bristle_fit import SlideFit
from frictionjax.design.slide.check import DesignCheck
from frictionjax.design.slide.slide_friction import SteadySlide
from frictionjax.design.slide.surface_fit import SlideProfileFit
from frictionjax.design.surface.result import ProfileFit
from frictionjax.design.trace.result import TraceFit
from frictionjax.limit.play import LimitSolution
from frictionjax.wiggly import Solution

DESIGNS = [AngleFit, ProfileFit, SlideFit, SlideProfileFit, TraceFit]
BATCHED = [Solution, LimitSolution, SteadySlide, DesignCheck, AngleFit]
KINDS = [*DESIGNS, *BATCHED[:-1], Certificate]


class Weather(Outcome):
    OK = 0, "it is dry"
    FOG = 1, "nothing is seen"
    RAIN = 2, "it is wet"


class Day(CodedResult):
    _outcomes, _good = Weather, (Weather.OK, Weather.FOG)

    def __init__(self, codes):
        self.codes = np.asarray(codes)

    @property
    def _codes(self):
        return self.codes

    def _in_words(self):
        return f"Day({self._ended})"


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.__name__)
def test_a_result_is_one(kind):
    assert issubclass(kind, Result)
    assert issubclass(kind, CodedResult) == (kind in BATCHED)
    for name in ("ok", "message"):
        assert getattr(kind, name).__doc__
    assert hasattr(kind, "document") == hasattr(kind, "to_json") == (kind in DESIGNS)


@pytest.mark.parametrize(
    ("codes", "ok", "message"),
    [
        (0, True, "it is dry"),
        (1, True, "nothing is seen"),
        (2, False, "it is wet"),
        ([0, 2], [True, False], ["it is dry", "it is wet"]),
        ([[1], [2]], [[True], [False]], [["nothing is seen"], ["it is wet"]]),
        (np.zeros(0, dtype=int), [], []),
    ],
)
def test_several_outcomes_may_be_good(codes, ok, message):
    day = Day(codes)
    assert np.array_equal(day.ok, ok)
    assert isinstance(day.ok, bool) == (np.ndim(codes) == 0)
    assert day.message == message
    assert np.array_equal(day.status, np.asarray(codes))


def test_a_certificate_is_still_a_tuple():
    found = Certificate(*range(10), CertificateStatus.OFF)
    assert (found.ok, found.message) == (False, CertificateStatus.OFF.message)
    *numbers, status = found._replace(status=CertificateStatus.OK)
    assert numbers == list(range(10))
    assert status == CertificateStatus.OK
    assert repr(found).startswith("Certificate(residual=0, residual_error=1, ")
    assert repr(found).endswith(f", status=OFF: {CertificateStatus.OFF.message})")
    assert "residual=0.333333, " in repr(found._replace(residual=1 / 3))
    assert not hasattr(found, "__dict__")


@pytest.mark.parametrize("result", ["limit", "coefficients", "solution"])
def test_results_without_numbers_show_what_stands_for_them(result):
    zeros, counts = np.zeros(3), {"steps": 0, "rejected": 0, "tolerance": 0.1}
    made = {
        "limit": LimitSolution(zeros, zeros, zeros),
        "coefficients": Coefficients(np.ones(()), -np.ones(())),
        "solution": Solution(zeros, zeros, None, None, np.asarray(0), counts, "by hand"),
    }[result]
    shapes = jax.eval_shape(lambda: jax.tree.map(jax.numpy.asarray, made))
    assert "ShapeDtypeStruct(shape=(" in repr(shapes)
    assert "=None" in repr(jax.tree.map(lambda _: None, made))
    with pytest.raises(ValueError, match="known numbers"):
        shapes.table()
