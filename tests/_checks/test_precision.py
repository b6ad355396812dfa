"""Nothing is computed in 32 bits, and importing the library changes no setting."""

import subprocess
import sys

import jax.numpy as jnp
import numpy as np
import pytest

import frictionjax as fx

MEND = 'jax.config.update("jax_enable_x64", True)'

IMPORTS = """
import importlib, pkgutil, jax
before = dict(jax.config.values)
import frictionjax
for name in frictionjax.__all__:
    getattr(frictionjax, name)
changed = [key for key, value in jax.config.values.items() if before.get(key) != value]
assert not changed, changed
assert not jax.config.jax_enable_x64
"""

ENTRIES = """
import frictionjax as fx, jax.numpy as jnp
fx.profiles.Spline([0.0, 0.02, 0.0, -0.01])
surface, part = fx.profiles.Sine(0.1), fx.bristles.Homothetic(1.0)  # NumPy leaves
fx.profiles.Custom(lambda y: jnp.sin(2 * jnp.pi * y))
spring, load = fx.supports.Spring(1.0), fx.loads.Sine(1.0, 3.0)
scene = fx.Scene(surface, part, spring, load, duration=3.0)
wiggle = fx.potential(surface, part)
calls = {
    "friction": lambda: fx.friction(scene),
    "solve_limit": lambda: fx.solve_limit(scene),
    "solve": lambda: fx.solve(scene, 1e-2),
    "sweep": lambda: fx.sweep(scene, [1e-2], [1.0]),
    "energy": lambda: wiggle.energy(0.1, 1e-2),
    "force": lambda: wiggle.force(0.1, 1e-2),
    "W": lambda: wiggle.W(0.1),
    "Q": lambda: wiggle.Q(1e-2, 0.1),
}
for name, call in calls.items():
    try:
        call()
    except ValueError as error:
        assert 'jax.config.update("jax_enable_x64", True)' in str(error), (name, error)
    else:
        raise AssertionError(f"{name} ran in 32 bits")
"""


def run(script):
    command = [sys.executable, "-W", "error::UserWarning", "-c", script]
    return subprocess.run(command, capture_output=True, text=True, check=False)


@pytest.mark.parametrize("script", [IMPORTS, ENTRIES], ids=["imports", "entries"])
def test_in_a_fresh_interpreter(script):
    done = run(script)
    assert done.returncode == 0, done.stderr


def test_parts_of_32_bits_are_refused():
    part = fx.bristles.Homothetic(1.0)
    narrow = fx.profiles.Sine(jnp.float32(0.1))
    with pytest.raises(ValueError, match=r"dtype = .*float32") as error:
        fx.friction(narrow, part)
    assert MEND in str(error.value)
    with pytest.raises(ValueError, match="float32"):
        fx.potential(narrow, part).W(0.1)


def test_numbers_of_any_kind_become_64_bits():
    for one in (1, np.float32(1), np.int8(1), jnp.asarray(1)):
        assert fx.bristles.Homothetic(one).alpha.dtype == np.float64
    with pytest.raises(ValueError, match=r"bristle\.alpha = True: needs a number"):
        fx.bristles.Homothetic(True)
    assert fx.profiles.Fourier([1, 0], np.zeros(2, np.float32)).sin.dtype == np.float64
