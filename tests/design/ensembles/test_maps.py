"""Design maps: every cell is what a scalar call gives, and pictures show it."""

import io

import numpy as np
import pytest

import frictionjax as fx
from frictionjax.design.ensembles.maps import asymmetric_profile

SLANTED = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0)
ANGULAR = fx.bristles.AngularSpring(1.0, 2**0.5, 1.0, 0.3)
WAVES = fx.profiles.Fourier(cos=[0.01, 0.004], sin=[0.02, 0.0])


def check(cell, profile, make):
    """One cell against constructors and `friction`."""
    try:
        law = fx.friction(profile, make())
    except ValueError:
        assert not bool(cell["admissible"])
        assert np.isnan(cell["ratio"])
        return False
    assert bool(cell["admissible"])
    plus, minus = float(law.rho_plus), float(law.rho_minus)
    found = [float(cell[name]) for name in ("rho_plus", "rho_minus", "ratio", "alpha")]
    np.testing.assert_allclose(found, (plus, minus, -plus / minus, law.alpha), rtol=1e-10)
    assert float(cell["difference"]) == pytest.approx(plus + minus, abs=1e-12)
    contrast = (plus + minus) / (plus - minus)
    assert float(cell["contrast"]) == pytest.approx(contrast, abs=1e-10)
    return True


def test_cells_are_scalar_calls():
    rows, columns = [0.4, 1.0, 2.5], np.linspace(-1.5, 1.5, 9)
    axes = ("angle", columns), ("asymmetry", rows)
    data = fx.design_map(SLANTED, *axes, steepness=0.3, pulling=True)
    known = []
    for row in rows:
        for angle in columns:
            cell = data.sel(asymmetry=row, angle=angle)
            surface = asymmetric_profile(0.3, row)
            known.append(
                check(
                    cell,
                    surface,
                    lambda angle=angle: fx.bristles.SlantedSpring(1.0, 2.4, 1.0, angle),
                )
            )
    assert any(known)
    assert not all(known)
    assert data["ratio"].dims == ("asymmetry", "angle")


@pytest.mark.parametrize(
    ("bristle", "axis", "units", "meaning"),
    [
        (SLANTED, "angle", "rad", "from the vertical, positive where the tip is left"),
        (SLANTED, "stiffness", "N/m", "of the spring"),
        (ANGULAR, "angle", "rad", "angle of the rod from the vertical, theta_lim"),
        (ANGULAR, "length", "m", "of the rod"),
        (SLANTED, "steepness", "1", "(omega_plus - omega_minus)/2 of the surface"),
    ],
)
def test_axes_have_units_and_meanings(bristle, axis, units, meaning):
    values, beside = (axis, [0.9, 1.1]), ("asymmetry", [0.8, 1.25])
    data = fx.design_map(bristle, x=values, y=beside)
    assert data[axis].attrs["units"] == units
    assert data[axis].attrs["long_name"].startswith(meaning)
    assert data.asymmetry.attrs["units"] == "1"
    assert data.asymmetry.attrs["long_name"] == "omega_plus/|omega_minus| of the surface"


def test_two_numbers_of_a_bristle_on_a_surface():
    lengths, rests = [0.9, 1.05, 1.3, 40.0], [-1.0, 0.2, 0.9]
    data = fx.design_map(ANGULAR, ("length", lengths), ("rest_angle", rests), WAVES)
    known = [
        check(
            data.sel(length=length, rest_angle=rest),
            WAVES,
            lambda length=length, rest=rest: fx.bristles.AngularSpring(1, length, 1, rest),
        )
        for length in lengths
        for rest in rests
    ]
    assert any(known)
    assert not all(known)


def test_numbers_that_constructors_refuse_are_not_admissible():
    heights, rests = [-0.5, 0.0, 1.0], [-2.0, 2.4]  # formulas hold for all of these
    data = fx.design_map(SLANTED, ("height", heights), ("rest_length", rests), WAVES)
    expected = [[False, False, False], [False, False, True]]
    np.testing.assert_array_equal(data["admissible"], expected)
    np.testing.assert_array_equal(np.isfinite(data["rho_plus"]), expected)


@pytest.mark.parametrize("asymmetry", [0.2, 1.0, 4.0])
def test_the_family_of_surfaces_has_the_slopes_it_says(asymmetry):
    law = fx.friction(asymmetric_profile(0.3, asymmetry), fx.bristles.Homothetic(1.0))
    assert float(-law.omega_plus / law.omega_minus) == pytest.approx(asymmetry, rel=1e-11)
    assert float(law.omega_plus - law.omega_minus) == pytest.approx(0.6, rel=1e-11)


