"""`fx.explore` itself: what it refuses."""

import sys

import pytest

import frictionjax as fx


def test_the_extra_is_named_where_it_is_missing(monkeypatch):
    monkeypatch.setitem(sys.modules, "anywidget", None)
    monkeypatch.delitem(sys.modules, "frictionjax.explore.widget", raising=False)
    with pytest.raises(ValueError, match=r'pip install "frictionjax\[notebooks\]"'):
        fx.explore()


def test_a_page_does_not_begin_with_what_is_not_allowed():
    with pytest.raises(ValueError, match="angle = 'steep': needs a number"):
        fx.explore(angle="steep")
    with pytest.raises(ValueError, match=r"bristle\.angle = 1\.3: needs omega_plus"):
        fx.explore(angle=1.3, slope=0.5)
