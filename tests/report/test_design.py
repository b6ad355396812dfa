"""`frictionjax design`: what it prints, what it writes, how it fails."""

import numpy as np
import pytest
from command_line import error_line, run
from html_pages import checked_page

import frictionjax as fx
from frictionjax.design.bristle.result import AngleFit
from frictionjax.design.common.heights import surface_heights
from frictionjax.design.surface.result import ProfileFit
from frictionjax.io.scene_files import default_study
from frictionjax.report.place import WRITTEN

WAVES = fx.profiles.Fourier(cos=[0.01, 0.004], sin=[0.02, 0.0])


def ratio_of(scene):
    law = fx.friction(scene)
    return float(-law.rho_plus / law.rho_minus)


def _require_told(page, files, angle):
    """What was asked for, what was found, read back, and the slides that show it."""
    assert "Asked for: ratio = 1.5. Found: a SlantedSpring with angle = " in page.text
    assert f"angle = {angle:.6g} rad gives ratio = 1.5." in page.text
    assert "of the file design.toml" in page.text
    assert "None of the 3 slides failed" in page.text
    assert "frictionjax design --ratio 1.5" in page.text
    assert files - {"report.html"} <= {link["href"] for link in page.of("a")}
    assert len(page.of("img")) == 4


def test_a_bristle_for_a_ratio(tmp_path):
    folder = tmp_path / "made" / "here"
    result = run(
        *("design", "--ratio", 1.5, "--period", 2e-4, "--samples", 128),
        *("--report", "--out", folder),
    )
    assert result.exit_code == 0, result.output
    names = {path.name for path in folder.iterdir()}
    assert names == {
        "report.html",
        "design.toml",
        "design.png",
        "map.png",
        "fit.json",
        "heights.csv",
        "tables.txt",
    }
    assert names <= WRITTEN
    fit = AngleFit.from_json(folder / "fit.json")
    assert float(fit.achieved) == pytest.approx(1.5, rel=1e-12)
    scene = fx.load_scene(folder / "design.toml")
    assert ratio_of(scene) == pytest.approx(1.5, rel=1e-12)
    before = default_study().scene
    assert scene.bristle.height == before.bristle.height
    assert float(scene.duration) == float(before.duration)
    page = checked_page((folder / "report.html").read_text(encoding="utf-8"))
    _require_told(page, names, float(scene.bristle.angle))
    assert "the dot is the design found" in page.text
    assert "The surface found" not in page.text
    lines = {line.split("  ")[0]: line for line in result.stdout.splitlines()}
    assert "1.5" in lines["achieved"]
    assert f"{float(scene.bristle.angle):.8g}"[:8] in lines["angle"]
    assert "(0.641801, 1.55811)" in lines["reachable"]
    assert "Steady slide, gamma = 1" in result.stdout
    assert result.stdout.startswith((folder / "tables.txt").read_text().rstrip("\n"))
    rows = np.loadtxt(folder / "heights.csv", delimiter=",", skiprows=1)
    assert (folder / "heights.csv").read_text().startswith("x_m,height_m\n")
    assert rows.shape == (129, 2)
    x, height = rows.T
    np.testing.assert_allclose(x, np.linspace(0, 2e-4, 129), rtol=1e-12)
    # The default surface: slope 0.1, so a sine of amplitude 0.1 period/(2 pi).
    size = 0.1 * 2e-4 / (2 * np.pi)
    np.testing.assert_allclose(
        height, size * (1 + np.sin(2 * np.pi * x / 2e-4)), atol=1e-15
    )


@pytest.mark.slow
def test_a_surface_for_both_directions(tmp_path):
    folder = tmp_path / "surface"
    asked = ("--rho-plus", 0.12, "--rho-minus", -0.05, "--harmonics", 8)
    result = run("design", *asked, "--out", folder)
    assert result.exit_code == 0, result.output
    names = {path.name for path in folder.iterdir()}
    assert names == {"design.toml", "design.png", "fit.json", "heights.csv", "tables.txt"}
    scene = fx.load_scene(folder / "design.toml")
    law = fx.friction(scene)
    assert float(law.rho_plus) == pytest.approx(0.12, rel=1e-6)
    assert float(law.rho_minus) == pytest.approx(-0.05, rel=1e-6)
    assert scene.profile.cos.shape == (8,)
    x, height = np.loadtxt(folder / "heights.csv", delimiter=",", skiprows=1).T
    slopes = np.gradient(height, x)
    found = (slopes.max(), slopes.min())
    np.testing.assert_allclose(found, (law.omega_plus, law.omega_minus), rtol=2e-3)


@pytest.mark.slow
def test_a_surface_within_bounds_and_its_rod(tmp_path):
    folder = tmp_path / "bounded"
    asked = ("--rho-plus", 0.12, "--rho-minus", -0.05, "--harmonics", 8)
    bounds = ("--free", "angle", "--bounds", 0.9, 1.3, "--smallest-radius", 0.4)
    result = run("design", *asked, *bounds, "--report", "--out", folder)
    assert result.exit_code == 0, result.output
    page = checked_page((folder / "report.html").read_text(encoding="utf-8"))
    assert "The surface found, and its slopes" in page.text
    assert "the dot is the design found" not in page.text
    scene = fx.load_scene(folder / "design.toml")
    law = fx.friction(scene)
    assert float(law.rho_plus) == pytest.approx(0.12, rel=1e-6)
    assert 0.9 < float(scene.bristle.angle) < 1.3
    assert float(scene.bristle.angle) != float(default_study().scene.bristle.angle)
    fit = ProfileFit.from_json(folder / "fit.json")
    assert fit.bounds["smallest_radius"] == 0.4
    assert fit.free["angle"] == pytest.approx(float(scene.bristle.angle), rel=1e-12)


