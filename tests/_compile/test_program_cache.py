"""Programs in a folder: the same answers, fetched only where they are the same program."""

from pathlib import Path

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest

import frictionjax as fx
from frictionjax._compile import program_cache as kept_programs
from frictionjax._compile.programs import Program
from frictionjax.model.potentials import BristlePotential
from frictionjax.slide_laws import ingredients
from frictionjax.tables import profiles as table_profiles

FORCES, HEIGHTS = ingredients._forces._fn, table_profiles._heights._fn
PLACES = np.linspace(0.0, 1.0, 5)


@pytest.fixture
def traced(tmp_path, monkeypatch):
    """A folder to keep programs in, and the shapes of those traced so far."""
    shapes = []

    def counted(compiled, numbers):
        shapes.append([x.shape for x in numbers])
        return found(compiled, numbers)

    found = kept_programs._traced
    monkeypatch.setattr(kept_programs, "_traced", counted)
    monkeypatch.setattr(kept_programs, "_place", None)
    kept_programs.keep_in(tmp_path)
    return shapes


def wells(bristle=None):
    """Arguments of `_forces`, which returns three arrays."""
    bristle = bristle or fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0)
    return (
        BristlePotential(fx.profiles.Sine(0.1), bristle),
        np.asarray(0.2),
        PLACES + 0.1,
    )


def files(folder):
    """Programs in the folder."""
    return list(folder.glob("*/*.bin"))


def test_a_later_process_loads_what_an_earlier_one_traced(tmp_path, traced):
    first = Program(FORCES)(*wells())
    assert len(traced) == len(files(tmp_path)) == 1
    again = Program(FORCES)(*wells())
    plain = jax.jit(FORCES)(*wells())
    assert len(traced) == 1
    assert type(again) is type(first) is type(plain)
    for a, b, c in zip(first, again, plain, strict=True):
        np.testing.assert_array_equal(a, b)
        np.testing.assert_allclose(b, c, rtol=1e-14)
    other = Program(FORCES)(*wells(fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.2)))
    assert len(traced) == 1  # numbers are no part of a program
    assert not np.array_equal(other[1], first[1])


def test_other_programs_are_told_apart(tmp_path, traced):
    few, many = PLACES, np.linspace(0.0, 1.0, 7)
    Program(HEIGHTS)(fx.profiles.Sine(0.1), few)
    Program(HEIGHTS)(fx.profiles.Sine(0.1), many)
    Program(HEIGHTS)(fx.profiles.Sine(0.1), few.astype(int))
    Program(HEIGHTS)(fx.profiles.Fourier([0.1, 0.2], [0.1, 0.2]), few)
    Program(HEIGHTS)(fx.profiles.Fourier([0.1], [0.1]), few)
    assert len(traced) == len(files(tmp_path)) == 5
    Program(FORCES)(*wells())
    Program(FORCES)(*wells(fx.bristles.VerticalSpring(1.0, 2.0, 1.0)))
    assert len(traced) == len(files(tmp_path)) == 7


class Bump(fx.profiles.AbstractProfile):
    """A user's surface: another process may know another one by this name."""

    height: jax.Array

    @property
    def points(self):
        """Samples that resolve a period."""
        return 64

    def __call__(self, y):
        """Height in periods."""
        return self.height * jnp.sin(2 * jnp.pi * y)


@pytest.mark.parametrize("where", ["part", "function", "tree"])
def test_what_is_not_the_librarys_own_is_not_kept(tmp_path, traced, where):
    bump = Bump(jnp.asarray(0.1))
    if where == "part":
        found = Program(HEIGHTS)(bump, PLACES)
    elif where == "function":
        found = Program(lambda profile, places: jax.vmap(profile)(places))(bump, PLACES)
    else:
        found = Program(HEIGHTS)(eqx.Partial(bump), PLACES)
    np.testing.assert_allclose(found, 0.1 * np.sin(2 * np.pi * PLACES), atol=1e-16)
    assert traced == []
    assert files(tmp_path) == []


def test_named_functions_of_users_are_foreign():
    class Static(eqx.Module):
        fn: object = eqx.field(static=True)

    one = jax.tree_util.tree_structure((0,))
    kept_programs._described(HEIGHTS, one, ((0, np.sin),))
    for fn in (test_other_programs_are_told_apart, lambda x: x, Bump):
        with pytest.raises(kept_programs._ForeignError):
            kept_programs._described(HEIGHTS, one, ((0, fn),))
    local = jax.tree_util.tree_structure(Static(1))
    with pytest.raises(kept_programs._ForeignError, match="Static"):
        kept_programs._described(HEIGHTS, local, ())


