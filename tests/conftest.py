"""Tests run in 64 bits, like everything that uses the library."""

import os

# Most of the suite's time is compilation: LLVM's cheap passes save a fifth of it. Has to
# stand before JAX starts; what the library computes does not depend on it.
os.environ.setdefault("XLA_FLAGS", "--xla_backend_optimization_level=1")

import jax

jax.config.update("jax_enable_x64", True)
