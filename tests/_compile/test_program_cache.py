"""Programs in a folder: the same answers, fetched only where they are the same program."""

from contextlib import contextmanager
from pathlib import Path

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax.experimental.compilation_cache import compilation_cache

import frictionjax as fx
from frictionjax._compile import program_cache as kept_programs
from frictionjax._compile import values_at
from frictionjax._compile.programs import Program, once_a_scene
from frictionjax.model.potentials import BristlePotential
from frictionjax.slide_laws import ingredients

FORCES, HEIGHTS = ingredients._forces._fn, values_at._fn
PLACES = np.linspace(0.0, 1.0, 5)


@contextmanager
def jax_keeping(folder):
    """JAX's own cache in a folder, or none where it is None."""
    settings = {
        "jax_enable_compilation_cache": folder is not None,
        "jax_compilation_cache_dir": str(folder),
        "jax_persistent_cache_min_compile_time_secs": 0.0,
    }
    before = {name: getattr(jax.config, name) for name in settings}
    for values in (settings, before):
        for name, value in values.items():
            jax.config.update(name, value)
        compilation_cache.reset_cache()
        if values is settings:
            yield


@pytest.fixture
def compiled(tmp_path, monkeypatch):
    """A folder to keep programs in, and the shapes of those compiled so far."""
    shapes = []

    def counted(jitted, numbers, options):
        shapes.append([x.shape for x in numbers])
        return found(jitted, numbers, options)

    found = kept_programs._compiled
    monkeypatch.setattr(kept_programs, "_compiled", counted)
    monkeypatch.setattr(kept_programs, "_place", None)
    kept_programs.keep_in(tmp_path)
    with jax_keeping(None):
        yield shapes


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


def test_a_later_process_loads_what_an_earlier_one_compiled(tmp_path, compiled):
    first = Program(FORCES)(*wells())
    assert len(compiled) == len(files(tmp_path)) == 1
    again = Program(FORCES)(*wells())
    plain = jax.jit(FORCES)(*wells())
    assert len(compiled) == 1
    assert type(again) is type(first) is type(plain)
    for a, b, c in zip(first, again, plain, strict=True):
        np.testing.assert_array_equal(a, b)
        np.testing.assert_allclose(b, c, rtol=1e-14)
    other = Program(FORCES)(*wells(fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.2)))
    assert len(compiled) == 1  # numbers are no part of a program
    assert not np.array_equal(other[1], first[1])


def test_other_programs_are_told_apart(tmp_path, compiled):
    few, many = PLACES, np.linspace(0.0, 1.0, 7)
    Program(HEIGHTS)(fx.profiles.Sine(0.1), few)
    Program(HEIGHTS)(fx.profiles.Sine(0.1), many)
    Program(HEIGHTS)(fx.profiles.Sine(0.1), few.astype(int))
    Program(HEIGHTS)(fx.profiles.Fourier([0.1, 0.2], [0.1, 0.2]), few)
    Program(HEIGHTS)(fx.profiles.Fourier([0.1], [0.1]), few)
    assert len(compiled) == len(files(tmp_path)) == 5
    Program(FORCES)(*wells())
    Program(FORCES)(*wells(fx.bristles.VerticalSpring(1.0, 2.0, 1.0)))
    assert len(compiled) == len(files(tmp_path)) == 7


@pytest.mark.parametrize("kept", [True, False])
def test_a_program_can_be_run_without_compilation_after_it_was(monkeypatch, compiled, kept):
    """It was refused: executables have no function that could be gone through."""
    if not kept:
        monkeypatch.setattr(kept_programs, "_place", None)
    program = Program(HEIGHTS)
    compiled_heights = program(fx.profiles.Sine(0.1), PLACES)
    with jax.disable_jit():
        found = program(fx.profiles.Sine(0.1), PLACES)
    np.testing.assert_allclose(found, compiled_heights, atol=1e-16)


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
def test_what_is_not_the_librarys_own_is_not_kept(tmp_path, compiled, where):
    bump = Bump(jnp.asarray(0.1))
    if where == "part":
        found = Program(HEIGHTS)(bump, PLACES)
    elif where == "function":
        found = Program(lambda profile, places: jax.vmap(profile)(places))(bump, PLACES)
    else:
        found = Program(HEIGHTS)(eqx.Partial(bump), PLACES)
    np.testing.assert_allclose(found, 0.1 * np.sin(2 * np.pi * PLACES), atol=1e-16)
    assert compiled == []
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


def test_files_that_do_not_load_are_made_again(tmp_path, compiled):
    first = Program(FORCES)(*wells())
    (path,) = files(tmp_path)
    path.write_bytes(path.read_bytes()[:100])
    again = Program(FORCES)(*wells())
    np.testing.assert_array_equal(first[1], again[1])
    assert len(compiled) == 2
    Program(FORCES)(*wells())
    assert len(compiled) == 2  # and are whole then


def test_files_that_do_not_run_are_made_again(tmp_path, compiled, monkeypatch):
    first = Program(FORCES)(*wells())

    def broken(data):
        def program(numbers):
            raise jax.errors.JaxRuntimeError("NOT_FOUND: a function of it")

        return program

    monkeypatch.setattr(kept_programs, "_loaded", broken)
    again = Program(FORCES)
    for _ in range(2):
        np.testing.assert_array_equal(again(*wells())[1], first[1])
    assert len(compiled) == 2
    assert len(files(tmp_path)) == 1


