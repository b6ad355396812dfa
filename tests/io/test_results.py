"""Results as JSON: what is written, what is read, and documents of earlier versions."""

import json
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import frictionjax as fx
from frictionjax._checks.status_enums import Outcome
from frictionjax.design.bristle.inverse import PulledParts
from frictionjax.design.bristle.result import AngleFit
from frictionjax.design.common.design_result import DesignResult
from frictionjax.design.common.quantities import Slopes
from frictionjax.io.results import (
    ARRAY,
    AS_IS,
    BOOLS,
    CODES,
    INTEGERS,
    LEAF,
    NUMBER,
    PART,
    TOLD,
    Document,
    Form,
    by_name,
    nested,
    record,
    several,
)

NAN, INF = float("nan"), float("inf")
SLANTED = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0)


class Ended(Outcome):
    OK = 0, "fine"
    LOST = 1, "not fine"


class Pair(NamedTuple):
    left: object
    right: object = None


class Thing(DesignResult):
    document = Document(
        "things.Thing",
        {"message": TOLD, "status": by_name(Ended), "size": NUMBER}
        | {"pair": record(Pair, Pair._fields, ARRAY), "note": AS_IS.or_else(lambda _: "")},
    )

    def __init__(self, status, size, pair, note="said"):
        self.status, self.size, self.pair, self.note = status, size, pair, note


def through(form, value, infinite=True):
    """Written as JSON, and read."""
    text = json.dumps(Document("k", {"value": form}, infinite).entries(Pair2(value)))
    return Document("k", {"value": form}).parse(text)["value"]


class Pair2(NamedTuple):
    value: object


@pytest.mark.parametrize(
    ("form", "value"),
    [
        (NUMBER, 0.1),
        (NUMBER, 3),
        (NUMBER, NAN),
        (NUMBER, -INF),
        (ARRAY, np.array([[0.1, NAN], [INF, -INF]])),
        (LEAF, jnp.array([1 / 3, NAN])),
        (LEAF, jnp.asarray(2.0)),
        (INTEGERS, np.array([3, 4])),
        (CODES, jnp.asarray(7)),
        (BOOLS, np.array([True, False])),
        (AS_IS, {"a": 1.0, "b": None}),
        (by_name(Ended), Ended.LOST),
        (several(NUMBER), (1.0, 2.0)),
        (several(by_name(Ended)), ()),
        (record(Pair, Pair._fields, ARRAY, right=AS_IS), Pair(np.ones(2), "text")),
        (record(Pair, Pair._fields, NUMBER), Pair(1.5)),
    ],
)
def test_forms_give_back_what_they_were_given(form, value):
    found = through(form, value)
    assert type(found) is type(value) or np.shape(value) == ()
    if isinstance(value, Pair):
        assert found.right == value.right
        found, value = found.left, value.left
    if isinstance(value, dict | Ended):
        assert found == value
    else:
        assert np.asarray(found).dtype == np.asarray(value).dtype
        np.testing.assert_array_equal(found, value)


def test_infinity_is_a_text_or_null():
    assert through(NUMBER, INF) == INF
    assert np.isnan(through(NUMBER, INF, infinite=False))
    assert np.isnan(through(ARRAY, (1.0, -INF), infinite=False)[1])


def test_a_result_in_a_result():
    outer = Document("things.Box", {"things": several(nested(Thing))})
    one = Thing(Ended.LOST, 2.0, Pair(np.ones(3)))
    entries = outer.entries(type("Box", (), {"things": (one, one)}))
    assert entries["things"][0]["kind"] == "things.Thing"
    again = outer.fields(entries)["things"][1]
    assert (again.status, again.size, again.ok) == (Ended.LOST, 2.0, False)
    entries["things"][1]["kind"] = "things.Other"
    with pytest.raises(ValueError, match=r"needs JSON with kind = 'things\.Thing'"):
        outer.fields(entries)


def test_what_only_people_are_told_is_not_needed_and_absent_entries_have_their_value():
    text = Thing(Ended.OK, 1.0, Pair(np.ones(1))).to_json()
    entries = json.loads(text)
    assert list(entries) == ["kind", "message", "status", "size", "pair", "note"]
    del entries["message"], entries["note"]
    again = Thing.from_json(json.dumps(entries))
    assert again.success
    assert again.note == ""
    assert again.to_json() == text.replace('"said"', '""')


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"kind": "things.Box"}, "source = 'another document'"),
        ({"status": "GONE"}, "source: not a whole fit .*GONE"),
        ({"pair": 3}, "source: not a whole fit"),
        ({"pair": {"right": [1.0]}}, "source: not a whole fit .*left"),
        ({"size": "wide"}, "could not convert string to float: 'wide'"),
    ],
)
def test_documents_that_are_none_are_refused(change, said):
    entries = json.loads(Thing(Ended.OK, 1.0, Pair(np.ones(1))).to_json()) | change
    with pytest.raises(ValueError, match=said):
        Thing.from_json(json.dumps(entries))


def angle_fit(shape=()):
    one, ends = jnp.ones(shape), jnp.array([[0.5, 1.5], [NAN, NAN]])
    roots = jnp.ones((*shape, 2))
    codes, pulled = jnp.zeros(shape, dtype=int), PulledParts(NAN * one, NAN * one)
    slopes = Slopes(jnp.asarray(0.1), jnp.asarray(-0.1))
    numbers = one, 2 * one, 3 * one, 2 * one, roots, ends, ends / 0.0
    parts = codes, pulled, slopes, fx.profiles.Sine(0.1)
    bristle = jax.tree.map(lambda leaf: leaf * one, SLANTED)
    return AngleFit(bristle, *numbers, *parts, "angle", "ratio", False)


TEXT = """{
 "kind": "frictionjax.AngleFit",
 "message": "ratio = 2: found, angle = 1 (2 solutions)",
 "value": 1.0,
 "achieved": 2.0,
 "target": 2.0,
 "roots": [
  1.0,
  1.0
 ],
 "admissible": [
  [
   0.5,
   1.5
  ],
  [
   null,
   null
  ]
 ],
 "reachable": [
  [
   "inf",
   "inf"
  ],
  [
   null,
   null
  ]
 ],
 "free": "angle",
 "quantity": "ratio",
 "code": 0,
 "alpha": 3.0,
 "pulling": false,
 "pulled": {
  "value": null,
  "alpha": null
 },
 "bristle": {
  "kind": "SlantedSpring",
  "stiffness": 1.0,
  "rest_length": 2.4,
  "height": 1.0,
  "angle": 1.0
 },
 "profile": {
  "kind": "Sine",
  "slope": 0.1
 },
 "slopes": {
  "plus": 0.1,
  "minus": -0.1
 }
}"""


def test_the_text_of_a_fit_stays_as_it_is():
    assert angle_fit().to_json() == TEXT
    assert AngleFit.from_json(TEXT).to_json() == TEXT


@pytest.mark.parametrize("shape", [(), (3,)])
def test_documents_of_earlier_versions_are_read(shape):
    """Before bristles that pull were told apart: they lack three entries."""
    entries = json.loads(angle_fit(shape).to_json())
    for name in ("alpha", "pulling", "pulled"):
        del entries[name]
    again = AngleFit.from_json(json.dumps(entries))
    assert again.pulling is True
    for unknown in (again.alpha, *again.pulled):
        assert unknown.shape == shape
        assert np.isnan(unknown).all()
    assert np.all(again.success)
    assert Form(read=None) == TOLD
    assert np.all(again.bristle.angle == through(PART, SLANTED).angle)
