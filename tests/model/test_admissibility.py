"""Every hypothesis of the paper is checked by name, and none raises a false alarm."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from samples import BRISTLES, Formula, pair

import frictionjax as fx
from frictionjax._checks.arguments import no_more
from frictionjax.model.admissibility import (
    is_admitted,
    largest_eps,
    require_admissible,
    require_convex,
    require_reach,
)
from frictionjax.numerics.extrema import smallest

SINE = fx.profiles.Sine(0.5)
NEARLY = 1.2 * (1 + 2e-16)  # a rest length of 1.2 but for rounding


@pytest.mark.parametrize(
    "bristle",
    [
        fx.bristles.VerticalSpring(1.0, 1.2, 1.2),
        fx.bristles.VerticalSpring(3.0, NEARLY, 1.2),
        fx.bristles.SlantedSpring(1.0, 1.2 / np.cos(0.7), 1.2, 0.7),
        fx.bristles.SlantedSpring(2.0, 1.2 / np.cos(0.3) * (1 + 2e-16), 1.2, 0.3),
        fx.bristles.AngularSpring(1.0, 1.5, 1.2, np.arccos(0.8) * (1 - 2e-16)),
    ],
)
def test_alpha_zero_is_named(bristle):
    with pytest.raises(ValueError, match=r"alpha = .*needs alpha = F'\(0\) != 0"):
        fx.friction(fx.profiles.Sine(0.1), bristle)


def line(slope):
    return Formula(jnp.multiply, jnp.asarray([slope]))


CASES = {
    "slanted, forward": (SINE, fx.bristles.SlantedSpring(1.0, 9.0, 1.0, 1.2)),
    "slanted, mirrored": (SINE, fx.bristles.SlantedSpring(1.0, 9.0, 1.0, -1.2)),
    "angular, the tip jumps": (SINE, fx.bristles.AngularSpring(1.0, 1.05, 1.0, 0.0)),
    "angular, the rod touches": (SINE, fx.bristles.AngularSpring(1.0, 3.0, 1.0, 0.0)),
    "custom, a > 0": (SINE, fx.bristles.Custom(line(2.1), line(1.0))),
    "custom, a < 0": (SINE, fx.bristles.Custom(line(-2.1), line(1.0))),
}
NAMES = {
    "slanted, forward": r"bristle.angle = 1.2: needs omega_plus < cot\(angle\)",
    "slanted, mirrored": r"bristle.angle = -1.2: needs omega_minus > cot\(angle\)",
    "angular, the tip jumps": r"theta_lim = .*omega_minus > -tan\(theta_lim\)",
    "angular, the rod touches": r"theta_lim = .*omega_plus < cot\(theta_lim\)",
    "custom, a > 0": r"bristle = .*1 \+ a omega_minus > 0",
    "custom, a < 0": r"bristle = .*1 \+ a omega_plus > 0",
}


@pytest.mark.parametrize("case", CASES)
def test_slopes_beyond_the_bristle_are_named(case):
    with pytest.raises(ValueError, match=NAMES[case]):
        fx.friction(*CASES[case])


def test_bounds_are_sharp():
    for share, fails in ((1 - 1e-9, False), (1 + 1e-9, True)):
        surface = fx.profiles.Sine(share / np.tan(1.2))
        spring = fx.bristles.SlantedSpring(1.0, 9.0, 1.0, 1.2)
        if fails:
            with pytest.raises(ValueError, match="omega_plus"):
                fx.friction(surface, spring)
        else:
            fx.friction(surface, spring)


_LESS = ("homothetic", "vertical", "custom")
_KINDS = [pytest.param(k, marks=pytest.mark.slow) if k in _LESS else k for k in BRISTLES]


@pytest.mark.parametrize("kind", _KINDS)
def test_no_false_alarm_on_random_parts(kind):
    for seed in range(20, 26):
        surface, bristle = pair("sine", kind, 1, seed)
        fx.friction(surface, bristle)
    orders = np.arange(1, 65)
    cos, sin = np.random.default_rng(1).normal(size=(2, 64)) / orders / 2000
    found = fx.friction(fx.profiles.Fourier(cos, sin), bristle)
    assert found.rho_plus > 0 > found.rho_minus


def brute_largest_eps(offset_slope, height, slope, upper):
    """By bisection on a grid of 2e5 heights and slopes."""
    low, high = 0.0, upper
    for _ in range(50):
        middle = 0.5 * (low + high)
        with np.errstate(invalid="ignore", divide="ignore"):
            smallest = np.min(np.asarray(1 + offset_slope(middle * height) * slope))
        low, high = (middle, high) if smallest > 0 else (low, middle)
    return low


REACH = {
    "angular": (fx.bristles.AngularSpring(1.0, 1.05, 1.0, -0.1), 0.2),
    "angular, short": (fx.bristles.AngularSpring(1.0, 1.0001, 1.0, -0.1), 0.01),
    "custom": (fx.bristles.Custom(lambda e: e + 4 * e**2, lambda e: e), 0.3),
}


@pytest.mark.parametrize("case", REACH)
def test_largest_eps_against_brute_force(case):
    bristle, size = REACH[case]
    surface = fx.profiles.Fourier([0.0, size / 40], [size / 7, 0.0])
    y = jnp.arange(200_000) / 200_000
    height, slope = np.asarray(surface(y)), np.asarray(jax.vmap(jax.grad(surface))(y))

    def offset_slope(eta):
        if case == "custom":
            return 1 + 8 * eta
        drop = bristle.height - eta
        return drop / np.sqrt(bristle.length**2 - drop**2)

    potential = fx.potential(surface, bristle)
    expected = brute_largest_eps(offset_slope, height, slope, 50.0)
    found = largest_eps(potential, 50.0)
    assert found == pytest.approx(expected, rel=1e-6)
    require_reach(potential, np.array([0.5, 1 - 1e-6]) * found)
    with pytest.raises(ValueError, match=f"eps = .*needs eps < {no_more(found)}, where G"):
        require_reach(potential, np.array([0.5, 1 + 1e-6]) * found)


def test_reach_is_seen_on_a_long_grid():
    # Minima of more than about 4000 values once hid the NaN beyond the rod's reach.
    assert np.isnan(smallest(jnp.ones(10_000).at[5].set(jnp.nan)))
    surface = fx.profiles.Custom(lambda y: 0.02 * jnp.cos(2 * jnp.pi * y), points=8192)
    rod = fx.bristles.AngularSpring(1.0, 1.05, 1.0, -0.1)
    limit = largest_eps(fx.potential(surface, rod), 50.0)
    coarse = fx.profiles.Fourier([0.02, 0.0], [0.0, 0.0])  # programs of the test above
    assert limit == pytest.approx(largest_eps(fx.potential(coarse, rod), 50.0), rel=1e-7)


@pytest.mark.parametrize(
    ("energy", "message"),
    [
        (
            lambda z: z**2 / 2 - 0.2 * jnp.cos(6 * z),
            "uniformly convex on the range reached",
        ),
        (lambda z: z**4 / 4, "uniformly convex"),
        (lambda z: jnp.log(jnp.cosh(z)), "Phi' to reach the forces"),
        (lambda z: -(z**2), "Phi"),
        # It said where its root was sought: z in [-1.6e150, 1.6e150].
        (jnp.cos, "= .Phi'' = -1 N/m at z = 0 m.: needs Phi uniformly convex"),
        (lambda z: jnp.sqrt(1 + z**2), r"= .Phi' in \[-1, 1\] N for .z. <= 1e\+06 m"),
    ],
)
def test_a_support_that_is_not_convex_is_named(energy, message):
    with pytest.raises(ValueError, match=f"support.*{message}"):
        fx.Scene(
            SINE,
            fx.bristles.Homothetic(0.3),
            fx.supports.Convex(energy),
            fx.loads.Sine(2.0, 1.0),
            duration=1.0,
        )


def test_a_state_of_ones_own_that_is_not_of_the_force_is_named():
    class Halved(fx.supports.AbstractSupport):
        def energy(self, z):
            return z**2 / 2

        def state_of(self, force):
            return force / 2

    message = r"Phi'\(state_of\) = \[-1, 1\].: needs .* forces \[-2, 2\]"
    with pytest.raises(ValueError, match=message):
        require_convex(Halved(), -2.0, 2.0)


def test_convexity_is_asked_for_where_the_load_reaches():
    def build(amplitude):
        dip = fx.supports.Convex(lambda z: z**2 / 2 + 2 * jnp.exp(-4 * (z - 5) ** 2))
        load = fx.loads.Sine(amplitude, 1.0)
        return fx.Scene(SINE, fx.bristles.Homothetic(0.3), dip, load, duration=1.0)

    build(2.0)
    with pytest.raises(ValueError, match="support"):
        build(6.0)


def scene(**change):
    parts = {
        "profile": SINE,
        "bristle": fx.bristles.Homothetic(1.0),
        "support": fx.supports.Spring(1.0),
        "load": fx.loads.Ramp(1.0),
        "duration": 1.0,
    }
    return fx.Scene(**{**parts, **change})


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"profile": 0.1}, "profile = 'float'"),
        ({"bristle": SINE}, "bristle = 'Sine'"),
        ({"support": 1.0}, "scene.support = 'float'"),
        ({"load": jnp.sin}, "scene.load = "),
        ({"duration": 0.0}, "scene.duration = 0: needs duration > 0"),
        ({"duration": None}, "scene.duration = None"),
        ({"duration": "long"}, "scene.duration = 'long'"),
        ({"z0": np.nan}, "scene.z0 = nan"),
        ({"z0": [0.0, 1.0]}, "scene.z0 = .*one number"),
        ({"effects": ("inertia",)}, "scene.effects = "),
        ({"effects": None}, "scene.effects = None"),
        (
            {"potential": fx.GivenPotential(lambda Y: jnp.sin(2 * jnp.pi * Y))},
            "scene.profile",
        ),
    ],
)
def test_wrong_parts_of_a_scene_are_named(change, message):
    with pytest.raises(ValueError, match=message):
        scene(**change)


def test_wrong_supports_are_named():
    for value in (0.0, -1.0, np.nan, "stiff"):
        with pytest.raises(ValueError, match=r"support.stiffness = .*stiffness > 0"):
            fx.supports.Spring(value)
    with pytest.raises(ValueError, match=r"support.energy = 3"):
        fx.supports.Convex(3.0)


def steep(ratio):
    """A sine whose largest slope is that share of cot(theta_lim), under a rod."""
    rod = fx.bristles.AngularSpring(1.0, 1.5, 1.0, 0.2)
    return fx.potential(fx.profiles.Sine(ratio / np.tan(float(rod.limit_angle))), rod)


def cuts(potential, eps):
    """Whether a rod is below the surface somewhere, by the lines themselves."""
    rod, count = potential.bristle, 2048
    y = np.arange(count) / count
    heights = np.asarray(potential.profile(jnp.asarray(np.concatenate([y, 1 + y]))))
    for index in range(count):
        angle = np.arccos((float(rod.height) - eps * heights[index]) / float(rod.length))
        ahead = np.arange(1, count)
        line = heights[index] + ahead / count / np.tan(angle)
        if np.any(heights[index + ahead] > line):
            return True
    return False


@pytest.mark.parametrize("ratio", [0.99, 0.998])
def test_a_rod_clears_the_surface_at_the_eps_in_use(ratio):
    potential = steep(ratio)
    largest = largest_eps(potential, 1.0)
    require_reach(potential, 0.99 * largest)
    with pytest.raises(
        ValueError, match=f"needs eps < {no_more(largest)}, where the rod cuts"
    ):
        require_reach(potential, 1.01 * largest)
    assert not cuts(potential, 0.98 * largest)
    assert cuts(potential, 1.1 * largest)


admitted = eqx.filter_jit(is_admitted)


def accepted(potential, eps):
    """The same by what says why not."""
    try:
        require_admissible(potential)
        require_reach(potential, eps)
    except ValueError:
        return False
    return True


def test_traced_numbers_are_admitted_where_known_ones_are_accepted():
    """Angles and slopes on both sides of the bounds."""
    seen = {True: 0, False: 0}
    rng = np.random.default_rng(39)
    for _ in range(60):
        angle, slope, second = rng.uniform([-1.5, 0.02, -0.6], [1.5, 1.5, 0.6])
        surface = fx.profiles.Fourier([0.0, 0.0], [slope / 6, second * slope / 12])
        potential = fx.potential(surface, fx.bristles.SlantedSpring(1.0, 9.0, 1.0, angle))
        eps = 10 ** rng.uniform(-2, 1)
        wanted = accepted(potential, eps)
        seen[wanted] += 1
        assert bool(admitted(potential, jnp.asarray(eps))) == wanted
    assert min(seen.values()) > 10


@pytest.mark.parametrize("case", CASES)
def test_traced_slopes_beyond_the_bristle_are_not_admitted(case):
    assert not admitted(fx.potential(*CASES[case]), jnp.asarray(1e-3))


def test_a_traced_bristle_that_does_not_press_is_not_admitted():
    for rest_length in (1.2, NEARLY):
        bristle = eqx.tree_at(
            lambda one: one.rest_length,
            fx.bristles.VerticalSpring(3.0, 2.0, 1.2),
            jnp.asarray(rest_length),
        )
        potential = fx.potential(fx.profiles.Sine(0.1), bristle)
        assert not admitted(potential, jnp.asarray(1e-3))


@pytest.mark.parametrize("ratio", [0.99, 0.998])
def test_a_traced_rod_that_cuts_the_surface_is_not_admitted(ratio):
    potential = steep(ratio)
    largest = largest_eps(potential, 1.0)
    for share in 0.99, 1.01:
        assert admitted(potential, jnp.asarray(share * largest)) == (share < 1)


def test_gentle_slopes_let_a_rod_clear_at_any_eps():
    assert largest_eps(steep(0.5), 1.0) == 1.0


def by_hand(energy, w, alpha):
    """Lemma 2's Q as it is printed: a small difference of large numbers."""
    return lambda eps, Y: (energy(eps * w(Y)) - energy(0.0) - alpha * eps * w(Y)) / eps**2