def test_what_jax_has_kept_is_not_written_down_once_more(tmp_path, compiled):
    """It runs, but what is written of it lacks its code."""
    with jax_keeping(tmp_path / "jax"):
        first = Program(FORCES)(*wells())
        (path,) = files(tmp_path)
        path.unlink()
        again = Program(FORCES)(*wells())
    assert len(compiled) == 2
    assert files(tmp_path) == []
    np.testing.assert_array_equal(first[1], again[1])


def test_programs_that_call_other_libraries_are_not_written_down():
    """Loaded by a process that has not called them yet they would end it."""
    numbers = [np.eye(2), np.ones(2)]
    with pytest.raises(kept_programs._ForeignError, match="solve calls another library"):
        kept_programs._compiled(jax.jit(solve), numbers)


def solve(numbers):
    return jnp.linalg.solve(*numbers)


def test_programs_for_several_devices_are_left_to_jax(tmp_path, compiled, monkeypatch):
    monkeypatch.setattr(jax, "device_count", lambda: 2)
    Program(FORCES)(*wells())
    assert compiled == files(tmp_path) == []


def test_a_folder_that_cannot_be_written_costs_time_only(tmp_path, compiled):
    (tmp_path / "file").write_text("in the way")
    with pytest.warns(UserWarning, match=r"not kept in .*file.* \(Not a directory\)"):
        kept_programs.keep_in(tmp_path / "file")
    found = Program(FORCES)(*wells())
    np.testing.assert_allclose(found[1], jax.jit(FORCES)(*wells())[1], rtol=1e-14)


def test_derivatives_and_batches_of_programs_that_are_kept(compiled):
    program = Program(HEIGHTS)
    program(fx.profiles.Sine(0.1), PLACES)
    slope = jax.jacfwd(lambda y: program(fx.profiles.Sine(0.1), y))(PLACES)
    expected = 0.1 * np.cos(2 * np.pi * PLACES)
    np.testing.assert_allclose(np.diag(slope), expected, atol=1e-15)
    many = jax.vmap(lambda a: program(fx.profiles.Sine(a), PLACES))(np.array([0.1, 0.2]))
    np.testing.assert_allclose(2 * many[0], many[1], atol=1e-15)


@pytest.mark.parametrize("keeps", [True, False])
def test_what_runs_once_a_scene_compiles_for_less(keeps, compiled, monkeypatch):
    """At LLVM's level 0, if the level is ours; inside other programs with theirs."""
    asked, jit = [], jax.jit

    def noted(fn, **options):
        asked.append(options.get("compiler_options"))
        return jit(fn, **options)

    if not keeps:
        monkeypatch.setattr(kept_programs, "_place", None)
    monkeypatch.setattr(jax, "jit", noted)
    level = "--xla_backend_optimization_level"
    for flags, own in (f"{level}=1", {level[2:]: 0}), (f"{level}=3", None), ("", None):
        monkeypatch.setenv("XLA_FLAGS", flags)
        asked.clear()
        brief, other = once_a_scene(HEIGHTS), Program(HEIGHTS)
        found = [p(fx.profiles.Sine(0.1), PLACES) for p in (brief, other)]
        np.testing.assert_allclose(*found, atol=1e-16)
        assert [options for options in asked if options] == ([own] if own else [])
    monkeypatch.setenv("XLA_FLAGS", f"{level}=1")
    brief = once_a_scene(HEIGHTS)

    def steepest(slope):
        return jnp.max(brief(fx.profiles.Sine(slope), PLACES))

    assert jax.jit(jax.grad(steepest))(0.1) == pytest.approx(1 / (2 * np.pi), rel=1e-9)


def test_other_source_packages_and_processors_mean_other_folders(tmp_path, monkeypatch):
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
    third = kept_programs._stamp()
    monkeypatch.setattr(kept_programs, "processor", lambda: "another one")
    assert len({first, second, third, kept_programs._stamp()}) == 4


def test_the_whole_library_is_the_source():
    home = Path(kept_programs.__file__).parents[1]
    assert home == Path(fx.__file__).parent


def test_the_oldest_go_first(tmp_path, monkeypatch, compiled):
    monkeypatch.setattr(kept_programs, "_MOST", 2)
    for size in (3, 4, 5):
        Program(HEIGHTS)(fx.profiles.Sine(0.1), np.linspace(0.0, 1.0, size))
    assert len(files(tmp_path)) == 2
    Program(HEIGHTS)(fx.profiles.Sine(0.1), np.linspace(0.0, 1.0, 5))
    assert len(compiled) == 3


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


def test_functions_and_settings_are_told_apart(monkeypatch):
    structure = jax.tree_util.tree_structure((0,))
    forces, heights = (
        kept_programs._described(fn, structure, ()) for fn in (FORCES, HEIGHTS)
    )
    assert forces != heights
    with jax.default_matmul_precision("bfloat16"):
        assert kept_programs._described(FORCES, structure, ()) != forces
    assert kept_programs._described(FORCES, structure, ()) == forces
    monkeypatch.setenv("XLA_FLAGS", "--others")
    assert kept_programs._described(FORCES, structure, ()) != forces
