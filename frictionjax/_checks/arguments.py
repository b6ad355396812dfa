"""What every entry point asks of its arguments: 64-bit, finite, in range."""

import decimal
import inspect
from collections.abc import Iterator
from types import CellType, ModuleType
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from .surroundings import require_ready

Real = Float[Array, ""]
"""A traced real scalar."""

_EMPTY = CellType()
_nothing = jax.jit(lambda: False)  # a compiled call: 10 us, `jnp.zeros` takes 38
# Of functions and of partial ones: what they were given beforehand.
_GIVEN = "__defaults__", "__kwdefaults__", "func", "args", "keywords"
_CLOSURES = 4  # functions inside functions that are looked into for traced numbers


def in_64_bits() -> bool:
    """Whether JAX keeps 64-bit floats."""
    # The attribute is made at run time: types do not know of it.
    return bool(jax.config.jax_enable_x64)  # type: ignore[attr-defined]


def is_masked(value: Any) -> bool:
    """Whether samples are missing: those of NumPy's masked arrays, alone or in a list.

    `np.asarray` drops the mask without a word, and takes what lies under it.
    """
    if isinstance(value, np.ma.MaskedArray):
        return bool(np.ma.is_masked(value))
    return isinstance(value, list | tuple) and any(is_masked(part) for part in value)


def _as_masked(value: Any) -> np.ma.MaskedArray:
    """One masked array of a list of them; `np.ma.array` would warn, and fill in NaN."""
    if isinstance(value, list | tuple):
        return np.ma.stack([_as_masked(part) for part in value])
    return np.ma.asarray(value)


def without_masked(*columns: Any) -> tuple[list[Any], int]:
    """Columns of samples, those left out that are masked in one of them, and how many.

    Numbers and None stand for all samples. Columns of other shapes stay as they are, for
    the check of shapes.
    """
    rows = [_as_masked(c) if is_masked(c) else c for c in columns]
    several = [c for c in rows if np.ndim(c) > 0]
    masked = [np.ma.getmaskarray(c) for c in several if is_masked(c)]
    shapes = {np.shape(c) for c in several}
    if not masked or len(shapes) > 1 or masked[0].ndim != 1:
        return list(columns), 0
    keep = ~np.any(masked, axis=0)
    left = [np.ma.getdata(c)[keep] if np.ndim(c) else c for c in rows]
    return left, int(np.sum(~keep))


def as_real(value: Any) -> Any:
    """Convert numbers to float64 and leave JAX arrays (tracers too) as they are.

    Where JAX runs in 32 bits the value stays a NumPy float64: a part can be built
    before `jax_enable_x64` is set, and the entry points raise (`require_x64`). What is
    no number stays too, for the check that knows the argument's name.
    """
    if isinstance(value, jax.Array):
        whole = jnp.issubdtype(value.dtype, jnp.integer)
        return value.astype(float) if whole else value
    if not is_known(value):
        return jnp.asarray(value)
    known = known_numbers(value)
    if not _is_numeric(known):
        return value
    exact = known.astype(np.float64)
    if not in_64_bits():
        return exact
    require_ready()
    return as_jax(exact)


def known_numbers(value: Any) -> np.ndarray:
    """A concrete value as an array; `None` of shape () where it holds no numbers.

    Neither a truth is a number, nor what is masked.
    """
    if is_masked(value) or _has_truths(value):
        return np.asarray(None)
    try:
        array = np.asarray(value)
    except ValueError:  # a ragged list
        return np.asarray(None)
    return array if _is_numeric(array) else np.asarray(None)


def numbers_of(name: str, value: Any) -> np.ndarray:
    """A concrete value as an array of floats; raises `ValueError` where it is none."""
    array = known_numbers(value)
    require(_is_numeric(array), name, value, "numbers")
    return array.astype(float)


def _has_truths(value: Any) -> bool:
    """True in a list of numbers, which NumPy takes for 1."""
    if isinstance(value, list | tuple):
        return any(_has_truths(part) for part in value)
    return isinstance(value, bool | np.bool_)


def _is_numeric(array: np.ndarray) -> bool:
    return array.dtype.kind in "iuf"


class _Kinds(str):
    """What error messages show as it is, and not as a text in quotes."""


def kind_of(value: Any) -> Any:
    """What of a value of a wrong kind an error message shows: the name of its class.

    None as it is, and lists with the kinds of what they hold: `[Scene, None]`.
    """
    if isinstance(value, list | tuple):
        kinds = [str(kind_of(one)) for one in value[:3]]
        return _Kinds(f"[{', '.join(kinds + ['...'] * (len(value) > 3))}]")
    return None if value is None else type(value).__name__


