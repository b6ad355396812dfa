"""Requests that come faster than answers."""

import threading

import pytest

from frictionjax.explore.newest import NewestOnly

PATIENCE = 10  # s


def test_requests_that_are_overtaken_are_dropped():
    started, go, answered = threading.Event(), threading.Event(), []

    def answer(request):
        started.set()
        assert go.wait(PATIENCE)
        answered.append(request)

    newest = NewestOnly(answer)
    newest.ask([0])
    assert started.wait(PATIENCE)
    for request in range(1, 50):  # while the first one is being answered
        newest.ask([request])
    assert not answered  # whoever asks does not wait
    go.set()
    newest.wait()
    assert answered == [0, 49]
    assert newest.dropped == 48


def test_several_at_once_are_answered_in_their_order():
    started, go, answered = threading.Event(), threading.Event(), []

    def answer(request):
        answered.append(request)
        started.set()
        assert go.wait(PATIENCE)

    newest = NewestOnly(answer)
    newest.ask([0, 1, 2])
    assert started.wait(PATIENCE)
    newest.ask([3, 4])
    go.set()
    newest.wait()
    assert answered == [0, 3, 4]
    assert newest.dropped == 2


def test_nothing_in_place_of_all_that_waits():
    started, go, answered = threading.Event(), threading.Event(), []

    def answer(request):
        answered.append(request)
        started.set()
        assert go.wait(PATIENCE)

    newest = NewestOnly(answer)
    newest.ask([0, 1])
    assert started.wait(PATIENCE)
    newest.ask([])
    go.set()
    newest.wait()
    newest.ask([])  # at rest
    newest.wait()
    assert answered == [0]


def test_requests_after_a_rest_are_answered():
    answered = []
    newest = NewestOnly(answered.append)
    for request in range(5):
        newest.ask([request])
        newest.wait()
    assert answered == list(range(5))


@pytest.mark.filterwarnings("ignore::pytest.PytestUnhandledThreadExceptionWarning")
def test_an_answer_that_fails_is_not_the_last():
    answered = []

    def answer(request):
        if request == 0:
            raise RuntimeError("by the test")
        answered.append(request)

    newest = NewestOnly(answer)
    for request in (0, 1):
        newest.ask([request])
        newest.wait()
    assert answered == [1]
