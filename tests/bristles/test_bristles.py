"""The two functions of every bristle, against the paper's geometry."""

import re

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from samples import BRISTLES, bristle, central

import frictionjax as fx

ETA = np.array([-0.05, -1e-3, 0.0, 1e-6, 0.03])


@eqx.filter_jit
def offsets_and_energies(part):
    return jax.vmap(part.offset)(ETA), jax.vmap(part.energy)(ETA)


@pytest.mark.parametrize("kind", BRISTLES)
def test_offset_vanishes_on_the_flat_and_both_are_smooth(kind):
    part = bristle(kind, np.random.default_rng(0), 1)
    assert part.offset(jnp.zeros(())) == 0

    @jax.jit  # 22 values of it, by one program
    def both(etas):
        fns = part.offset, part.energy
        slopes = [jax.vmap(jax.grad(fn))(etas) for fn in fns]
        return jnp.stack([jax.vmap(fn)(etas) for fn in fns]), jnp.stack(slopes)

    known = central(lambda etas: both(etas)[0], ETA, 1e-3)
    np.testing.assert_allclose(both(ETA)[1], known, atol=1e-11)


def test_slanted_spring_is_a_spring_along_its_line():
    part = fx.bristles.SlantedSpring(2.0, 1.5, 1.0, 0.4)
    root, direction = np.array([0.0, 1.0]), np.array([np.sin(0.4), -np.cos(0.4)])
    length = (1.0 - ETA) / np.cos(0.4)
    tips = root + length[:, None] * direction
    np.testing.assert_allclose(tips[:, 1], ETA, atol=1e-15)
    flat = np.tan(0.4)  # of the tip at eta = 0, ahead of the root
    offset, energy = offsets_and_energies(part)
    np.testing.assert_allclose(offset, flat - (2 * flat - tips[:, 0]), atol=1e-15)
    np.testing.assert_allclose(energy, (1.5 - length) ** 2, rtol=1e-14)


def test_angular_spring_is_a_rod_of_fixed_length():
    part = fx.bristles.AngularSpring(2.0, 1.25, 1.0, 0.1)
    reach = np.sqrt(1.25**2 - (1 - ETA) ** 2)
    offset, energy = offsets_and_energies(part)
    np.testing.assert_allclose(offset, reach - 0.75, atol=2e-16)
    angle = np.arccos((1 - ETA) / 1.25)
    np.testing.assert_allclose(energy, (angle - 0.1) ** 2, rtol=1e-14)
    assert float(part.limit_angle) == pytest.approx(np.arccos(0.8), rel=1e-15)
    lower, upper, *_ = part.slope_bounds()
    np.testing.assert_allclose([lower, upper], [-0.75, 4 / 3], rtol=1e-15)


def test_angular_spring_nearly_upright_in_exact_arithmetic():
    from decimal import Decimal, getcontext

    getcontext().prec = 60
    L, h = Decimal(1), Decimal(1.0 - 1e-9)
    part = fx.bristles.AngularSpring(1.0, 1.0, 1.0 - 1e-9, -0.3)
    for eta in (1e-9, -5e-10, 1e-14, 1e-20):
        drop = h - Decimal(eta)
        exact = (L * L - drop * drop).sqrt() - (L * L - h * h).sqrt()
        assert float(part.offset(jnp.asarray(eta))) == pytest.approx(
            float(exact), rel=1e-14
        )


def test_vertical_and_homothetic_do_not_lean():
    for part in (fx.bristles.VerticalSpring(1.0, 1.2, 1.0), fx.bristles.Homothetic(-2.0)):
        assert not np.any(part.offset(ETA))
    np.testing.assert_allclose(fx.bristles.Homothetic(-2.0).energy(ETA), -2 * ETA)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: fx.bristles.Homothetic(0.0), "bristle.alpha = 0: needs alpha != 0"),
        (lambda: fx.bristles.Homothetic(np.nan), "bristle.alpha = nan"),
        (lambda: fx.bristles.Homothetic("1"), "bristle.alpha = '1': needs a number"),
        (lambda: fx.bristles.Homothetic([1.0, 2.0]), "bristle.alpha = .*one number"),
        (lambda: fx.bristles.VerticalSpring(-1, 1, 1), "bristle.stiffness = -1"),
        (lambda: fx.bristles.VerticalSpring(1, 0, 1), "bristle.rest_length = 0"),
        (lambda: fx.bristles.VerticalSpring(1, 1, None), "bristle.height = None"),
        (lambda: fx.bristles.SlantedSpring(1, 1, 1, 1.6), "bristle.angle = 1.6: .*pi/2"),
        (lambda: fx.bristles.SlantedSpring(1, 1, np.inf, 0), "bristle.height = inf"),
        (lambda: fx.bristles.AngularSpring(1, 1, 2, 0), "bristle.length = 1: .*height = 2"),
        (lambda: fx.bristles.AngularSpring(1, 1, 1, 0), "bristle.length = 1"),
        (
            lambda: fx.bristles.AngularSpring(1, 2, 1, 1.1),
            "bristle.rest_angle = 1.1: needs",
        ),
        (lambda: fx.bristles.AngularSpring(1, 2, 1, -1.6), "bristle.rest_angle = -1.6"),
        (lambda: fx.bristles.AngularSpring(0, 2, 1, 0), "bristle.stiffness = 0"),
        (lambda: fx.bristles.Custom(1.0, jnp.sin), "bristle.offset = 1"),
        (lambda: fx.bristles.Custom(jnp.sin, None), "bristle.energy = None"),
        (lambda: fx.bristles.Custom(jnp.cos, jnp.sin), "bristle.offset = 1: .*A.0. = 0"),
        (lambda: fx.bristles.Custom(jnp.sin, jnp.cos), "bristle.energy = .*alpha"),
        (lambda: fx.bristles.Custom(jnp.sin, jnp.sqrt), "bristle.energy = inf"),
        (lambda: fx.bristles.Custom(jnp.sin, lambda e: e * jnp.ones(2)), r"shape \(2,\)"),
    ],
)
def test_wrong_parameters_are_named(make, message):
    with pytest.raises(ValueError, match=message):
        make()


