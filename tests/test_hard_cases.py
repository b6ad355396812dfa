"""Hard scenes against trajectories that share no line with the library.

Scenes of one kind share their compiled programs: they differ in numbers alone.
"""

import math
import os
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import jax
import numpy as np
import pytest
import reference as ref
from scipy.optimize import brentq
from test_trajectories import angular, piecewise

import frictionjax as fx
from frictionjax.compilation import FAST_CPU_FLAGS

END, TIMES = 3.0, np.linspace(0.0, 3.0, 61)
CALM = [0.0, 0.7, 0.7, -0.6, -0.6, 0.3, 0.3]
SPACED = [0.0, 0.6, 1.0, 1.8, 2.0, 2.7, 3.0]
SINE = ([0.0] * 4, [0.1 / ref.TWO_PI, 0.0, 0.0, 0.0])


class Hard(NamedTuple):
    """A vertical spring of stiffness 1 on four harmonics, a support, a load of 7 kinks."""

    why: str
    eps: float = 0.05
    gamma: float = 1.0
    surface: tuple = SINE
    alpha: float = 1.0
    k: float = 1.0
    times: tuple = tuple(SPACED)
    values: tuple = tuple(CALM)
    z0: float = 0.0


def _slopes(*harmonics: float) -> tuple:
    """Sines whose slopes have these amplitudes."""
    sines = [s / (ref.TWO_PI * n) for n, s in enumerate(harmonics, start=1)]
    return [0.0] * 4, sines


# Where z + (1 + eps w) w' = 0 and falls, for the sine and eps = 0.05.
SUMMIT = 0.05 * brentq(
    lambda y: (
        0.05 * y
        + 0.1
        * np.cos(ref.TWO_PI * y)
        * (1 + 0.05 * 0.1 / ref.TWO_PI * np.sin(ref.TWO_PI * y))
    ),
    0.6,
    0.75,
)

HARD = {
    "gamma 4": Hard("slips a thousand times shorter than the time between them", 0.1, 4.0),
    "gamma 0.05": Hard("hardly stiff, lags of about twenty wells", gamma=0.05),
    "soft support": Hard("states of kilometres, eps of 500 m", 500.0, k=1e-4),
    "stiff support": Hard("eps of 1e-6 m, forces of 1 N", 5e-6, 0.1, k=1e4),
    "alpha near 0": Hard(
        "wiggles of 1e-6 of the spring's force",
        5e-8,
        0.5,
        alpha=1e-6,
        values=tuple(1e-6 * v for v in CALM),
    ),
    "alpha < 0": Hard("folds change sides", alpha=-0.5),
    "two folds": Hard("two folds a period", surface=_slopes(0.05, 0.1, 0.0, 0.0)),
    "equal folds": Hard("folds within 1e-3", surface=_slopes(1e-4, 0.1, 0.0, 0.0)),
    "flat": Hard("w' and w'' vanish together", surface=_slopes(0.12, -0.06, 0.0, 0.0)),
    "steep": Hard("barriers that the load never climbs", surface=_slopes(2.0, 0, 0.5, 0)),
    "fast part": Hard(
        "the load jumps within 1e-6 s",
        times=(0.0, 1.0, 1.000001, 1.5, 2.0, 2.5, 3.0),
        values=(0.0, 0.2, 0.9, 0.9, 0.4, 0.4, 0.1),
    ),
    "slow part": Hard(
        "a load of 1e-3 N/s after one of 1 N/s",
        times=(0.0, 0.8, 3.0 - 1e-3, 2.9995, 2.9997, 2.9999, 3.0),
        values=(0.0, 0.8, 0.802, 0.802, 0.802, 0.802, 0.802),
    ),
    "tiny reversals": Hard(
        "turns that move the load by a hundredth of a well",
        times=(0.0, 1.0, 1.1, 1.2, 1.3, 1.4, 3.0),
        values=(0.0, 0.61, 0.6095, 0.61, 0.6095, 0.61, -0.5),
    ),
    "on the edge": Hard(
        "the load stops on the strip's edge",
        times=tuple(SPACED),
        values=(0.0, 0.1, 0.1, -0.1, -0.1, 0.1, 0.1),
    ),
    "hardly moves": Hard(
        "a load worth 90 m moves z by millimetres",
        eps=19.0,
        gamma=1.34,
        alpha=0.28,
        k=2.4e-3,
        values=tuple(0.22 * v for v in CALM),
    ),
    "far from the origin": Hard(
        "a way of 1e-6 wells, 4700 wells away: energies cancel in the dissipation",
        eps=19.0,
        gamma=2.4,
        alpha=0.28,
        k=2.4e-3,
        values=tuple(216.0 + 0.022 * v for v in CALM),
        z0=9e4,
    ),
    "far above": Hard("a start 400 wells outside the strip", z0=20.0),
    "far below": Hard("a start 400 wells outside the strip", gamma=2.0, z0=-20.0),
    "on a summit": Hard("a start on an unstable equilibrium", z0=SUMMIT),
}


