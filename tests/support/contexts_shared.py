"""Fewer contexts of MLIR: to make one takes 5 of the 25 ms of a small program (by hand)."""

import threading

try:
    from jax._src.interpreters import mlir
    from jax._src.lib.mlir import ir
except ImportError:  # no part of what JAX promises
    mlir = None

_MOST = 64  # programs written in one: what a context has been told it keeps


class _Shared(threading.local):
    """The context of a thread, and how many programs it may still be used for."""

    context, left = None, 0


def share_contexts():
    """Have programs that a thread writes one after the other share a context of MLIR.

    Programs stay what they are, as a context holds types and constants by their values.
    (4,500 programs of the suite: 25 CPU s, by hand.)
    """
    if not hasattr(mlir, "make_ir_context"):
        return
    shared, make = _Shared(), mlir.make_ir_context

    def context():
        if _is_entered():  # inside of another program's writing: no place of its own
            return make()
        if not shared.left:
            shared.context, shared.left = make(), _MOST
        shared.left -= 1
        return shared.context

    mlir.make_ir_context = context


def _is_entered():
    try:
        return ir.Context.current is not None
    except ValueError:
        return False