@pytest.mark.parametrize(
    ("part", "constant"),
    [
        (fx.bristles.VerticalSpring(1.0, 1.2, 1.0), 0.0),
        (fx.bristles.SlantedSpring(2.0, 1.5, 1.0, -0.4), np.tan(0.4)),
        (fx.bristles.AngularSpring(2.0, 1.25, 1.0, 0.1), -0.75),
    ],
)
def test_the_tip_hangs_from_the_root_by_its_geometry(part, constant):
    """z = u + c, and from u along the bristle to p (eqs. of Sections 3.1 to 3.3)."""
    assert float(part.root_constant()) == pytest.approx(constant, rel=1e-15)
    stands = part.geometry(ETA)
    u = part.offset(ETA) - constant  # of tips at p = 0
    np.testing.assert_allclose(u, stands.length * np.sin(stands.angle), atol=1e-15)
    np.testing.assert_allclose(1.0 - ETA, stands.length * np.cos(stands.angle), rtol=1e-15)


def test_bristles_of_two_functions_have_no_geometry():
    for part in (fx.bristles.Homothetic(1.0), fx.bristles.Custom(jnp.sin, jnp.exp)):
        assert part.geometry(ETA) is None
        assert float(part.root_constant()) == 0


class Mine(fx.bristles.AbstractBristle):
    """A bristle of a class of one's own."""

    start: float = 0.0

    def offset(self, eta):
        return self.start - 1.5 * eta

    def energy(self, eta):
        return jnp.exp(eta)


MINE = {
    "tuple": (lambda self, eta: (eta,), r"energy = 'values of shape \(1,\)'"),
    "numpy": (lambda self, eta: np.exp(eta), r"energy = Mine\(\).*jax\.numpy"),
    "no force": (lambda self, eta: eta**2, r"energy = 0: needs alpha = F'\(0\) != 0"),
}


@pytest.mark.parametrize("case", MINE)
def test_a_class_of_ones_own_is_checked(monkeypatch, case):
    energy, message = MINE[case]
    monkeypatch.setattr(Mine, "energy", energy)
    with pytest.raises(ValueError, match=rf"bristle: Mine\.{message}"):
        Mine()


def test_an_offset_of_ones_own_starts_at_0_but_for_rounding():
    with pytest.raises(ValueError, match=r"bristle: Mine\.offset = 1: needs A\(0\) = 0"):
        Mine(1.0)
    assert Mine(1e-16).energy(0.0) == 1.0
    assert jax.vmap(lambda x: Mine(x).offset(0.0))(jnp.ones(2)).tolist() == [1.0, 1.0]


@pytest.mark.parametrize(
    ("angle", "told"),
    [(60.0, "in rad (60 degrees are 1.047 rad)"), (1.6, "in rad"), (1e5, "in rad")],
)
def test_angles_are_asked_for_in_rad(angle, told):
    end = re.escape(told) + "$"
    with pytest.raises(ValueError, match=f"needs -pi/2 < angle < pi/2 {end}"):
        fx.bristles.SlantedSpring(1.0, 2.4, 1.0, angle)
    with pytest.raises(ValueError, match=f"= 0.775193 > rest_angle > -pi/2 {end}"):
        fx.bristles.AngularSpring(1.0, 1.4, 1.0, angle)
    with pytest.raises(ValueError, match=r"rest_angle > -pi/2 in rad \(-60 deg"):
        fx.bristles.AngularSpring(1.0, 1.4, 1.0, -60.0)