def as_text(value: Any) -> str:
    """A value as an error message shows it: six digits, arrays shortened."""
    if isinstance(value, _Kinds):
        return str(value)
    if isinstance(value, eqx.Module) and hasattr(value, "__func__"):
        value = value.__self__  # type: ignore[attr-defined]  # of a part's method
    if value is None or isinstance(value, str | bool | np.bool_) or callable(value):
        return repr(value)
    if is_masked(value):
        values = _as_masked(value)
        return f"a masked array ({np.ma.count_masked(values)} of {values.size} masked)"
    if _has_truths(value):
        return repr(value)
    try:
        # A float of complex numbers warns, one of texts is no longer a text, None is NaN.
        if np.asarray(value).dtype.kind in "cSUO":
            return repr(value)
        array = np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        return repr(value)
    if array.ndim == 0:
        return f"{float(array):.6g}"
    return np.array2string(array, threshold=6, precision=6)


def no_less(value: float, digits: int = 6) -> str:
    """A limit from below in so many digits, rounded up: what is named is allowed."""
    return _rounded(value, digits, decimal.ROUND_CEILING)


def no_more(value: float, digits: int = 6) -> str:
    """A limit from above in so many digits, rounded down: what is named is allowed."""
    return _rounded(value, digits, decimal.ROUND_FLOOR)


def _rounded(value: float, digits: int, rounding: str) -> str:
    if not np.isfinite(value):
        return f"{value:g}"
    exact = decimal.Decimal(float(value))
    context = decimal.Context(prec=digits, rounding=rounding)
    return f"{float(context.plus(exact)):.{digits}g}"


def require(condition: Any, name: str, value: Any, allowed: str) -> None:
    """Raise `ValueError` naming the argument, its value and what is allowed."""
    if not bool(condition):
        masked = ", none of them masked" if is_masked(value) else ""
        raise ValueError(f"{name} = {as_text(value)}: needs {allowed}{masked}")


def is_concrete(*trees: Any) -> bool:
    """Whether JAX computes with these numbers now: all known, and nothing being traced.

    Where a caller's `jit` is traced, what is computed from known numbers is traced too.
    """
    require_ready()
    return is_known(*trees) and not isinstance(_nothing(), jax.core.Tracer)


def is_known(*trees: Any) -> bool:
    """Whether all numbers are known, so that NumPy can look at them."""
    # JAX warns of iterators among trees; the check of an argument refuses them.
    trees = tuple(tree for tree in trees if not isinstance(tree, Iterator))
    leaves = jax.tree_util.tree_leaves(trees)
    for _ in range(_CLOSURES):
        if any(isinstance(leaf, jax.core.Tracer) for leaf in leaves):
            return False
        held = [_captured(leaf) for leaf in leaves if callable(leaf)]
        if not held:
            break
        leaves = jax.tree_util.tree_leaves(held)
    return True


def as_jax(value: Any) -> Any:
    """Known numbers as an array of JAX, of the same type.

    Where no type is given, JAX compiles a copy at each new shape, for 20 ms (0.10.2).
    """
    value = np.asarray(value)
    return jnp.asarray(value, dtype=jax.dtypes.canonicalize_dtype(value.dtype))


def by_numpy(value: Any) -> Any:
    """A known array of JAX as one of NumPy, all else as it is.

    JAX compiles each step at each new shape, for 20 ms.
    """
    known = isinstance(value, jax.Array) and is_known(value)
    return np.asarray(value) if known else value


def has_numbers(tree: Any) -> bool:
    """Whether the numbers of a result are there: no traces, no shapes alone, not none."""
    leaves = jax.tree_util.tree_leaves(tree)
    shapes = any(isinstance(leaf, jax.ShapeDtypeStruct) for leaf in leaves)
    return bool(leaves) and not shapes and is_known(tree)


def require_outside(who: str, instead: str, **arguments: Any) -> None:
    """Raise where `who` is part of a program: an argument is traced, or all around it is.

    `instead`: what to do.
    """
    for name, value in arguments.items():
        require(is_known(value), name, "a traced one", f"a known one: {instead}")
    require(is_concrete(), who, "part of jax.jit", f"a call outside: {instead}")


def _captured(fn: Any) -> list[Any]:
    """What a function holds beside its arguments: `lambda y: slope * sin(y)`.

    From where it was written, from when it was made, and on a method's object.
    """
    inner = inspect.unwrap(fn)
    cells = getattr(inner, "__closure__", None) or ()
    held = [cell.cell_contents for cell in cells if cell != _EMPTY]
    owner = getattr(inner, "__self__", inner)  # of a method
    if not isinstance(owner, type | ModuleType):
        held += [owner if owner is not inner else None, getattr(owner, "__dict__", None)]
    return [*held, *(getattr(inner, name, None) for name in _GIVEN)]