def test_pictures_show_the_numbers_and_what_is_not_admissible():
    data = fx.design_map(SLANTED, ("angle", np.linspace(-1.5, 1.5, 31)), pulling=True)
    figure = fx.plot.draw_design_map(data, ("ratio", "rho_plus"))
    figure.savefig(io.BytesIO(), format="png", dpi=40)
    ratio, rho = figure.axes[:2]
    shown = np.ma.filled(ratio.collections[0].get_array(), np.nan).reshape(121, 31)
    np.testing.assert_allclose(shown, np.log(data["ratio"]))
    plain = np.ma.filled(rho.collections[0].get_array(), np.nan).reshape(121, 31)
    np.testing.assert_allclose(plain, data["rho_plus"])
    texts = [text.get_text() for text in ratio.get_legend().get_texts()]
    assert texts[0] == "not admissible"
    assert texts[1].startswith("$\\alpha$ = 0")
    assert "angle of the bristle" in ratio.get_xlabel()
    assert ratio.get_yscale() == "log"
    with pytest.raises(ValueError, match="quantities = 'colour': needs one of ratio"):
        fx.plot.draw_design_map(data, "colour")


def test_normal_forces_are_coloured_where_bristles_may_press():
    """Those of bristles that pull, 12 N and less, took all the colours."""
    data = fx.design_map(SLANTED, ("angle", np.linspace(-1.5, 1.5, 31)))
    assert np.isfinite(data.alpha.where(data.pulls)).any()
    mesh = fx.plot.draw_design_map(data, "alpha").axes[0].collections[0]
    shown = np.ma.filled(mesh.get_array(), np.nan).reshape(121, 31)
    np.testing.assert_allclose(shown, data.alpha.where(data.admissible))
    assert mesh.norm.vmax <= float(data.alpha.max())


def mapped_cells(collection):
    """Lowest and highest x and y of each cell."""
    corners = np.array([path.vertices for path in collection.get_paths()])
    return np.concatenate([corners.min(axis=1), corners.max(axis=1)], axis=1)


def test_pictures_hatch_the_cells_that_are_not_admissible_and_no_others():
    rod = fx.bristles.AngularSpring(0.7, 1.3, 1.0, 0.25)
    axes = ("height", [1.0, 1.1, 1.2]), ("rest_angle", [0.0, 0.4, 0.6])
    data = fx.design_map(rod, *axes, WAVES)
    outside = ~data["admissible"].values & ~data["pulls"].values
    assert 0 < outside.sum() < outside.size
    axes = fx.plot.draw_design_map(data, "ratio").axes[0]
    hatched = next(one for one in axes.collections if one.get_hatch() == "////")
    across, up = [0.95, 1.05, 1.15, 1.25], [-0.2, 0.2, 0.5, 0.7]
    expected = [
        (across[j], up[i], across[j + 1], up[i + 1]) for i, j in np.argwhere(outside)
    ]
    np.testing.assert_allclose(mapped_cells(hatched), expected)


def test_cells_of_asymmetries_lie_about_their_values_on_a_logarithmic_axis():
    axes = ("angle", [0.2, 0.4]), ("asymmetry", [2.0, 0.5, 1.0])
    figure = fx.plot.draw_design_map(fx.design_map(SLANTED, *axes), "ratio")
    mesh = figure.axes[0].collections[0]
    corners = mesh.get_coordinates()
    np.testing.assert_allclose(corners[:, 0, 1], 2.0 ** np.array([-1.5, -0.5, 0.5, 1.5]))
    np.testing.assert_allclose(corners[0, :, 0], [0.1, 0.3, 0.5])
    assert np.all(np.diff(np.ma.filled(mesh.get_array()), axis=0) > 0)
    one = fx.design_map(SLANTED, ("angle", [0.2]), ("asymmetry", [1.0]))
    fx.plot.draw_design_map(one, "ratio").savefig(io.BytesIO(), format="png", dpi=40)


def test_a_map_of_slides_says_that_its_picture_is_of_the_limit():
    axes = ("angle", [0.2, 0.4]), ("asymmetry", [0.5, 1.0])
    titles = [
        fx.plot.draw_design_map(found, "ratio").axes[0].get_title(loc="left")
        for data in [fx.design_map(SLANTED, *axes)]
        for found in (data, data.assign_attrs(eps=0.05))
    ]
    assert [title.endswith("limit $\\epsilon \\to 0$") for title in titles] == [False, True]


