"""Inverse design of a bristle: every target met, every solution found, or told why not."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from samples import Formula, bristle, central, profile

import frictionjax as fx
from frictionjax.design.bristle import angle
from frictionjax.design.bristle.status import FitStatus
from frictionjax.design.common.quantities import (
    QUANTITIES,
    Slopes,
    on_slopes,
    quantity_of,
)

SINE = fx.profiles.Sine(0.1)
WAVES = fx.profiles.Fourier(cos=[0.01, 0.004, 0.0], sin=[0.02, 0.0, -0.003])
SLANTED = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0)
ANGULAR = fx.bristles.AngularSpring(1.0, 2**0.5, 1.0, 0.3)
NAN = float("nan")

# Model, the number that is free, and by what factor it is wrong at the start.
DESIGNS = (
    ("slanted", "angle", 0.5),
    ("angular", "angle", 1.2),
    ("vertical", "height", 0.8),
    ("homothetic", "alpha", 3.0),
    ("custom", "offset_fn.numbers[0]", -0.3),
)
WANTED = {"vertical": ("rho_plus", "rho_minus", "difference")}
WANTED["homothetic"] = WANTED["vertical"]


def law_of(name, found):
    values = {"rho_plus": found.rho_plus, "rho_minus": found.rho_minus}
    values["ratio"] = -found.rho_plus / found.rho_minus
    values["difference"] = found.rho_plus + found.rho_minus
    return float(values[name])


def with_number(free, part, value):
    """The bristle with another number, by its constructor where it has one."""
    if isinstance(part, fx.bristles.Custom):
        numbers = part.offset_fn.numbers.at[0].set(value)
        return eqx.tree_at(lambda b: b.offset_fn.numbers, part, numbers)
    numbers = {k: float(v) for k, v in vars(part).items()}
    if isinstance(part, fx.bristles.AngularSpring) and free == "angle":
        numbers["height"] = numbers["length"] * np.cos(value)
    else:
        numbers[free] = value
    return type(part)(**numbers)


def number_of(free, part):
    if isinstance(part, fx.bristles.AngularSpring) and free == "angle":
        return float(part.limit_angle)
    numbers = part.offset_fn.numbers[0] if "numbers" in free else getattr(part, free)
    return float(numbers)


@pytest.mark.parametrize(
    ("kind", "free", "factor"),
    [
        pytest.param(*one, marks=pytest.mark.slow) if one[0] != "angular" else one
        for one in DESIGNS
    ],
)
def test_random_reachable_targets_are_met(kind, free, factor):
    rng = np.random.default_rng(5)
    worst = 0.0
    for trial in range(40):
        surface = profile("fourier", rng, 0.1)
        true = bristle(kind, rng, rng.choice([-1, 1]))
        law = fx.friction(surface, true)
        start = with_number(free, true, factor * number_of(free, true))
        names = WANTED.get(kind, QUANTITIES)
        name = names[trial % len(names)]
        target = law_of(name, law)
        found = fx.fit_angle(surface, start, free=free, pulling=True, **{name: target})
        assert found.success, found.message
        got = law_of(name, fx.friction(surface, found.bristle))
        worst = max(worst, abs(got / target - 1))
        known, value = number_of(free, true), float(found.value)
        gaps = np.abs(np.asarray(found.solutions) - known)
        assert gaps.min() < 1e-7 * max(1.0, abs(known)), found.message
        assert number_of(free, found.bristle) == pytest.approx(value, rel=1e-9)
        same = law_of(name, fx.friction(surface, with_number(free, true, value)))
        assert same == pytest.approx(target, rel=1e-9)  # the constructor takes it
    assert worst < 1e-11


def scanned(part, free, name, values):
    """The quantity by constructors and `on_slopes`, NaN where nothing is admissible."""
    slopes = Slopes(jnp.asarray(0.1), jnp.asarray(-0.1))
    which = QUANTITIES.index(name)

    @jax.jit
    def one(value):
        bent = eqx.tree_at(lambda b: getattr(b, free), part, value)
        found = on_slopes(bent, slopes)
        value = quantity_of(found, which)
        return jnp.where(found.margin > 0, value, jnp.nan), jnp.sign(found.alpha)

    return [np.asarray(v) for v in jax.vmap(one)(jnp.asarray(values))]


def test_all_solutions_are_found():
    values = np.linspace(-1.5, 1.5, 400_001)
    known, side = scanned(SLANTED, "angle", "rho_plus", values)
    for target in (0.003, 0.05, 0.153, 0.16, 0.7, 3.8, 5.0):
        rest = np.sign(known - target)
        crosses = (rest[:-1] * rest[1:] < 0) & (side[:-1] == side[1:])
        found = fx.fit_angle(SINE, SLANTED, rho_plus=target, pulling=True)
        assert found.status == FitStatus.OK
        np.testing.assert_allclose(found.solutions, values[:-1][crosses], atol=1e-5)
        nearest = np.argmin(np.abs(found.solutions - 1.0))
        assert found.value == found.solutions[nearest]


def test_reachable_intervals_and_their_ends():
    values = np.linspace(-1.4711276, 1.4711276, 400_001)
    for name in QUANTITIES:
        known, side = scanned(SLANTED, "angle", name, values)
        found = fx.fit_angle(SINE, SLANTED, pulling=True, **{name: _some(name)})
        pieces = (values < -1.1410209, np.abs(values) < 1.1410209, values > 1.1410209)
        for (low, high), piece in zip(found.reachable, pieces, strict=False):
            inside = known[piece]
            assert np.all(side[piece] == side[piece][0])
            finite = [v for v in (low, high) if np.isfinite(v)]
            ends = [np.min(inside), np.max(inside)]
            for value, end in zip((low, high), ends, strict=True):
                assert not np.isfinite(value) or value == pytest.approx(end, abs=2e-5)
            assert finite or name == "difference"
            if not np.isfinite(high):
                assert np.max(inside) > 1e3
        # To the angles at which alpha = 0, and at which a tip jumps.
        zero, jump = np.arccos(1 / 2.4), np.arctan(10.0)
        ends = [[-jump, -zero], [-zero, zero], [zero, jump]]
        np.testing.assert_allclose(found.admissible[:3], ends, rtol=1e-14)


def _some(name):
    return {"rho_minus": -0.05}.get(name, 0.05)


def test_what_a_number_does_not_change_is_told():
    slanted = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0)
    law = fx.friction(SINE, slanted)
    own = float(-law.rho_plus / law.rho_minus)
    found = fx.fit_angle(SINE, slanted, ratio=1.5, free="stiffness")
    assert found.status == FitStatus.UNREACHABLE
    assert found.message.endswith(f"it is {own:.6g} at every stiffness allowed")


def test_at_the_ends_of_the_reachable_interval():
    top = float(fx.fit_angle(SINE, ANGULAR, ratio=0.9).reachable[0, 1])
    assert fx.fit_angle(SINE, ANGULAR, ratio=top * (1 - 1e-12)).success
    beyond = fx.fit_angle(SINE, ANGULAR, ratio=top * (1 + 1e-9))
    assert not beyond.success
    assert beyond.status == FitStatus.UNREACHABLE
    assert beyond.solutions.size == 0
    assert beyond.achieved == pytest.approx(top, rel=1e-12)
    assert f"{top:.6g}" in beyond.message
    assert "cannot be reached by angle" in beyond.message
    law = fx.friction(SINE, beyond.bristle)  # the best one is admissible
    assert -law.rho_plus / law.rho_minus == pytest.approx(top, rel=1e-12)


def test_two_solutions_that_meet():
    # rho_plus over rest_length and height is monotone; over the angle it turns at a top.
    best = fx.fit_angle(SINE, SLANTED, rho_plus=0.1, bounds=(-1.14, 1.14)).reachable[0]
    other = fx.fit_angle(SINE, SLANTED, rho_plus=0.1, bounds=(-1.14, 0.9)).reachable[0]
    top = float(min(best[1], other[1]))
    bounds = (-1.14, 1.14)
    met = fx.fit_angle(SINE, SLANTED, rho_plus=top, bounds=bounds)
    assert met.status == FitStatus.TANGENT
    assert met.success
    assert met.solutions.size == 1
    assert not np.isfinite(met.sensitivities.target) or abs(met.sensitivities.target) > 1e6
    for nearly in (top * (1 + 4e-15), top * (1 - 4e-15)):  # within its rounding
        again = fx.fit_angle(SINE, SLANTED, rho_plus=nearly, bounds=bounds)
        assert again.status == FitStatus.TANGENT
        assert again.solutions.size == 1
    below = fx.fit_angle(SINE, SLANTED, rho_plus=top * (1 - 1e-10), bounds=bounds)
    assert below.solutions.size == 2
    assert np.diff(below.solutions) < 1e-3
    above = fx.fit_angle(SINE, SLANTED, rho_plus=top * (1 + 1e-10), bounds=bounds)
    assert above.status == FitStatus.UNREACHABLE


def test_intervals_narrower_than_the_scan_are_found():
    # alpha > 0 only for |angle| < arccos(height/rest_length) = 1.4e-4.
    nearly = fx.bristles.SlantedSpring(1.0, 1.0 + 1e-8, 1.0, 0.4)
    bounds = (-1.3, 1.0)  # samples then miss the angle 0
    found = fx.fit_angle(SINE, nearly, rho_plus=5e-10, bounds=bounds)
    width = np.arccos(1 / (1 + 1e-8))
    inside = np.abs(found.admissible[:3, 0] + width) < 1e-8
    assert inside.any()
    assert np.sum(np.abs(found.solutions) < width) == 2
    # Slopes of 1 - 1e-6 leave theta_lim 1e-6 on either side of pi/4.
    other = fx.bristles.AngularSpring(1.0, 1.25, 1.0, 0.3)
    surface = fx.profiles.Sine(1 - 1e-6)
    steep = fx.fit_angle(surface, other, ratio=1e-3, bounds=(0.1, 1.4))
    np.testing.assert_allclose(
        steep.admissible[0], np.pi / 4 + 5e-7 * np.array([-1, 1]), rtol=0, atol=1e-12
    )


def test_differences_next_to_0_are_met_to_rounding_of_the_forces():
    rod = fx.bristles.AngularSpring(3.7e-4, 0.0043, 0.0022, -0.31)
    surface = fx.profiles.Fourier([0.004, -0.0013], [-0.011, 0.0021])
    fits = fx.fit_angle(surface, rod, difference=[0.0, 1e-9, -1e-12, 0.002])
    assert list(fits.status) == [FitStatus.OK] * 4
    assert np.all(fits.success)
    np.testing.assert_allclose(fits.achieved, fits.target, rtol=0, atol=1e-15)


def test_a_quantity_that_does_not_depend_on_the_number():
    law = fx.friction(SINE, SLANTED)
    ratio = float(-law.rho_plus / law.rho_minus)
    same = fx.fit_angle(SINE, SLANTED, ratio=ratio, free="stiffness")
    assert same.status == FitStatus.INDIFFERENT
    assert same.success
    assert same.value == 1.0
    other = fx.fit_angle(SINE, SLANTED, ratio=1.1 * ratio, free="stiffness")
    assert other.status == FitStatus.UNREACHABLE
    np.testing.assert_allclose(other.reachable[0], ratio, rtol=1e-12)
    assert "every admissible value gives it" in same.message
    near = fx.fit_angle(SINE, SLANTED, ratio=ratio * (1 + 1e-8), free="stiffness")
    assert near.status == FitStatus.UNREACHABLE
    asked, _, given = near.message.removeprefix("ratio = ").partition(" cannot be")
    shown = given.partition("it is ")[2].partition(" at every")[0]
    assert float(asked) > float(shown)


def test_where_a_number_changes_nothing_but_on_the_other_side_of_alpha_0():
    """At the height 1.7 cos(0.4) = 1.566 the bristle stops pressing, and pulls beyond."""
    waves = fx.profiles.Fourier([0.01, 0.0], [0.005, 0.004])
    bristle = fx.bristles.SlantedSpring(3.0, 1.7, 1.0, 0.4)
    edge = 1.7 * np.cos(0.4)
    ways = {"free": "height", "pulling": True}
    presses = fx.fit_angle(waves, bristle, ratio=fx.friction(waves, bristle).ratio, **ways)
    assert presses.status == FitStatus.INDIFFERENT
    assert presses.value == 1.0
    assert "every height in (0.0001, 1.5658) gives it: the quantity" in presses.message
    beyond = fx.friction(waves, bristle.replace(height=2.0))
    pulls = fx.fit_angle(waves, bristle, ratio=beyond.ratio, **ways)
    assert pulls.status == FitStatus.INDIFFERENT
    assert edge < pulls.value < edge * (1 + 2e-4)
    assert pulls.alpha < 0
    assert float(pulls.achieved) == pytest.approx(float(beyond.ratio), rel=1e-9)
    assert "every height in (1.5658, 10000) gives it: the quantity" in pulls.message


def test_a_batch_equals_its_lanes_alone():
    targets = np.append(np.linspace(0.3, 1.7, 6), 50.0)
    batch = fx.fit_angle(SINE, ANGULAR, ratio=targets)
    assert batch.value.shape == batch.success.shape == (7,)
    assert batch.success.any()
    assert not batch.success.all()
    for index in range(7):
        alone = fx.fit_angle(SINE, ANGULAR, ratio=targets[index])
        assert alone.status == batch.status[index]
        assert batch.message[index] == alone.message
        lane = batch[index]
        for name in ("value", "achieved", "solutions"):
            both = getattr(lane, name), getattr(alone, name)
            np.testing.assert_allclose(*both, rtol=1e-14, err_msg=name)
        np.testing.assert_allclose(lane.bristle.height, alone.bristle.height, rtol=1e-14)


def test_more_targets_than_are_solved_side_by_side(monkeypatch):
    few = angle.SETTINGS._replace(side_by_side=8)
    monkeypatch.setattr(angle, "SETTINGS", few)
    targets = np.linspace(0.56, 0.97, 21)
    many = fx.fit_angle(SINE, ANGULAR, ratio=targets)
    some = fx.fit_angle(SINE, ANGULAR, ratio=targets[14:18])
    np.testing.assert_allclose(many.value[14:18], some.value, rtol=1e-14)
    assert many.success.shape == many.bristle.length.shape == (21,)
    assert many.roots.shape[0] == 21
    assert many.success.all()


def solved(p, free, build):
    surface, part = build(p)
    return fx.fit_angle(surface, part, ratio=p[0], free=free).value


def waves_slanted(p):
    return fx.profiles.Fourier(p[1:3], p[3:5]), fx.bristles.SlantedSpring(*p[5:])


def waves_angular(p):
    return fx.profiles.Fourier(p[1:3], p[3:5]), fx.bristles.AngularSpring(*p[5:])


CASES = {
    "angle": (waves_slanted, [1.4, 0.01, 0.004, 0.02, -0.003, 1.5, 2.4, 1.0, 0.6]),
    "length": (waves_angular, [0.75, 0.01, 0.004, 0.02, -0.003, 1.5, 1.6, 1.0, 0.2]),
}


SIDES = ("plus", "minus")


def by_slope(part, free, slopes, ratio, which):
    """Central difference by one extreme slope, on surfaces that have just these."""

    def solved(step):
        plus, minus = (float(v) + step * (i == which) for i, v in enumerate(slopes))
        return float(
            fx.fit_angle(two_slopes(plus, minus), part, ratio=ratio, free=free).value
        )

    return float(central(solved, 0.0, 1e-4))


def two_slopes(plus, minus):
    """A surface with these extreme slopes: w' = c1 cos + c2 cos of twice the angle."""
    # w' at 0 and 1/2 is c2 +- c1, the only turns while |c2| < |c1|/4.
    first, second = 0.5 * (plus - minus), 0.5 * (plus + minus)
    assert abs(second) < abs(first) / 4
    return fx.profiles.Fourier([0.0, 0.0], np.array([first, second / 2]) / (2 * np.pi))