def small_sine(Y):
    return 0.1 / (2 * jnp.pi) * jnp.sin(2 * jnp.pi * Y)


def cosine(Y):
    return 0.2 * jnp.cos(2 * jnp.pi * Y)


spring = by_hand(lambda eta: 0.5 * (1 + eta) ** 2, small_sine, 1.0)
exponential = by_hand(lambda eta: jnp.exp(eta), small_sine, 1.0)


def root(eps, Y):
    return (jnp.sqrt(1.0 + eps**2 * small_sine(Y) ** 2) - 1.0) / eps**2


def lost_between(eps, Y, first, last):
    """Q by hand in a part of the period, without loss elsewhere."""
    part = (first < Y) & (last > Y)
    return jnp.where(part, exponential(eps, Y), 0.5 * small_sine(Y) ** 2)


def growing(eps, Y, size, power):
    return size * cosine(Y) / eps**power


def leaning(eps, Y, waves, slope):
    return 0.2 * jnp.cos(2 * jnp.pi * waves * Y) + slope * Y


# Functions of eps, Y and two numbers, which most leave.
MANY = {
    "spring": lambda eps, Y, *_: spring(eps, Y),
    "exponential": lambda eps, Y, *_: exponential(eps, Y),
    "root": lambda eps, Y, *_: root(eps, Y),
    "lost between": lost_between,
    "growing": growing,
    "leaning": leaning,
    "parabola": lambda eps, Y, *_: Y * (1 - Y),
    "exact": lambda eps, Y, *_: small_sine(Y) ** 2 / 2 + eps * small_sine(Y) ** 3,
    "logarithm": lambda eps, Y, *_: cosine(Y) * jnp.log(eps),
    "bounded": lambda eps, Y, *_: 1e-3 * cosine(Y) / (1e-4 + eps),
    "bump": lambda eps, Y, *_: jnp.exp(-(((Y - 0.4) / 2e-3) ** 2)),
    "kinks": lambda eps, Y, *_: jnp.abs(jnp.sin(2 * jnp.pi * Y - 1)),
}
LOST = [(-1.0, 0.4), (0.9, 2.0), (0.4, 0.6), (0.2, 0.27)]
REFUSED = [
    (("leaning", 1.1, 0.0), "Q jumps by 0.0382 at the seam"),
    (("leaning", 1.0, 1e-4), "Q jumps by 0.0001 at the seam"),
    (("parabola",), "its slope jumps by 2 at the seam"),
    (("growing", 1.0, 1.0), "126, 8 times as much at eps/8.*bounded as eps"),
    (("growing", 1.0, 0.5), "2.83 times as much at eps/8"),
    (("growing", 1e-6, 2.0), "64 times as much at eps/8"),
]
TAKEN = [
    (("exact",), [0.5, 1e-9]),
    (("logarithm",), [0.3, 0.01, 1e-10]),
    (("bounded",), [0.1]),
    (("growing", 1e-15, 1.0), [1e-3]),
    (("bump",), [1e-6]),
    (("kinks",), [1e-5]),
    (("exponential",), [1e-4, 1e-5]),
]


