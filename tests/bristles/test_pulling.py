"""Bristles press: designs that pull are returned where they are asked for, and named."""

import json

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from command_line import run

import frictionjax as fx
from frictionjax.bristles.pulling import pulling_note
from frictionjax.coefficients import coefficient_table
from frictionjax.design.bristle.inverse import RootBrackets, _pressing_alike
from frictionjax.design.bristle.status import FitStatus
from frictionjax.design.common.free_numbers import free_parameter, require_bounds
from frictionjax.design.slide import bristle_fit as slide_fit
from frictionjax.design.slide.bristle_fit import SlideFit
from frictionjax.design.slide.slide_friction import SteadySlide
from frictionjax.report.job import read_job

SINE = fx.profiles.Sine(0.1)
SLANTED = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0)
SWAPPED = fx.bristles.VerticalSpring(1.0, 1.0, 2.0)
PULLING = fx.bristles.Homothetic(-1.0)
BETWEEN = np.arccos(1 / 2.4)  # angles at which SLANTED presses are nearer to 0


def alpha_of(bristle):
    return float(fx.friction(SINE, bristle).alpha)


@pytest.mark.parametrize(
    "wanted", [{"ratio": 2.0}, {"ratio": 0.1}, {"rho_plus": 3.8}, {"rho_minus": -3.8}]
)
def test_a_target_that_only_pulling_reaches_is_not_met(wanted):
    found = fx.fit_angle(SINE, SLANTED, **wanted)
    assert found.status == FitStatus.PULLS
    assert not found.success
    assert found.solutions.size == 0
    assert found.alpha >= 0
    assert abs(found.value) <= BETWEEN + 1e-12
    assert np.nanmax(np.abs(found.admissible)) == pytest.approx(BETWEEN, rel=1e-12)
    allowed = fx.fit_angle(SINE, SLANTED, pulling=True, **wanted)
    assert allowed.success
    assert allowed.alpha == pytest.approx(alpha_of(allowed.bristle), rel=1e-12)
    assert allowed.alpha < 0
    assert found.pulled.value == pytest.approx(float(allowed.value), rel=1e-12)
    assert found.pulled.alpha == pytest.approx(float(allowed.alpha), rel=1e-12)
    assert "is reached only by a bristle that pulls, angle = " in found.message
    assert f"alpha = {float(allowed.alpha):.6g} N: pulling=True" in found.message
    assert "with bristles that press " in found.message
    assert "N < 0: the bristle pulls on the surface" in allowed.message
    again = type(found).from_json(found.to_json())
    assert again.message == found.message
    assert not again.pulling


@pytest.mark.parametrize("rho_plus", [0.003, 0.05, 0.153])
def test_every_solution_presses(rho_plus):
    found = fx.fit_angle(SINE, SLANTED, rho_plus=rho_plus)
    both = fx.fit_angle(SINE, SLANTED, rho_plus=rho_plus, pulling=True)
    assert found.success
    assert both.solutions.size > found.solutions.size > 0
    for value in np.asarray(both.solutions):
        alpha = alpha_of(fx.bristles.SlantedSpring(1.0, 2.4, 1.0, value))
        assert (value in found.solutions) == (alpha > 0)


def test_a_root_where_alpha_has_another_sign_than_around_it_is_none():
    """Between two nodes of an interval alpha may dip below 0 unseen."""
    there = jnp.array([[True, True, False]])
    sides, none = jnp.array([[1.0, 1.0, 1.0]]), jnp.zeros((1, 3))
    parts = none, none, there, there, there, sides, jnp.array([2]), none, none, none
    found = _pressing_alike(RootBrackets(*parts), jnp.array([[0.3, -0.1, jnp.nan]]))
    assert found.there.tolist() == [[True, False, False]]
    assert found.number.tolist() == [1]


def test_a_batch_and_a_compiled_call_say_the_same_as_single_ones():
    targets = np.array([1.2, 2.0, 0.1, 1.5])
    batch = fx.fit_angle(SINE, SLANTED, ratio=targets)
    lanes = [fx.fit_angle(SINE, SLANTED, ratio=target) for target in targets]
    assert batch.message == [lane.message for lane in lanes]
    assert [bool(good) for good in batch.success] == [True, False, False, True]
    np.testing.assert_allclose(batch.alpha, [lane.alpha for lane in lanes], rtol=1e-12)


