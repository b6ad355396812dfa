"""Effects that have a bending stiffness and nothing else."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from frictionjax.effects import AbstractEffect, AxialLoad, NapFlip

KINDS = (AxialLoad, NapFlip)


@pytest.mark.parametrize("kind", KINDS)
def test_it_is_data_of_one_traced_number(kind):
    effect = kind(2)
    assert isinstance(effect, AbstractEffect)
    assert [leaf.dtype for leaf in jax.tree.leaves(effect)] == [np.float64]
    assert float(effect.replace(bending_stiffness=3.0).bending_stiffness) == 3.0
    slope = jax.grad(lambda B: kind(B).bending_stiffness ** 2)(jnp.asarray(1.5))
    assert float(slope) == 3.0


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("value", [0.0, -1.0, np.inf, np.nan, True, "1", [1.0, 2.0], None])
def test_a_wrong_bending_stiffness_is_named(kind, value):
    name = rf"effects\.{kind.__name__}\.bending_stiffness = .*: needs .*> 0"
    with pytest.raises(ValueError, match=name):
        kind(value)