def test_files_that_do_not_load_are_made_again(tmp_path, traced):
    first = Program(FORCES)(*wells())
    (path,) = files(tmp_path)
    path.write_bytes(path.read_bytes()[:100])
    again = Program(FORCES)(*wells())
    np.testing.assert_array_equal(first[1], again[1])
    assert len(traced) == 2
    Program(FORCES)(*wells())
    assert len(traced) == 2  # and are whole then


def test_a_folder_that_cannot_be_written_costs_time_only(tmp_path, traced):
    (tmp_path / "file").write_text("in the way")
    with pytest.warns(UserWarning, match=r"not kept in .*file.* \(Not a directory\)"):
        kept_programs.keep_in(tmp_path / "file")
    found = Program(FORCES)(*wells())
    np.testing.assert_allclose(found[1], jax.jit(FORCES)(*wells())[1], rtol=1e-14)


def test_derivatives_and_batches_of_programs_that_are_kept(traced):
    program = Program(HEIGHTS)
    program(fx.profiles.Sine(0.1), PLACES)
    slope = jax.jacfwd(lambda y: program(fx.profiles.Sine(0.1), y))(PLACES)
    expected = 0.1 * np.cos(2 * np.pi * PLACES)
    np.testing.assert_allclose(np.diag(slope), expected, atol=1e-15)
    many = jax.vmap(lambda a: program(fx.profiles.Sine(a), PLACES))(np.array([0.1, 0.2]))
    np.testing.assert_allclose(2 * many[0], many[1], atol=1e-15)


def test_other_source_and_other_packages_mean_other_folders(tmp_path, monkeypatch):
    package, site = tmp_path / "package", tmp_path / "site"
    for folder in (package, site / "jax-1.dist-info"):
        folder.mkdir(parents=True)
    source = package / "kept_programs.py"
    source.write_text("a = 1")
    monkeypatch.setattr(kept_programs, "__file__", str(source))
    monkeypatch.setattr(kept_programs.sysconfig, "get_path", lambda name: str(site))
    first = kept_programs._stamp()
    assert kept_programs._stamp() == first
    source.write_text("a = 2")
    second = kept_programs._stamp()
    (site / "jax-1.dist-info").rename(site / "jax-2.dist-info")
    assert len({first, second, kept_programs._stamp()}) == 3


def test_the_whole_library_is_the_source():
    home = Path(kept_programs.__file__).parents[1]
    assert home == Path(fx.__file__).parent


def test_the_oldest_go_first(tmp_path, monkeypatch, traced):
    monkeypatch.setattr(kept_programs, "_MOST", 2)
    for size in (3, 4, 5):
        Program(HEIGHTS)(fx.profiles.Sine(0.1), np.linspace(0.0, 1.0, size))
    assert len(files(tmp_path)) == 2
    Program(HEIGHTS)(fx.profiles.Sine(0.1), np.linspace(0.0, 1.0, 5))
    assert len(traced) == 3


def test_files_that_another_process_drops_meanwhile_are_no_failure(tmp_path, monkeypatch):
    """A file listed and gone before it was looked at: seen with two test workers."""
    folder = tmp_path / "one"
    folder.mkdir()
    for name in ("gone.bin", "kept.bin"):
        (folder / name).touch()
    listed = list(folder.iterdir())
    (folder / "gone.bin").unlink()
    monkeypatch.setattr(type(tmp_path), "glob", lambda *_: iter(listed))
    kept_programs._write(folder / "new.bin", b"new")
    assert {path.name for path in folder.iterdir()} == {"kept.bin", "new.bin"}


def test_functions_and_settings_are_told_apart():
    structure = jax.tree_util.tree_structure((0,))
    forces, heights = (
        kept_programs._described(fn, structure, ()) for fn in (FORCES, HEIGHTS)
    )
    assert forces != heights
    with jax.default_matmul_precision("bfloat16"):
        assert kept_programs._described(FORCES, structure, ()) != forces
    assert kept_programs._described(FORCES, structure, ()) == forces