def scene_of(one: Hard) -> fx.Scene:
    cos, sin = one.surface
    return fx.Scene(
        fx.profiles.Fourier(cos, sin),
        fx.bristles.VerticalSpring(1.0, 1.0 + one.alpha, 1.0),
        fx.supports.Spring(one.k),
        fx.loads.PiecewiseLinear(one.times, one.values),
        END,
        one.z0,
    )


def system_of(one: Hard) -> ref.System:
    cos, sin = one.surface
    slope = sum(ref.TWO_PI * n * abs(s) for n, s in enumerate(sin, start=1))
    return ref.System(
        w=ref.series(cos, sin),
        bristle=lambda eta: (0.0, 0.0, one.alpha + eta),
        force=lambda z: one.k * z,
        load=piecewise(one.times, one.values),
        duration=END,
        kinks=tuple(one.times[1:-1]),
        steepest=slope * abs(one.alpha),
        stiffness=one.k,
        rate=float(np.abs(np.diff(one.values) / np.diff(one.times)).max()),
    )


def check(scene, system, eps, gamma, z0, accuracy=1e-3):
    """Values against the plain integration, every way of the library."""
    plain = ref.solve(system, eps, gamma, z0, TIMES)
    outside = ~plain.in_slip
    assert outside.sum() >= 45
    for method in ("auto", "windowed", "resolved"):
        found = fx.solve(scene, eps, gamma, TIMES, accuracy, method)
        assert found.ok, found.status.message
        error = np.abs(np.asarray(found.z) - plain.z)[outside] / eps
        assert error.max() < accuracy, method
        lost = np.abs(np.asarray(found.dissipation) - plain.dissipation)[outside]
        assert lost.max() < accuracy * plain.dissipation[-1], method
        assert float(found.residual[-1]) < 0.05 * plain.dissipation[-1]


@pytest.mark.parametrize("name", HARD)
def test_hard_cases(name):
    one = HARD[name]
    check(scene_of(one), system_of(one), one.eps, one.gamma, one.z0)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("theta", "slope", "force", "eps"),
    [
        (0.11, 0.1, 1.0, 1e-3),  # near 0; tan(theta) = 0.1104
        (1.45, 0.1, 0.2, 1e-3),  # near pi/2; cot(theta) = 0.1214
        (math.acos(1 - 1e-9), 2e-5, 0.5, 2e-5),  # L - h = 1e-9 L
        (math.atan(0.1 * (1 + 1e-3)), 0.1, 1.0, 1e-4),  # admissible by 1e-3
    ],
    ids=["flat", "upright", "L - h = 1e-9 L", "hardly admissible"],
)
def test_hard_rods(theta, slope, force, eps):
    numbers = (1.0, 1 / math.cos(theta), 1.0, theta - 0.4)
    law = fx.friction(fx.profiles.Sine(slope), fx.bristles.AngularSpring(*numbers))
    width = float(law.rho_plus - law.rho_minus)
    load = [force * width * v / 0.2 for v in CALM]
    scene = fx.Scene(
        fx.profiles.Sine(slope),
        fx.bristles.AngularSpring(*numbers),
        fx.supports.Spring(5 * force * width / (100 * eps)),
        fx.loads.PiecewiseLinear(SPACED, load),
        END,
    )
    stiffness = 5 * force * width / (100 * eps)
    system = ref.System(
        w=ref.sine(slope),
        bristle=angular(*numbers),
        force=lambda z: stiffness * z,
        load=piecewise(SPACED, load),
        duration=END,
        kinks=tuple(SPACED[1:-1]),
        steepest=width,
        stiffness=stiffness,
        rate=float(np.abs(np.diff(load) / np.diff(SPACED)).max()),
    )
    check(scene, system, eps, 0.1, 0.0)


def _quartic(z):
    return z**4 / 4 + 1e-3 * z**2 / 2


def _soft_plus(z):
    return 0.05 * z**2 + jax.nn.softplus(10 * z) / 10 - z / 2


@pytest.mark.slow
@pytest.mark.parametrize(
    ("energy", "force"),
    [
        (_quartic, lambda z: z**3 + 1e-3 * z),
        (_soft_plus, lambda z: 0.1 * z + 0.5 * math.tanh(5 * z)),
    ],
    ids=["quartic well", "soft-plus"],
)
def test_hard_supports(energy, force):
    scene = scene_of(Hard(""))
    scene = fx.Scene(
        scene.profile, scene.bristle, fx.supports.Convex(energy), scene.load, END
    )
    system = system_of(Hard(""))
    hard = ref.System(**{**system.__dict__, "force": force, "stiffness": 1.0})
    check(scene, hard, 0.03, 1.0, 0.0)