class OneOfMany(eqx.Module):
    """One of `MANY`, by its place: each as it is were a program of its own."""

    which: jax.Array
    numbers: jax.Array

    def __call__(self, eps, Y):
        which = self.which.astype(int)
        return jax.lax.switch(which, [*MANY.values()], eps, Y, *self.numbers)


def given(name, *numbers):
    """A sine with that Q of `MANY`."""
    which = jnp.asarray(list(MANY).index(name), float)
    return fx.GivenPotential(small_sine, OneOfMany(which, jnp.array(numbers or (0.0, 0.0))))


@pytest.mark.parametrize("case", ["spring", "exponential", "root"])
def test_a_Q_that_loses_its_digits_is_refused_where_it_does(case):
    potential = given(case)
    require_reach(potential, np.array([0.1, 0.01]))
    with pytest.raises(ValueError, match=r"potential\.Q at eps = 1e-08: noise over"):
        require_reach(potential, np.array([1e-8]))
    with pytest.raises(ValueError, match=r"potential\.Q at eps = 1e-07: noise over"):
        require_reach(potential, np.array([0.1, 1e-6, 1e-7]))


def test_a_Q_that_keeps_its_digits_is_taken_at_any_eps():
    exact = fx.GivenPotential(small_sine, lambda eps, Y: 0.5 * small_sine(Y) ** 2)
    require_reach(exact, np.geomspace(0.1, 1e-12, 8))
    kinked = fx.GivenPotential(lambda Y: 0.01 * jnp.abs(jnp.sin(2 * jnp.pi * Y)) ** 2.5)
    require_reach(kinked, np.array([1e-3]))