def test_pictures_of_slides_show_those_that_can_be_trusted():
    axes = ("angle", [0.2, 0.4, 0.6]), ("asymmetry", [0.5, 1.0])
    data = fx.design_map(SLANTED, *axes, eps=0.05)
    data["status"][0, 1] = fx.Status.STEP_TOO_SMALL
    axes = fx.plot.draw_design_map(data, "mean_plus").axes[0]
    assert axes.get_title(loc="left").endswith("(N), $\\epsilon$ = 0.05 m")
    mesh, crossed = axes.collections[0], axes.collections[-1]
    shown = np.ma.filled(mesh.get_array(), np.nan)
    expected = data.mean_plus.where(data.status == 0).values
    np.testing.assert_array_equal(shown, expected)
    assert crossed.get_hatch() == "xxxx"
    np.testing.assert_allclose(mapped_cells(crossed), [(0.3, 0.5**1.5, 0.5, 0.5**0.5)])
    with pytest.raises(ValueError, match="quantities = 'peak': needs one of ratio,"):
        fx.plot.draw_design_map(data, "peak")


def test_a_map_on_which_nothing_is_admissible_is_drawn():
    steep = ("angle", [-1.4, -1.3]), ("asymmetry", [1.0, 2.0])
    data = fx.design_map(fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0), *steep)
    assert not data.admissible.any()
    axes = fx.plot.draw_design_map(data, "alpha").axes
    assert [one.get_hatch() for one in axes[0].collections] == ["////", "...."]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"x": "colour"}, "x = 'colour': needs one of .*angle, asymmetry, steepness"),
        ({"x": "height"}, "x = 'height': needs values of height"),
        ({"x": 3.0}, "x = '3.0': needs a name"),
        ({"y": "angle"}, "y = 'angle': needs another name than x"),
        ({"x": ("angle", [0.1, np.nan])}, "x values = .*needs finite angle"),
        ({"y": ("asymmetry", [-1.0])}, "y values = .*> 0 for surfaces"),
        ({"x": ("angle", [])}, "x values = .*needs numbers, shape"),
        ({"profile": WAVES}, "profile = 'Fourier': needs none beside asymmetry"),
        ({"y": ("height", [1.0])}, "profile = None: needs a surface, or asymmetry"),
        ({"steepness": -1.0}, "steepness = -1: needs steepness > 0"),
        ({"x": "steepness", "steepness": 0.3}, "steepness = 0.3: needs neither a profile"),
        ({"gamma": 0.5}, "gamma = 0.5: needs eps beside it"),
        ({"rate": [2.0]}, r"rate = \[2\.\]: needs eps beside it"),
        ({"support": fx.supports.Spring(2.0)}, "support = .*: needs eps beside it"),
        ({"bristle": None}, "bristle = .*: needs a part of frictionjax.bristles"),
        ({"bristle": WAVES}, "bristle = 'Fourier': needs a part of frictionjax.bristles"),
    ],
)
def test_wrong_arguments_are_named(change, words):
    with pytest.raises(ValueError, match=words):
        fx.design_map(**({"bristle": SLANTED} | change))
    with pytest.raises(ValueError, match="at most 512 harmonics"):
        asymmetric_profile(0.1, 1e9)


def test_maps_at_an_eps_hold_the_slides_of_all_designs():
    bristle = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0)
    axes = ("angle", np.array([-1.2, 0.6])), ("asymmetry", np.array([1.0]))
    data = fx.design_map(bristle, *axes, steepness=0.1, eps=1e-2, rate=0.5)
    assert data.attrs["eps"] == 1e-2
    assert data.mean_plus.attrs["units"] == "N"
    # Inadmissible: alpha < 0.
    assert np.all(data.status.sel(angle=-1.2) == int(fx.Status.NOT_TRIED))
    assert np.all(np.isnan(data.mean_plus.sel(angle=-1.2)))
    cell = data.sel(angle=0.6, asymmetry=1.0)
    parts = asymmetric_profile(0.1, 1.0), bristle.replace(angle=0.6)
    alone = fx.steady_slide(*parts, 1e-2, rate=0.5)
    for name in ("mean_plus", "mean_minus", "peak_plus", "peak_minus"):
        assert float(cell[name]) == pytest.approx(float(getattr(alone, name)), rel=1e-7)
    assert int(cell.status) == fx.Status.OK
    assert "mean_plus" not in fx.design_map(bristle, *axes, steepness=0.1)


def test_a_rod_too_short_for_an_eps_has_no_slide_there():
    """Its series goes on where the rod does not: 0 N and -inf, of another status."""
    rod = fx.bristles.AngularSpring(1.0, 1.01, 1.0, 0.1)
    axes = ("length", [1.01, 1.3]), ("asymmetry", [2.0])
    data = fx.design_map(rod, *axes, eps=0.35)
    assert bool(data.admissible.all())
    assert data.status.values.ravel().tolist() == [fx.Status.NOT_TRIED, fx.Status.OK]
    for name in ("mean_plus", "mean_minus", "peak_plus", "peak_minus"):
        assert np.isfinite(data[name].values.ravel()).tolist() == [False, True]
