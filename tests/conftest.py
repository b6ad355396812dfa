"""Tests run in 64 bits, like everything that uses the library."""

import jax

jax.config.update("jax_enable_x64", True)
