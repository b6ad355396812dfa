"""Arrays of another shape than annotated are refused in tests, and none else."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from jaxtyping import Float, TypeCheckError, jaxtyped
from shape_checks import shapes_checked

from frictionjax.convergence import local_orders
from frictionjax.numerics import smallest

EPS = np.array([1e-1, 1e-2, 1e-3])


HERE = Path(__file__).parent
FILES = ("test_shapes.py", "limit/test_play.py")
NEEDED = "not derivative and not balance and not minimisation"  # no other shapes in those


@pytest.mark.slow  # in a process that checks every call: 18 s
def test_shapes_are_those_annotated():
    """In a process of its own: the library of this one is imported as it is."""
    if os.environ.get("SHAPES_CHECKED"):
        pytest.skip("they are checked everywhere")
    files = (str(HERE / file) for file in FILES)
    command = sys.executable, "-m", "pytest", "-n", "0", "-k", NEEDED, *files
    done = subprocess.run(
        command,
        cwd=HERE.parent,
        env=os.environ | {"SHAPES_CHECKED": "1"},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stdout


@pytest.mark.skipif("SHAPES_CHECKED" not in os.environ, reason="in the process above")
def test_faces_of_packages_are_checked():
    assert local_orders(EPS, EPS).shape == (2,)
    with pytest.raises(TypeCheckError, match="errors"):
        local_orders(EPS, EPS[1:])
    with pytest.raises(TypeCheckError, match="values"):
        smallest(EPS)  # of NumPy


@pytest.mark.parametrize("found", [EPS, EPS[None], EPS.astype(int)], ids=str)
def test_what_is_returned_is_checked(found):
    @jaxtyped(typechecker=shapes_checked)
    def pairs() -> Float[np.ndarray, "2"]:
        return found

    with pytest.raises(TypeCheckError, match="return"):
        pairs()


def test_hints_without_shapes_are_left_to_mypy():
    @jaxtyped(typechecker=shapes_checked)
    def doubled(number: int, values: Float[np.ndarray, " n"]) -> str:
        return number * values

    assert np.all(doubled(2.0, EPS) == 2 * EPS)
