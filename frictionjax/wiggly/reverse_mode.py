"""Numbers whose derivatives are those of reverse mode, and the first: others are refused.

JAX tells the modes apart by nothing but what becomes of a tangent: in reverse mode it is
transposed, and never computed. Where a `custom_vjp` meets the other one, JAX names nothing.
"""

from typing import Any

import equinox as eqx
import jax
from jax.extend.core import Primitive
from jax.interpreters import ad, batching, mlir
from jaxtyping import Array, PyTree

_NEEDS = (
    "diffrax.ForwardMode() for jax.jvp and jax.jacfwd, and for second derivatives, by "
    "jax.jacfwd(jax.jacfwd(...)); without it they are the first, in reverse mode"
)


def _refuse(*_: Any, **__: Any) -> Any:
    raise ValueError(f"adjoint = None: needs {_NEEDS}")


_tangent = Primitive("tangent_in_reverse_mode")
_tangent.def_impl(_refuse)
_tangent.def_abstract_eval(lambda tangent: tangent)
ad.deflinear2(_tangent, lambda by, _: [by])
batching.primitive_batchers[_tangent] = _refuse
mlir.register_lowering(_tangent, _refuse)

# Of a batch too tangents are those of the batch (`jax.custom_jvp` would batch tangents).
_in_reverse = Primitive("in_reverse_mode")
_in_reverse.def_impl(lambda value: value)
_in_reverse.def_abstract_eval(lambda value: value)
ad.primitive_jvps[_in_reverse] = lambda primals, tangents: (
    _in_reverse.bind(*primals),
    _tangent.bind(*tangents),
)
batching.primitive_batchers[_in_reverse] = lambda given, axes: (
    _in_reverse.bind(*given),
    *axes,
)
mlir.register_lowering(_in_reverse, lambda context, value: [value])


@jax.custom_jvp
def _constant(value: Array) -> Array:
    return value


_constant.defjvp(_refuse)


def in_reverse_mode(tree: PyTree) -> PyTree:
    """The tree itself. Raises `ValueError` where it is differentiated in forward mode."""
    return _of_traced(_in_reverse.bind, tree)


def without_derivatives(tree: PyTree) -> PyTree:
    """The tree itself. Raises `ValueError` where it is differentiated."""
    return _of_traced(_constant, tree)


def _of_traced(fn: Any, tree: PyTree) -> PyTree:
    def of_leaf(leaf: Any) -> Any:
        traced = isinstance(leaf, jax.core.Tracer) and eqx.is_inexact_array(leaf)
        return fn(leaf) if traced else leaf

    return jax.tree_util.tree_map(of_leaf, tree)
