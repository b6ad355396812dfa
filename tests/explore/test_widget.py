"""What the page sends to the browser, and what it does with what it hears."""

import threading

import numpy as np
import pytest

import frictionjax as fx
from frictionjax.explore import widget as widgets
from frictionjax.explore.explored import explored_at
from frictionjax.explore.setting import PageSetting

PATIENCE = 10  # s


@pytest.fixture
def page():
    opened = fx.explore()
    yield opened
    opened.close()


def hear(page, wait=True, **changed):
    """As the browser sends it."""
    hear_of(page, [changed], wait)


def hear_of(page, places, wait=True):
    """Several places of the sliders in one message."""
    settings = [PageSetting()._replace(**changed)._asdict() for changed in places]
    page._handle_custom_msg({"view": "here", "settings": settings}, [])
    if wait:
        page._newest.wait()


def test_the_browser_gets_what_it_asked_for(page):
    hear(page, angle=-0.4, gamma=1.5)
    wanted = explored_at(PageSetting(angle=-0.4, gamma=1.5))
    assert page.arrays == wanted.packed()
    assert page.told["coefficients"] == wanted.coefficients
    assert page.told["view"] == "here"
    assert page.told["wells"] == wanted.wells.size
    assert page.told["times"] == wanted.ts.size
    assert (page.angle, page.gamma) == (-0.4, 1.5)


def test_arrays_and_what_is_told_of_them_come_in_one_message(page, monkeypatch):
    sent = []
    monkeypatch.setattr(page, "send_state", lambda key=None: sent.append(set(key)))
    assert page.comm is not None
    monkeypatch.setattr(type(page.comm), "kernel", True, raising=False)  # one listens
    hear(page, angle=-0.4)
    assert sent == [{"arrays", "told"}]


def test_python_moves_sliders_too(page):
    before = page.arrays
    page.slope = 0.2
    assert page.shown.setting == PageSetting(slope=0.2)
    assert page.arrays != before
    assert page.told["view"] == ""
    assert page.told["setting"]["slope"] == 0.2


def test_what_is_not_allowed_is_told_and_the_last_good_picture_stays(page):
    before = page.arrays
    hear(page, angle=1.3, slope=0.5)
    assert not page.told["ok"]
    assert page.status.startswith("bristle.angle = 1.3: needs omega_plus < cot(angle)")
    assert page.arrays == before
    assert page.told["eps"] == page.shown.setting.eps == PageSetting().eps
    assert page.angle == 1.3
    hear(page, angle=0.5)
    assert page.told["ok"]
    assert page.status == "every number can be trusted"


def test_numbers_that_cannot_be_trusted_are_not_drawn(page, monkeypatch):
    failed = explored_at(PageSetting(angle=0.1))._replace(status=fx.Status.MAX_STEPS)
    monkeypatch.setattr(widgets, "explored_at", lambda setting: failed)
    before = page.arrays
    hear(page, angle=0.1)
    assert not page.told["ok"]
    assert page.status == fx.Status.MAX_STEPS.message
    assert page.arrays == before


def test_a_slider_that_moves_on_is_not_answered_where_it_was(page, monkeypatch):
    started, go, solved = threading.Event(), threading.Event(), []

    def slowly(setting):
        solved.append(setting.angle)
        started.set()
        assert go.wait(PATIENCE)
        return explored_at(setting)

    monkeypatch.setattr(widgets, "explored_at", slowly)
    hear(page, wait=False, angle=0.0)
    assert started.wait(PATIENCE)
    for angle in np.linspace(0.1, 0.6, 6):
        hear(page, wait=False, angle=float(angle))
    go.set()
    page._newest.wait()
    assert solved == [0.0, 0.6]
    assert page.shown.setting.angle == 0.6


def test_all_places_of_a_message_are_answered_one_after_the_other(page):
    told = []
    page.observe(lambda change: told.append(change["new"]), names="told")
    hear_of(page, [{"angle": 0.1}, {"angle": 1.3, "slope": 0.5}, {"angle": 0.3}])
    assert [one["setting"]["angle"] for one in told] == [0.1, 1.3, 0.3]
    assert [one["ok"] for one in told] == [True, False, True]
    for one in told[::2]:
        wanted = explored_at(PageSetting(**one["setting"]))
        assert one["coefficients"] == wanted.coefficients
    assert page.arrays == explored_at(PageSetting(angle=0.3)).packed()


def test_where_sliders_were_before_python_moved_them_is_not_answered(page, monkeypatch):
    started, go, solved = threading.Event(), threading.Event(), []

    def slowly(setting):
        solved.append(setting.angle)
        started.set()
        assert go.wait(PATIENCE)
        return explored_at(setting)

    monkeypatch.setattr(widgets, "explored_at", slowly)
    hear_of(page, [{"angle": 0.1}, {"angle": 0.2}], wait=False)
    assert started.wait(PATIENCE)
    threading.Timer(0.1, go.set).start()
    page.angle = 0.9
    page._newest.wait()
    assert solved == [0.1, 0.9]
    assert page.shown.setting.angle == page.angle == 0.9


def test_readers_without_a_kernel_see_a_picture(page):
    data, _ = page._repr_mimebundle_()
    assert "application/vnd.jupyter.widget-view+json" in data
    assert data["image/png"].startswith("iVBORw0KGgo")  # a PNG in base64
    assert data["text/plain"].startswith("ExplorePage(angle=0.5, slope=0.1")