@pytest.mark.parametrize(
    "W",
    [
        lambda Y: jnp.sqrt(1e20 + 2e10 * small_sine(Y)) - 1e10,
        lambda Y: small_sine(Y) + 1e-8 * jnp.sin(2**40 * Y),
    ],
)
def test_a_W_that_loses_its_digits_is_refused(W):
    with pytest.raises(ValueError, match=r"potential\.W"):
        require_reach(fx.GivenPotential(W), np.array([1e-3]))


@pytest.mark.parametrize("ends", LOST)
def test_digits_lost_on_a_part_of_the_period_are_seen(ends):
    with pytest.raises(ValueError, match=r"potential\.Q at eps = 1e-07: noise over"):
        require_reach(given("lost between", *ends), np.array([1e-7]))


@pytest.mark.parametrize(("Q", "message"), REFUSED)
def test_a_Q_that_is_not_periodic_or_not_bounded_is_refused(Q, message):
    with pytest.raises(ValueError, match=rf"potential\.Q at eps = 0\.01 = .*{message}"):
        require_reach(given(*Q), np.array([0.1, 0.01]))


@pytest.mark.parametrize(("Q", "sizes"), TAKEN)
def test_a_bounded_Q_with_kinks_bumps_or_a_logarithm_is_taken(Q, sizes):
    potential = given(*Q)
    for size in sizes:
        require_reach(potential, np.array([size]))