@pytest.mark.slow
def test_a_traced_call_has_the_status_of_a_known_one():
    found = jax.jit(jax.vmap(lambda one: fx.fit_angle(SINE, SLANTED, ratio=one)))(
        jnp.array([1.2, 2.0])
    )
    assert found.code.tolist() == [int(FitStatus.OK), int(FitStatus.PULLS)]
    assert found.pulled.alpha[1] == pytest.approx(-3.758866, rel=1e-6)


def test_a_number_that_cannot_make_it_press():
    with pytest.raises(ValueError, match="every admissible one pulls") as error:
        fx.fit_angle(SINE, SWAPPED, rho_plus=0.05, free="stiffness")
    assert "rest_length = 1 and height = 2 look swapped" in str(error.value)
    allowed = fx.fit_angle(SINE, SWAPPED, rho_plus=0.05, free="stiffness", pulling=True)
    assert allowed.value == pytest.approx(0.5, rel=1e-12)
    assert "rest_length = 1 and height = 2 look swapped" in allowed.message


@pytest.mark.slow
@pytest.mark.parametrize(
    ("bristle", "free", "value"),
    [(SWAPPED, "height", 0.5), (SWAPPED, "rest_length", 2.5), (PULLING, "alpha", 0.5)],
)
def test_a_number_that_makes_it_press(bristle, free, value):
    found = fx.fit_angle(SINE, bristle, rho_plus=0.05, free=free)
    assert found.success
    assert found.value == pytest.approx(value, rel=1e-12)
    assert found.solutions.size == 1
    assert found.alpha == pytest.approx(0.5, rel=1e-12)


@pytest.mark.parametrize(
    ("bounds", "words"),
    [
        ((-2.0, 2.0), r"bounds = \[-2.  2.\]: needs a part of \(-1.5708, 1.5708\), where"),
        ((0.5, 1.6), r"bounds = \[0.5 1.6\]: needs a part of \(-1.5708, 1.5708\)"),
        ((-1.7, 0.5), r"bounds = \[-1.7  0.5\]: needs a part of"),
        ((1.48, 1.5), r"\(-1.14102, 1.14102\), where angle has alpha > 0 .* none is adm"),
        ((1.2, 1.4), r"1.14102\), .*pulls, alpha < 0, angle in \(1.2, 1.4\): pulling=True"),
        ((0.5, 0.5), r"bounds = \[0.5 0.5\]: needs a pair \(low, high\)"),
        ((0.5, np.inf), "needs a pair"),
        ((0.1, 0.2, 0.3), "needs a pair"),
    ],
)
def test_bounds_outside_the_range_are_named(bounds, words):
    with pytest.raises(ValueError, match=words):
        fx.fit_angle(SINE, SLANTED, ratio=1.2, bounds=bounds)


def test_bounds_of_a_rod_are_within_its_length():
    rod = fx.bristles.AngularSpring(1.0, 1.25, 1.0, 0.3)
    for free, bounds, allowed in (
        ("height", (0.5, 3.0), r"\(0, 1.25\)"),
        ("length", (0.5, 3.0), r"\(1, inf\)"),
        ("angle", (-0.5, 1.0), r"\(0, 1.5708\)"),
        ("stiffness", (-1.0, 1.0), r"\(0, inf\)"),
    ):
        with pytest.raises(ValueError, match=f"needs a part of {allowed}, where {free}"):
            fx.fit_angle(SINE, rod, rho_plus=0.01, free=free, bounds=bounds)
    with pytest.raises(ValueError, match="pulling = 'no': needs True or False"):
        fx.fit_angle(SINE, rod, ratio=0.9, pulling="no")


QUARTER = 0.5 * np.pi


