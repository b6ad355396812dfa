import jax
import numpy as np
import pytest

from frictionjax.stochastic import key_words, path_keys


def test_a_seed_is_the_key_that_jax_makes_of_it():
    words = key_words(5)
    assert words.tolist() == np.asarray(jax.random.key_data(jax.random.key(5))).tolist()
    assert words.tolist() == key_words(jax.random.key(5)).tolist()
    assert words.tolist() == key_words(jax.random.PRNGKey(5)).tolist()
    other = key_words(jax.random.key(5, impl="rbg"))
    assert other.shape == (2,)
    assert other.dtype == np.uint32


def test_more_paths_change_no_path():
    few, many = path_keys(1, 3), path_keys(1, 50)
    assert np.array_equal(few, many[:3])
    assert len({tuple(words) for words in many}) == 50
    assert not np.any(np.all(many == key_words(1), axis=1))


@pytest.mark.parametrize(
    "wrong", [-1, 2**32, 1.5, True, "seed", None, np.arange(2), jax.numpy.zeros(2)]
)
def test_what_is_no_key_is_refused(wrong):
    with pytest.raises(ValueError, match="key = "):
        key_words(wrong)


def test_an_array_of_keys_is_refused():
    with pytest.raises(ValueError, match=r"key = 'an array of keys \(3,\)'"):
        key_words(jax.random.split(jax.random.key(0), 3))
    with pytest.raises(ValueError, match="paths = 0: needs a whole number >= 1"):
        path_keys(0, 0)
