"""Results show their numbers: all of them, with units, status first; batches by lines."""

import jax
import numpy as np
import pytest

import frictionjax as fx
from frictionjax._text import Named, ShownNumbers

SURFACE = fx.profiles.Sine(0.1)
BRISTLE = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0)
SCENE = fx.Scene(SURFACE, BRISTLE, fx.supports.Spring(1.0), fx.loads.Sine(1.0488, 3.0), 3.0)


def lines_of(result):
    return {row[0]: row[1:] for row in result.table().rows}


def test_a_solution():
    found = fx.solve(SCENE, 1e-2, 1.0, np.linspace(0.0, 3.0, 4))
    lines = lines_of(found)
    assert lines["status"] == ("OK", "", found.message)
    assert lines["time"][:2] == ("3", "s")
    assert float(lines["z"][0]) == pytest.approx(float(found.z[-1]), rel=1e-5)
    assert lines["dissipation"][1] == "J"
    assert not {"velocity", "root", "mode", "beta"} & set(lines)
    assert found.message in found._repr_html_()


def test_a_limit_and_a_certificate():
    ts = np.linspace(0.0, 3.0, 31)
    limit = fx.solve_limit(SCENE, ts)
    lines = lines_of(limit)
    assert float(lines["z"][0]) == pytest.approx(float(limit.z[-1]), rel=1e-5)
    found = fx.certify(SCENE, 0.05, 1.0, ts, np.full(31, np.nan))
    assert lines_of(found)["status"][0] == "NOT_FINITE"
    assert lines_of(found)["slips"][0] == "0"


def test_a_batch_has_a_line_for_each():
    targets = np.array([1.3, 1.4, 9.0])
    found = fx.fit_angle(SURFACE, BRISTLE, ratio=targets)
    table = found.table()
    assert table.header[:3] == ("", "status", "angle/rad")
    assert [row[3] for row in table.rows] == ["1.3", "1.4", "9"]
    assert [row[1] for row in table.rows] == [status.name for status in found.status]
    assert len({row[1] for row in table.rows}) == 2
    one = lines_of(found[0])
    assert float(one["angle"][0]) == pytest.approx(float(found.value[0]), rel=1e-5)
    assert one["alpha"][1] == "N"


class Many(ShownNumbers):
    def __init__(self, value):
        self.value, self.status = value, np.array([fx.Status.OK] * value.size, object)

    def _numbers(self):
        return [Named("force", self.value, "N"), Named("nothing", None)]


def test_long_batches_say_what_they_leave_out():
    table = Many(np.arange(50.0)).table()
    assert table.header == ("", "status", "force/N")
    assert len(table.rows) == 40
    assert repr(table).endswith("10 more, not shown")


def test_a_trace_has_no_table():
    def seen(angle):
        with pytest.raises(ValueError, match="needs known numbers"):
            fx.fit_angle(SURFACE, BRISTLE, ratio=angle).table()
        return angle

    jax.jit(seen)(1.3)