@pytest.mark.parametrize("bounds", [(-QUARTER, QUARTER), (0, np.nextafter(QUARTER, 2))])
def test_a_quarter_turn_to_rounding_is_a_bound(bounds):
    require_bounds(free_parameter(SLANTED, "angle"), SLANTED, bounds)


@pytest.mark.parametrize("beyond", [1.5708, 1.570797, QUARTER + 1e-12, -1.5708])
def test_a_bound_beyond_a_quarter_turn_is_named_with_its_digits(beyond):
    """1.5708 is not pi/2, and looks like it with six digits."""
    words = r"needs a part of \(-1.57079632679, 1.57079632679\)"
    with pytest.raises(ValueError, match=words):
        fx.fit_angle(SINE, SLANTED, ratio=1.2, bounds=sorted([0.1, beyond]))


def test_maps_leave_out_what_pulls_and_say_so():
    angles = np.array([-1.3, 0.5, 1.3, 1.55])
    axes = ("angle", angles), ("steepness", [0.1, 0.2])
    data = fx.design_map(SLANTED, *axes)
    presses, pulls = [0, 1, 0, 0], [1, 0, 1, 0]
    np.testing.assert_array_equal(data["admissible"][0], presses)
    np.testing.assert_array_equal(data["pulls"][0], pulls)
    np.testing.assert_array_equal(np.isfinite(data["ratio"][0]), presses)
    assert (data["alpha"].values[0][[0, 2]] < 0).all()
    assert data.attrs["pulling"].startswith("no: bristles that would pull (alpha < 0)")
    shown = fx.design_map(SLANTED, *axes, pulling=True)
    np.testing.assert_array_equal(shown["admissible"][0], [1, 1, 1, 0])
    np.testing.assert_array_equal(shown["pulls"], data["pulls"])
    assert shown.attrs["pulling"].startswith("yes")
    figure = fx.plot.draw_design_map(data, "ratio")
    texts = [text.get_text() for text in figure.axes[0].get_legend().get_texts()]
    assert "$\\alpha$ < 0: the bristle pulls" in texts


@pytest.mark.parametrize(
    ("bristle", "words"),
    [
        (SWAPPED, "rest_length = 1 and height = 2 look swapped; pulling=True"),
        (PULLING, "target.bristle: needs alpha > 0, but alpha = -1 N < 0"),
        (fx.bristles.SlantedSpring(1.0, 1.0, 2.4, 0.5), "look swapped"),
    ],
)
def test_surfaces_are_not_designed_for_bristles_that_pull(bristle, words):
    target = fx.Target(bristle, 0.1, -0.1)
    with pytest.raises(ValueError, match=words):
        fx.fit_profile(target)
    with pytest.raises(ValueError, match=words):
        fx.fit_slide_profile(target, 1e-2)
    several = [fx.Target(SLANTED, 0.1, -0.1), target]
    with pytest.raises(ValueError, match=r"targets\[1\].bristle: needs alpha > 0"):
        fx.fit_profile(several)


def test_surfaces_for_bristles_that_pull_are_told_so():
    fit = fx.fit_profile(fx.Target(SWAPPED, 0.1, -0.1), pulling=True)
    assert fit.success
    assert "alpha = -1 N < 0: the bristle pulls on the surface; rest_length" in repr(fit)
    with pytest.raises(ValueError, match="pulling = 1: needs True or False"):
        fx.fit_profile(fx.Target(SWAPPED, 0.1, -0.1), pulling=1)