def test_what_cannot_be_designed_is_said_in_one_line(tmp_path):
    out = ("--out", tmp_path / "none")
    line = error_line(run("design", "--bristle", "angular", "--ratio", 7, *out))
    assert "ratio = 7 cannot be reached by angle: ratio is in (0.51" in line
    line = error_line(run("design", "--ratio", 3, *out))
    assert "reached only by a bristle that pulls, angle = -1.3" in line
    assert "(--pulling in the shell) allows that" in line
    line = error_line(run("design", *out))
    assert "no target: needs one of --ratio" in line
    line = error_line(run("design", "--ratio", 1.2, "--rho-plus", 0.1, *out))
    assert "--ratio, --rho-plus: needs one of --ratio" in line
    line = error_line(run("design", "--ratio", 1.2, "--free", "colour", *out))
    assert "free = 'colour': needs one of stiffness" in line
    line = error_line(run("design", "--ratio", 1.3, "--period", -1, *out))
    assert "period = -1: needs period > 0" in line
    line = error_line(run("design", "--ratio", 1.3, "--samples", 15, *out))
    assert "samples = 15: needs a whole number >= 64 to resolve the surface" in line
    line = error_line(run("design", "--ratio", 1.3, "--bounds", 0.2, 0.1, *out))
    assert "bounds = [0.2 0.1]: needs a pair" in line
    line = error_line(run("design", "--ratio", 1.3, "--smallest-radius", 0.1, *out))
    assert "smallest_radius = 0.1: needs --rho-plus and --rho-minus together" in line
    both = ("--rho-plus", 0.1, "--rho-minus", -0.1)
    line = error_line(run("design", *both, "--bounds", 0.5, 1.1, *out))
    assert "bounds = [0.5 1.1]: needs --free as well" in line
    line = error_line(run("design", *both, "--free", "angle", *out))
    assert "bounds = None: needs --bounds LOW HIGH as well as --free" in line
    assert not (tmp_path / "none").exists()


def test_heights_that_do_not_resolve_the_surface_are_refused():
    with pytest.raises(ValueError, match=r"samples = 40: needs a whole number >= 64"):
        surface_heights(WAVES, 1e-3, 40)
    rows = surface_heights(WAVES, 1e-3, 64)
    assert rows[-1, 1] == rows[0, 1]
    assert rows[:, 1].min() == 0


def saved(folder, *effects):
    path = folder / "scene.toml"
    fx.save_scene(default_study().scene.replace(effects=effects), path)
    return path


@pytest.mark.slow
@pytest.mark.parametrize("wanted", [("--rho-minus", -0.15), ()], ids=["surface", "angle"])
def test_scenes_with_effects_are_designed_with_them(tmp_path, wanted):
    """Two bristles with supports of their own: each has half the friction asked for."""
    array = fx.effects.CompliantArray([0.0, 0.5])
    path, folder = saved(tmp_path, array), tmp_path / "made"
    result = run("design", path, "--rho-plus", 0.2, *wanted, "--out", folder)
    assert result.exit_code == 0, result.output
    assert "Friction coefficients of each bristle" in result.stdout
    slides = "Steady slide, gamma = 1, rate = 1 N/s, forces of all 2 bristles"
    assert slides in result.stdout
    assert not (folder / "map.png").exists()
    scene = fx.load_scene(folder / "design.toml")
    assert len(scene.effects) == 1
    assert float(fx.friction(scene).rho_plus) == pytest.approx(0.1, rel=1e-9)


def test_scenes_with_effects_that_designs_do_not_do_are_refused(tmp_path):
    path, folder = saved(tmp_path, fx.effects.Noise(1e-4)), tmp_path / "none"
    line = error_line(run("design", path, "--ratio", 1.5, "--out", folder))
    assert "does not do Noise: needs a design without it, and friction_curve" in line
    assert not (folder / "design.toml").exists()


def small_rod(folder, eps):
    """The embedded scene with a rod of 0.3 mm, which loses a surface of 0.01 m."""
    rod = fx.bristles.AngularSpring(3.7e-5, 3e-4, 1.5e-4, -0.31)
    path = folder / "small.toml"
    scene = default_study().scene.replace(bristle=rod)
    fx.save_scene(scene, path, None if eps is None else {"eps": eps, "gamma": [1.4, 0.8]})
    return path


@pytest.mark.parametrize(
    ("eps", "shown", "gamma"),
    [
        ([1e-1, 1e-4, 8e-5, 6e-5, 5e-5], ["0.0001", "8e-05", "5e-05"], "1.4"),
        (None, ["0.001", "0.0001"], "1"),
    ],
    ids=["of the file", "of no file"],
)
def test_designs_slide_at_eps_that_they_reach(tmp_path, eps, shown, gamma):
    path = small_rod(tmp_path, eps)
    result = run("design", path, "--ratio", 0.9, "--out", tmp_path / "made")
    assert result.exit_code == 0, result.output
    assert f"Steady slide, gamma = {gamma}, rate" in result.stdout
    table = result.stdout.partition("Steady slide")[2].splitlines()[2:]
    assert [line.split()[0] for line in table[: len(shown) + 1]] == [*shown, "limit"]
    assert (tmp_path / "made" / "design.toml").exists()


def test_designs_beyond_every_eps_are_written_without_a_slide(tmp_path):
    path, made = small_rod(tmp_path, [0.5, 0.3]), tmp_path / "made"
    result = run("design", path, "--ratio", 0.9, "--report", "--out", made)
    assert result.exit_code == 0, result.output
    said = "No slide: the bristle does not follow the surface, not even at eps = 0.3 m"
    assert said in result.stdout
    assert (made / "design.toml").exists()
    assert "No slide was computed" in (made / "report.html").read_text(encoding="utf-8")