@pytest.mark.slow
def test_a_sawtooth_of_64_harmonics():
    # Slopes: a steep flank of a tenth of the period, of which 64 harmonics keep the edge.
    n = np.arange(1, 65)
    sin = 0.02 * np.sin(0.2 * np.pi * n) / n**2 * np.exp(-((n / 40) ** 2))
    cos = np.zeros(64)
    shape = scene_of(Hard(""))
    profile = fx.profiles.Fourier(cos, sin)
    scene = fx.Scene(profile, shape.bristle, shape.support, shape.load, END)
    system = ref.System(
        **{**system_of(Hard("")).__dict__, "w": ref.series(list(cos), list(sin))}
    )
    check(scene, system, 0.1, 1.0, 0.0)


_SCRIPT = """
import sys, jax
jax.config.update("jax_enable_x64", True)
import numpy as np, frictionjax as fx
from test_hard_cases import HARD, TIMES, scene_of
found = {}
for name in ("gamma 4", "gamma 0.05", "alpha < 0", "two folds", "fast part", "on a summit"):
    one = HARD[name]
    data = fx.sweep(scene_of(one), one.eps, one.gamma, TIMES).isel(gamma=0, eps=0)
    found[name] = np.stack([data.z / one.eps, data.dissipation / data.dissipation[-1]])
np.savez(sys.argv[1], **found)
"""


@pytest.mark.slow
def test_compiler_flags_do_not_matter(tmp_path):
    flags = {
        "plain": "",
        "fast": FAST_CPU_FLAGS,
        "quick": "--xla_backend_optimization_level=0",
    }
    found = {}
    for name, value in flags.items():
        path, here = tmp_path / f"{name}.npz", str(Path(__file__).parent)
        env = os.environ | {"XLA_FLAGS": value, "PYTHONPATH": here}
        subprocess.run([sys.executable, "-c", _SCRIPT, path], check=True, env=env)
        found[name] = dict(np.load(path))
    for name in ("fast", "quick"):
        for scene, values in found["plain"].items():
            assert np.abs(found[name][scene] - values).max() < 1e-6, (name, scene)


_COMPILED = """
import resource, sys
resource.setrlimit(resource.RLIMIT_DATA, (8 * 2**30, 8 * 2**30))
import jax
jax.config.update("jax_enable_x64", True)
import numpy as np
import frictionjax as fx
from test_hard_cases import Hard, scene_of
k = np.arange(1, int(sys.argv[1]) + 1)
cos = 0.1 / k**4 / (2 * np.pi * np.sum(1.0 / k**3))
scene = scene_of(Hard("", surface=(cos, 0.3 * cos)))
data = fx.sweep(scene, [1e-3], [0.5], np.linspace(0, 3, 61))  # wide and narrow loops
assert int(data.status.max()) == 0, data.status.values
print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20)
"""


@pytest.mark.slow
@pytest.mark.parametrize("harmonics", [8, 16, 33])
def test_compilation_with_fast_flags_takes_little_memory(harmonics):
    # Sums of 14 and 16 harmonics, written out, took LLVM more than 20 GB.
    env = os.environ | {
        "XLA_FLAGS": FAST_CPU_FLAGS,
        "PYTHONPATH": str(Path(__file__).parent),
    }
    env.pop("JAX_COMPILATION_CACHE_DIR", None)
    command = [sys.executable, "-c", _COMPILED, str(harmonics)]
    done = subprocess.run(command, check=True, env=env, capture_output=True, text=True)
    assert float(done.stdout) < 2.0  # GB


def test_eps_over_seven_decades_in_one_batch():
    scene = scene_of(Hard(""))
    eps = 0.97 * np.geomspace(1e-1, 1e-8, 8)
    data = fx.sweep(scene, eps, [0.75, 1.0, 2.0, 4.0], TIMES)
    assert int(data.status.sel(gamma=[0.75, 1.0, 2.0]).max()) == 0
    # A viscosity of 1e-25: a force that rounds by 1e-16 N, squared over it, is a residual.
    assert set(data.status.values.ravel()) <= {fx.Status.OK, fx.Status.UNBALANCED}
    assert int(data.status.sel(gamma=4.0).where(data.eps > 1e-5, 0).max()) == 0
    assert np.all(np.isfinite(data.z))
    # Theorem 1: within some eps of the limit; at gamma < 1 within eps^gamma.
    bound = 5 * eps ** np.minimum(1.0, data.gamma.values)[:, None]
    assert np.all((data.sup_error.values < bound) | (data.status.values != 0))
    assert np.all(np.abs(data.z - data.z_limit).max("time").values < bound)


def test_a_failing_lane_disturbs_no_other():
    # eps^(1 + gamma) = 1e-320 underflows: that cell fails, its neighbours do not.
    scene = scene_of(Hard(""))
    alone = fx.sweep(scene, [0.05, 0.02], [1.0], TIMES)
    beside = fx.sweep(scene, [0.05, 0.02, 1e-8], [1.0, 39.0], TIMES)
    bad = beside.sel(gamma=39.0, eps=1e-8)
    assert int(bad.status) != 0
    assert np.isnan(float(bad.sup_error))
    for eps in (0.05, 0.02):
        gap = np.abs(beside.z.sel(gamma=1.0, eps=eps) - alone.z.sel(gamma=1.0, eps=eps))
        assert float(gap.max()) <= 1e-6 * eps