def require_real(name: str, value: Any, allowed: str, test: Any = None) -> None:
    """Check a scalar part: shape () and finite, and `test(value)` where one is given."""
    if not is_known(value):
        return
    array = known_numbers(value)
    require(_is_numeric(array), name, value, f"a number, {allowed}")
    require(array.ndim == 0, name, value, f"one number, {allowed}")
    require(np.isfinite(array), name, value, f"a finite number, {allowed}")
    if test is not None:
        require(test(float(array)), name, value, allowed)


def require_whole(name: str, value: Any, least: int = 1, why: str = "") -> None:
    """Check a count, or a seed: a whole number >= `least`; `why` it is that much."""
    whole = isinstance(value, int | np.integer) and not isinstance(value, bool)
    require(whole and value >= least, name, value, f"a whole number >= {least}{why}")


def as_plain(value: Any) -> Any:
    """A scalar of NumPy as Python's: what is static must be no array."""
    return value.item() if isinstance(value, np.generic) else value


def require_flags(**flags: Any) -> None:
    """Check what is on or off: `"no"` would be on."""
    for name, value in flags.items():
        require(isinstance(value, bool | np.bool_), name, value, "True or False")


def real_struct() -> jax.ShapeDtypeStruct:
    """A real number for `jax.eval_shape`, of the width that there is.

    Where that is 32 bits, JAX 0.12 warns of 64.
    """
    return jax.ShapeDtypeStruct((), jnp.result_type(float))


def require_function(name: str, fn: Any, what: str, smooth: bool = True) -> None:
    """Check that `fn` takes one number to one number, and has a derivative if `smooth`."""
    require(callable(fn), name, fn, what)
    require(_can_be_hashed(fn), name, fn, f"{what}, with a hash: programs are kept by it")
    require(_takes_one(fn), name, fn, f"{what} alone, which is its one argument")
    number, wrong = real_struct(), []

    def value(x: Real) -> Array:
        given = fn(x)
        try:
            if isinstance(given, str):
                raise TypeError  # JAX may read it as a kind of numbers
            return jnp.asarray(given)
        except (TypeError, ValueError):
            # A text, as no trace may outlive the call.
            wrong.append(f"values that are [{given!r}]")
            raise

    one = f"{what}, one real number for one"
    try:
        found = jax.eval_shape(value, number)
    except jax.errors.JAXTypeError:
        require(False, name, fn, f"{what}, written with jax.numpy")
    except (TypeError, ValueError):
        require(not wrong, name, "".join(wrong), one)
        raise
    require(found.shape == (), name, f"values of shape {found.shape}", one)
    real = not jnp.issubdtype(found.dtype, jnp.complexfloating)
    require(real, name, f"values of dtype {found.dtype}", one)
    if smooth:
        with_point = jnp.issubdtype(found.dtype, jnp.floating)
        require(with_point, name, f"values of dtype {found.dtype}", f"{one}, no whole one")
        try:
            jax.eval_shape(jax.grad(lambda x: jnp.asarray(fn(x))), number)
        except (TypeError, ValueError):
            require(False, name, fn, f"{what}, which jax.grad goes through")


def _takes_one(fn: Any) -> bool:
    try:
        inspect.signature(fn).bind(None)
    except TypeError:
        return False
    except ValueError:
        pass  # no signature to be had
    return True


def _can_be_hashed(fn: Any) -> bool:
    try:
        hash(tuple(x for x in jax.tree_util.tree_leaves(fn) if not eqx.is_array_like(x)))
    except TypeError:
        return False
    return True


def require_x64(*trees: Any) -> None:
    """Raise where JAX, or a leaf of a part, is not in 64 bits.

    A well at eps = 1e-4 has 3 digits left in 32 bits: nothing here can be trusted then.
    """
    if not in_64_bits():
        mend = 'run `jax.config.update("jax_enable_x64", True)` before building the scene'
        raise ValueError(f"jax_enable_x64 = False: needs 64-bit floats; {mend}")
    require_ready()
    for leaf in jax.tree_util.tree_leaves(trees):
        if eqx.is_inexact_array(leaf) and leaf.dtype != np.float64:
            numbers = "build the parts from Python numbers or float64 arrays"
            mend = f'{numbers}, after `jax.config.update("jax_enable_x64", True)`'
            raise ValueError(f"dtype = {leaf.dtype}: needs float64 leaves; {mend}")


def require_numbers(name: str, value: Any, allowed: str, test) -> None:
    """Check one number or an array of them; True is none, though NumPy takes it for 1."""
    if not is_known(value):
        return
    array = known_numbers(value)
    require(_is_numeric(array), name, value, allowed)
    good = array.size > 0 and np.all(np.isfinite(array)) and bool(np.all(test(array)))
    require(good, name, value, allowed)
