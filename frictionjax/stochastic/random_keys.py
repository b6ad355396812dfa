"""Keys of paths: two words each, counted."""

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int, UInt32

from .._checks import require, require_outside, require_whole

_WORDS = 2**32


def key_words(key: Any) -> UInt32[np.ndarray, " words"]:
    """The two words of a seed (a whole number >= 0, below 2^32) or of any JAX key.

    Of a key of another generator than JAX's own (threefry), two words drawn with it.
    Raises `ValueError` for anything else, for an array of keys, and inside `jax.jit`.
    """
    several = "`fx.ensemble` makes many paths at once"
    require_outside("a path with noise", several, key=key)
    allowed = "a seed, a whole number >= 0, or one key of jax.random"
    if isinstance(key, int | np.integer) and not isinstance(key, bool):
        require_whole("key", key, 0)
        require(key < _WORDS, "key", key, "a seed below 2^32")
        return np.asarray(jax.random.key_data(_of_seed(int(key))))
    require(isinstance(key, jax.Array), "key", key, allowed)
    if not jnp.issubdtype(key.dtype, jax.dtypes.prng_key):
        words = np.asarray(key)
        raw = words.shape == (2,) and words.dtype == np.uint32
        require(raw, "key", key, allowed)
        return words
    require(key.shape == (), "key", f"an array of keys {key.shape}", allowed)
    if str(jax.random.key_impl(key)) == "threefry2x32":
        return np.asarray(jax.random.key_data(key))
    return np.asarray(jax.random.bits(key, (2,), np.uint32))


def path_keys(key: Any, paths: int) -> UInt32[np.ndarray, "paths words"]:
    """Keys of the first paths of an ensemble, `fold_in(key, i)`: more paths change none."""
    require_whole("paths", paths)
    return np.asarray(_folded_in(jnp.asarray(key_words(key)), np.arange(paths)))


@jax.jit  # one program, not eight
def _folded_in(words: UInt32[Array, " words"], numbers: Int[Array, " n"]) -> Any:
    whole = jax.random.wrap_key_data(words, impl="threefry2x32")
    keys = jax.vmap(lambda i: jax.random.fold_in(whole, i))(numbers)
    return jax.random.key_data(keys)


def cell_keys(
    key: UInt32[np.ndarray, " words"],
    eps: Float[np.ndarray, " cells"],
    gamma: Float[np.ndarray, " cells"],
) -> UInt32[np.ndarray, "cells words"]:
    """Keys of cells, by the bits of their eps and gamma: independent of each other, and the
    same alone and in any grid."""
    numbers = np.stack([eps, gamma], axis=1).astype(np.float64)
    words = numbers.view(np.uint32).reshape(-1, 4)
    return np.asarray(_folded_in_each(jnp.asarray(key), words))


@jax.jit  # one program for a number of cells, not a dozen: 0.5 s
def _folded_in_each(
    key: UInt32[Array, " words"], words: UInt32[Array, "cells numbers"]
) -> UInt32[Array, "cells words"]:
    whole = jax.random.wrap_key_data(key, impl="threefry2x32")

    def folded(bits: Any) -> Any:
        found = whole
        for bit in bits:
            found = jax.random.fold_in(found, bit)
        return jax.random.key_data(found)

    return jax.vmap(folded)(words)


def _of_seed(seed: int) -> Any:
    return jax.random.key(seed, impl="threefry2x32")