@pytest.mark.parametrize(
    "free",
    ["angle", *(pytest.param(f, marks=pytest.mark.slow) for f in CASES if f != "angle")],
)
def test_sensitivities_are_central_differences(free):
    build, numbers = CASES[free]
    p = np.asarray(numbers)

    def fn(p):
        return solved(p, free, build)

    slopes = [central(lambda s, e=e: fn(p + s * e), 0.0, 1e-4) for e in np.eye(p.size)]
    slopes = np.asarray(slopes)
    np.testing.assert_allclose(jax.grad(fn)(jnp.asarray(p)), slopes, rtol=1e-7, atol=1e-9)
    surface, part = build(p)
    found = fx.fit_angle(surface, part, ratio=p[0], free=free).sensitivities
    assert repr(found).startswith(f"Sensitivities(\n  target={float(found.target):.6g},")
    assert found.target == pytest.approx(slopes[0], rel=1e-7)
    own = jnp.concatenate([found.profile.cos, found.profile.sin])
    np.testing.assert_allclose(own, slopes[1:5], rtol=1e-7)
    for at, name in enumerate(vars(part), start=5):
        if name == free:
            continue
        assert getattr(found.bristle, name) == pytest.approx(slopes[at], abs=1e-8)
    lane = Slopes(*(getattr(fx.friction(surface, part), f"omega_{s}") for s in SIDES))
    assert found.omega_plus == pytest.approx(by_slope(part, free, lane, numbers[0], 0))
    assert found.omega_minus == pytest.approx(by_slope(part, free, lane, numbers[0], 1))
    batch = fx.fit_angle(surface, part, ratio=np.array([numbers[0]] * 2), free=free)
    np.testing.assert_allclose(batch.sensitivities.target, slopes[0], rtol=1e-7)


