"""A moving picture from the shell."""

import jax
import pytest
from command_line import error_line, run
from PIL import Image

import frictionjax as fx
from frictionjax.report import movie

HOMOTHETIC = fx.Scene(
    fx.profiles.Sine(0.1),
    fx.bristles.Homothetic(1.0),
    fx.supports.Spring(1.0),
    fx.loads.Triangle(1.1, 4.0),
    4.0,
)


@pytest.mark.slow  # rods that turn over, at an eps
def test_a_movie_of_a_rod_that_turns_over(tmp_path, monkeypatch):
    monkeypatch.setattr(movie, "_FRAMES", 3)
    monkeypatch.setattr(movie, "_TIMES", 301)
    run("scenes", "nap-flip", "--out", tmp_path / "mine.toml")
    path = tmp_path / "turns.gif"
    told = run("nap", tmp_path / "mine.toml", "--movie", path, "--eps", 0.08).stdout
    assert f"Written to {path}: 3 frames, eps = 0.08 m, gamma = 1; forces go up to" in told
    assert "turns over, and friction is rho_with and rho_flipped" in told
    with Image.open(path) as gif:
        assert gif.n_frames == 3


def test_the_eps_whose_slips_can_be_told_apart():
    # The limit goes from -1 to 1.
    assert movie._seen_best(HOMOTHETIC, [0.5, 0.1, 0.05, 0.01]) == [0.1, 0.05]
    assert movie._seen_best(HOMOTHETIC, [0.01, 0.001]) == [0.01]
    still = HOMOTHETIC.replace(load=fx.loads.Triangle(0.05, 4.0))
    assert movie._seen_best(still, [0.01, 0.1]) == [0.1]


def test_of_those_the_first_whose_forces_are_near_the_limits():
    """At gamma = 1 drag adds more than half of rho at eps = 0.1, little at 0.02."""
    eps, _, beyond = movie._nearest(HOMOTHETIC, [0.1, 0.02], 1.0)
    assert (eps, beyond <= 0.2) == (0.02, True)
    eps, found, beyond = movie._nearest(HOMOTHETIC, [0.1], 1.0)
    assert (eps, beyond > 0.2) == (0.1, True)
    eps, _, nearest = movie._nearest(HOMOTHETIC, [0.2, 0.1], 1.0)
    assert (eps, nearest) == (0.1, beyond)  # else the nearest
    load = jax.vmap(HOMOTHETIC.load)(found.ts)
    assert beyond == pytest.approx(float(abs(load - found.z).max()) / 0.1 - 1.0, rel=1e-9)


def test_a_movie_may_go_into_the_folder_that_is_made(tmp_path, monkeypatch):
    made = tmp_path / "one" / "out"
    assert movie.require_gif(made / "m.gif", made) == made / "m.gif"
    with pytest.raises(ValueError, match="needs a file in a folder"):
        movie.require_gif(made / "further" / "m.gif", made)
    there = []

    def written(job, bending_stiffness, eps, path):
        there.append(path.parent.is_dir())
        return f"{path}"

    monkeypatch.setattr("frictionjax.report.write_movie", written)
    run("nap", "--bristle", "angular", "--out", made, "--movie", made / "m.gif")
    assert there == [True]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--movie", "x.mp4"], "movie = 'x.mp4': needs a file named *.gif"),
        (["--movie", "none/x.gif"], "movie = 'none/x.gif': needs a file in a folder"),
        (["--eps", "0.1"], "--eps: needs --movie FILE.gif beside it"),
    ],
)
def test_what_is_refused(arguments, message):
    assert message in error_line(run("nap", *arguments))