def test_slides_are_of_bristles_that_press(monkeypatch):
    """The scan made by hand: where it looks, and what is said of the limit."""
    looked = []

    def quantities(free, bristle, profile, asked, places):
        looked.append(places)
        return 1.0 + 0.3 * places

    one = np.ones(())
    slide = SteadySlide(np.asarray(1e-2), one, -one, one, -one, 0 * one, 0 * one)

    def alone(free, bristle, profile, asked, x):
        return slide_fit._Slide(1.0 + 0.3 * x, 0.3 * one, one, x, slide)

    def follows(free, bristle, profile, places, eps):
        return np.full(places.size, True)

    for name, fn in (("_quantities", quantities), ("_alone", alone), ("_follows", follows)):
        monkeypatch.setattr(slide_fit, name, fn)
    found = fx.fit_slide(SINE, SLANTED, 1e-2, ratio=2.0)
    assert found.status == FitStatus.UNREACHABLE
    assert found.limit.status == FitStatus.PULLS
    assert "in the limit: ratio = 2 is reached only by a bristle that pulls" in repr(found)
    assert np.max(np.abs(np.concatenate(looked))) <= BETWEEN
    assert SlideFit.from_json(found.to_json()).message == found.message
    looked.clear()
    allowed = fx.fit_slide(SINE, SLANTED, 1e-2, ratio=1.4, pulling=True)
    assert np.max(np.abs(np.concatenate(looked))) > BETWEEN
    assert "N < 0: the bristle pulls" in allowed.message


def test_a_normal_force_below_zero_is_said_wherever_it_is_shown():
    law = fx.friction(SINE, SWAPPED)
    assert repr(law).endswith("alpha = -1 N < 0: the bristle pulls on the surface)")
    assert str(coefficient_table(law)).splitlines()[-1] == (
        "(alpha = -1 N < 0: the bristle pulls on the surface)"
    )
    pressing = fx.friction(SINE, fx.bristles.VerticalSpring(1.0, 2.0, 1.0))
    for text in (repr(pressing), str(coefficient_table(pressing))):
        assert "pulls" not in text


@pytest.mark.parametrize(
    ("bristle", "pulls", "swapped"),
    [
        (SWAPPED, True, True),
        (fx.bristles.SlantedSpring(1.0, 1.0, 2.4, 0.5), True, True),
        (fx.bristles.SlantedSpring(1.0, 1.0, 1.1, 1.0), True, False),  # too slanted
        (PULLING, True, False),
        (fx.bristles.VerticalSpring(1.0, 2.0, 1.0), False, False),
    ],
)
def test_lengths_that_look_swapped(bristle, pulls, swapped):
    note = pulling_note(bristle)
    assert note.startswith(f"alpha = {alpha_of(bristle):.6g} N < 0: ") == pulls
    assert ("look swapped" in note) == swapped
    assert bool(note) == pulls


SCENE = fx.Scene(SINE, SWAPPED, fx.supports.Spring(1.0), fx.loads.Sine(1.0, 3.0), 3.0)


def test_a_scene_says_that_its_bristle_pulls():
    said = "): alpha = -1 N < 0: the bristle pulls on the surface"
    assert repr(SCENE).endswith(said)
    assert repr(SCENE.replace(duration=1.0)).endswith(said)
    presses = fx.bristles.VerticalSpring(1.0, 2.0, 1.0)
    for scene in (
        SCENE.replace(bristle=presses),
        jax.tree.map(lambda leaf: jnp.stack([leaf]), SCENE),
    ):
        assert "pulls" not in repr(scene)
    with jax.check_tracer_leaks(), pytest.MonkeyPatch.context() as patch:
        patch.setattr(jax, "jit", None)  # nothing is compiled
        patch.setattr(jax, "grad", None)
        assert repr(SCENE).endswith(said)


def test_json_of_the_shell_says_it_too(tmp_path):
    fx.save_scene(SCENE, tmp_path / "scene.toml")
    numbers = json.loads(run("friction", tmp_path / "scene.toml", "--json").stdout)
    assert numbers["pulling"] is True
    assert numbers["alpha"] == -1.0
    assert len(numbers["notes"]) == 1
    assert numbers["notes"][0].startswith("Note: alpha = -1 N < 0: the bristle pulls")
    numbers = json.loads(run("friction", "--json").stdout)
    assert numbers["pulling"] is False
    assert "notes" not in numbers


def test_the_command_line_says_it_before_its_tables(tmp_path):
    fx.save_scene(SCENE, tmp_path / "scene.toml")
    (note,) = read_job(str(tmp_path / "scene.toml")).notes
    assert note.startswith("Note: alpha = -1 N < 0: the bristle pulls")
    assert note.endswith("rest_length = 1 and height = 2 look swapped")
    assert read_job(None).notes == []