@pytest.mark.slow
def test_sensitivities_of_a_batch_are_those_of_its_targets():
    batch = fx.fit_angle(WAVES, SLANTED, ratio=np.array([1.1, 1.3, 1.2]))
    many = batch.sensitivities
    one = batch[1].sensitivities
    assert "f64[" not in repr(many)
    lane = jax.tree_util.tree_map(lambda leaf: leaf[1], many)
    for found, expected in zip(*map(jax.tree_util.tree_leaves, (lane, one)), strict=True):
        np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-14)
    assert many.profile.cos.shape == (3, 3)
    assert many.target[0] != many.target[2]


@pytest.mark.slow  # third derivatives of a profile, 20 s to compile
def test_sensitivities_have_derivatives_where_they_are_traced():
    part = fx.bristles.SlantedSpring(1.5, 2.4, 1.0, 0.6)

    def slope(wave):
        surface = fx.profiles.Fourier([0.01, 0.004], [0.02, wave])
        found = fx.fit_angle(surface, part, ratio=1.4).sensitivities
        return found.profile.sin[0]

    expected = float(central(slope, -0.003, 1e-5))
    assert float(jax.jit(jax.grad(slope))(-0.003)) == pytest.approx(expected, rel=1e-6)


@pytest.mark.slow  # a program of its own
def test_a_batch_of_bristles():
    """`vmap` over bristles, and derivatives inside of it, as one after the other."""

    def angle(rest):
        part = fx.bristles.SlantedSpring(1.0, rest, 1.0, 0.9)
        return fx.fit_angle(WAVES, part, rho_plus=0.15).value

    rests = jnp.array([2.2, 2.4, 2.7])
    both = jax.jit(jax.vmap(jax.value_and_grad(angle)))
    values, slopes = both(rests)
    np.testing.assert_allclose(values, [angle(float(rest)) for rest in rests], rtol=1e-13)
    part = fx.bristles.SlantedSpring(1.0, rests[1], 1.0, float(values[1]))
    assert fx.friction(WAVES, part).rho_plus == pytest.approx(0.15, rel=1e-12)
    differences = central(lambda moved: both(moved)[0], rests, 1e-4)
    np.testing.assert_allclose(slopes, differences, rtol=1e-7)


