"""Slides are followed all at once where those before need not be known."""

from types import SimpleNamespace

import numpy as np
import pytest
from paths import path_of

import frictionjax as fx
from frictionjax.model import tabulated_scene
from frictionjax.wiggly import batch as engine
from frictionjax.wiggly.limit_path import resting_ends as slow_ends
from frictionjax.wiggly.plan import planned
from frictionjax.wiggly.slip_map import fast_slides, onsets

SCENE = fx.Scene(
    fx.profiles.Sine(0.1),
    fx.bristles.VerticalSpring(1.0, 2.0, 1.0),
    fx.supports.Spring(1.0),
    fx.loads.Sine(1.0488, 3.0),
    3.0,
)
TIMES = np.linspace(0.0, 3.0, 41)


def solved(eps, method="windowed"):
    """Answers at gamma = 1/2, values only, and how often slides were followed."""
    followed = []
    follow = fast_slides.follow

    def spy(scene, slides, tail):
        followed.append(slides.eps)
        return follow(scene, slides, tail)

    cell = np.array([eps]), np.array([0.5]), TIMES, 1e-3
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(fast_slides, "follow", spy)
        found = engine.integrate_cells(SCENE, *cell, method, False, suprema=False)
    return found, followed


def none_at_once(finder):
    """A generator as `onsets._at_once`, which asks for nothing."""
    yield from ()
    return {}


@pytest.mark.parametrize(("eps", "calls"), [(2e-4, [3]), (6e-3, [1, 1, 1])])
def test_at_once_is_as_one_after_the_other(monkeypatch, eps, calls):
    """At 6e-3 slides end while they lag, and the next one waits for what they leave."""
    together, followed = solved(eps)
    assert [slides.size for slides in followed] == calls
    monkeypatch.setattr(onsets, "_at_once", none_at_once)
    ordered, followed = solved(eps)
    assert [slides.size for slides in followed] == [1, 1, 1]
    assert together.status == ordered.status == fx.Status.OK
    assert np.max(np.abs(together.z - ordered.z)) < 2e-5 * eps


def test_what_was_foreseen_is_found_again_where_the_slide_before_lags(monkeypatch):
    """A slide that ends fast: those found without it are not believed."""
    expected, _ = solved(6e-3)
    at_the_turn = slow_ends.SETTINGS._replace(end=0.0)  # where all slides are slow
    monkeypatch.setattr(slow_ends, "SETTINGS", at_the_turn)
    found, followed = solved(6e-3)
    assert [slides.size for slides in followed] == [3, 1, 1]
    assert np.max(np.abs(found.z - expected.z)) < 2e-5 * 6e-3


def test_few_slips_are_gone_through_by_one_lane():
    """From z0 through all of them: no bracket, whatever is remembered."""
    found, followed = solved(1e-2, "auto")
    assert followed == []
    assert np.all(found.how == 0)
    assert np.all(found.gap == 0.0)


def test_cells_without_fast_slides_run_beside_those_with():
    """Their values are as alone, in the order that was asked for."""
    eps, gamma = np.array([2e-4, 1e-2, 5e-4, 2e-2]), np.full(4, 0.5)
    both = engine.integrate_cells(SCENE, eps, gamma, TIMES, 1e-3, "auto", False)
    assert both.how.max(axis=1).tolist() == [2, 0, 2, 0]
    for i, one in enumerate(eps):
        alone = engine.integrate_cells(
            SCENE, eps[i : i + 1], gamma[:1], TIMES, 1e-3, "auto", False
        )
        assert np.max(np.abs(both.z[i] - alone.z[0])) < 1e-6 * one
        assert both.steps[i] == pytest.approx(alone.steps[0], rel=1e-2)
        assert both.tolerance[i] == pytest.approx(alone.tolerance[0])


def answered(asking, answer):
    """What a generator returns whose questions are answered."""
    try:
        wanted = next(asking)
        while True:
            wanted = asking.send(answer(wanted))
    except StopIteration as end:
        return end.value


@pytest.mark.parametrize("gap", [1e-3, 1.0])
def test_slides_are_found_from_answers_alone(gap):
    """Without any lane: tips where the path is, brackets that have closed or not."""
    eps = np.array([2e-4, 5e-4])
    path = path_of(SCENE)
    parts = eps, np.full(2, 0.5), TIMES.size, 1e-3, "windowed"
    ground = planned(tabulated_scene(SCENE, eps), path, *parts).ground
    folds = ground.folds
    finder = fast_slides.FastSlideFinder(
        scene=SCENE,
        path=path,
        eps=eps,
        viscosity=eps**0.5,
        lag=ground.lags[:, 0] / eps,
        folds={
            1.0: (np.asarray(folds.place_plus), np.asarray(folds.force_plus)),
            -1.0: (np.asarray(folds.place_minus), np.asarray(folds.force_minus)),
        },
        slow=np.zeros((2, path.direction.size), dtype=bool),
        tail=1e-4,
        accuracy=1e-3,
    )
    asked = []

    def answer(wanted):
        asked.append((wanted, [len(own) for own in wanted.known]))
        if isinstance(wanted, onsets.Measure):
            return [lambda: np.zeros(1)] * len(wanted.slides)
        states = path.states_at(wanted.stops)
        # Behind the edge, where the pull is a little beyond the fold.
        behind = 2e-2 * path.direction[path.piece_of(wanted.stops)]
        wells = (states - behind) / eps[wanted.cells]
        tips = np.floor(wells), np.mod(wells, 1.0)
        return fast_slides.FoundTips(*tips, np.full(wells.size, gap))

    found = answered(onsets.asking_for_slides(finder), answer)
    measured = [one for one, _ in asked if isinstance(one, onsets.Measure)]
    assert sum(len(one.slides) for one in measured) == sum(map(len, found))
    assert [len(own) > 1 for own in found] == [gap < 0.1] * 2
    # What is asked with is what was known then: nothing is written into it later.
    assert all([len(own) for own in one.known] == then for one, then in asked)


def test_tips_are_looked_at_where_the_slide_before_is_over():
    """At the path's touch they were still on their way: 6e6 steps a lane, for 5e4."""
    path = path_of(SCENE)
    pieces = np.flatnonzero(path.direction)[:3]
    touch = path.touch[pieces]

    def slide(sign, end):
        return SimpleNamespace(sign=sign, end=end)

    later, back = touch[1] + 0.1, path.direction[pieces[1]]
    known = fast_slides.none_known(4)
    known[0] = (slide(-back, later),)  # goes on beyond the path's touch
    known[1] = (slide(-back, touch[1] - 0.1),)  # is over before
    known[2] = (slide(back, later),)  # is the slide of that piece already
    cell, piece = np.array([3, 2, 1, 0]), np.full(4, pieces[1])
    over = onsets._over(SimpleNamespace(path=path), known, cell, piece)
    assert over.tolist() == [touch[1], touch[1], touch[1], later]
    assert (path.touch[pieces] == touch).all()  # its own are left alone