@pytest.mark.slow  # programs of its own
def test_a_bristle_of_ones_own():
    class Leaning(fx.bristles.AbstractBristle):
        lean: float
        press: tuple

        def offset(self, eta):
            return self.lean * eta

        def energy(self, eta):
            return self.press[0] * eta + self.press[1] * eta**2

    found = fx.fit_angle(SINE, Leaning(0.2, (1.0, 3.0)), ratio=1.5, free="lean")
    assert found.value == pytest.approx(-2.0, rel=1e-12)  # 1.5 (1 + 0.1 a) = 1 - 0.1 a
    with pytest.raises(ValueError, match=r"free = 'angle': needs one of lean, press\.0"):
        fx.fit_angle(SINE, Leaning(0.2, (1.0, 3.0)), ratio=1.5)
    twice = fx.bristles.Custom(
        Formula(lambda eta, c: c * eta, jnp.asarray([0.1])),
        Formula(lambda eta, c: c * eta, jnp.asarray([1.0])),
    )
    with pytest.raises(ValueError, match=r"free = 'numbers\[0\]': needs one of offset_fn"):
        fx.fit_angle(SINE, twice, ratio=1.5, free="numbers[0]")


@pytest.mark.parametrize(
    ("wanted", "words"),
    [
        ({}, "targets = 'none': needs exactly one of rho_plus"),
        ({"ratio": 1.0, "rho_plus": 1.0}, "targets = 'rho_plus, ratio': needs exactly one"),
        ({"ratio": NAN}, "ratio = nan: needs finite"),
        ({"ratio": -1.0}, "ratio = -1: needs ratio > 0"),
        ({"ratio": [1.0, 0.0]}, r"ratio = \[1. 0.\]: needs ratio > 0"),
        ({"ratio": [[1.0]]}, r"ratio = \[\[1.\]\]: needs one number or an array of shape"),
        ({"ratio": []}, r"ratio = \[\]: needs one number or an array"),
        ({"ratio": "steep"}, "ratio = 'steep': needs one number"),
        ({"rho_plus": -0.1}, "rho_plus = -0.1: needs rho_plus > 0"),
        ({"rho_minus": 0.1}, "rho_minus = 0.1: needs rho_minus < 0"),
        ({"difference": np.inf}, "difference = inf: needs finite"),
        ({"ratio": 1.1, "free": "colour"}, "free = 'colour': needs one of stiffness"),
        ({"ratio": 1.1, "bounds": 3.0}, "bounds = 3: needs a pair"),
        ({"ratio": 1.1, "bounds": (1.0, 0.0)}, r"bounds = \[1. 0.\]: needs a pair"),
        ({"ratio": 1.1, "bounds": (0.0, NAN)}, r"bounds = \[ 0. nan\]: needs a pair"),
        ({"ratio": 1.1, "bounds": (2.0, 3.0)}, r"bounds = \[2. 3.\]: needs a part of"),
        ({"ratio": 1.1, "bounds": (1.5, 1.55)}, "none is admissible"),
    ],
)
def test_wrong_arguments_are_named(wanted, words):
    with pytest.raises(ValueError, match=words):
        fx.fit_angle(SINE, SLANTED, **wanted)


def test_parts_that_cannot_do_it_are_named():
    with pytest.raises(ValueError, match="bristle = 'AngularSpring': needs some angle"):
        fx.fit_angle(fx.profiles.Sine(1.5), ANGULAR, ratio=0.9)
    with pytest.raises(ValueError, match="profile = 'SlantedSpring'"):
        fx.fit_angle(SLANTED, SINE, ratio=0.9)
    with pytest.raises(ValueError, match="free = 'angle': needs one of alpha"):
        fx.fit_angle(SINE, fx.bristles.Homothetic(1.0), rho_plus=0.9)
