"""Friction against speed, each time against a number from elsewhere."""

import numpy as np
import pytest
from noisy_wells import COSINE, EPS
from spectral_density import spectral_friction

import frictionjax as fx

SPEEDS = [1e-4, 1e-3, 1e-2]
KNOWN = {1e-5: [0.06185, 0.06474, 0.06782], 1e-4: [0.04361, 0.05264, 0.06148]}
VERTICAL = fx.bristles.VerticalSpring(1.0, 2.0, 1.0)


def scene_with(*effects, stiffness=1.0, profile=None, bristle=None, support=None):
    profile = profile or fx.profiles.Sine(0.1)
    support = support or fx.supports.Spring(stiffness)
    load = fx.loads.Ramp(1.0)
    return fx.Scene(profile, bristle or VERTICAL, support, load, 1.0, effects=effects)


def cosine_scene(*effects):
    """Whose viscosity is 0.1 at eps = 0.1, gamma = 1: a tenth at ten times the speed."""
    return scene_with(*effects, profile=COSINE.profile, bristle=COSINE.bristle)


@pytest.mark.slow
def test_a_slide_is_that_of_steady_slide():
    scene = scene_with(stiffness=0.7)
    found = fx.friction_curve(scene, [0.3, -0.3], 0.05)
    slide = fx.steady_slide(scene.profile, VERTICAL, 0.05, 1.0, 0.21, scene.support)
    assert found.mean_force.values == pytest.approx(
        [float(slide.mean_plus), float(slide.mean_minus)], rel=1e-7
    )
    assert found.peak_force.values == pytest.approx(
        [float(slide.peak_plus), float(slide.peak_minus)], rel=1e-7
    )


def test_a_slide_has_the_same_bits_alone_and_in_company():
    scene = scene_with(stiffness=0.7)
    speeds = np.array([0.3, -0.3, 1.4])
    found = fx.friction_curve(scene, speeds, 0.05)
    assert np.array_equal(found.status, [int(fx.Status.OK)] * 3)
    assert found.drag.values == pytest.approx(0.05 * speeds)
    assert np.array_equal(found.friction_force, found.mean_force - found.drag)
    for i, speed in enumerate(speeds):
        alone = fx.friction_curve(scene, speed, 0.05)
        for name in ("mean_force", "peak_force", "status"):
            assert np.array_equal(alone[name].values, found[name].values[[i]])


@pytest.mark.slow
def test_of_a_compliant_array_the_mean_is_that_of_one_and_the_peak_of_a_sum():
    speeds, phases = np.array([0.3, -0.3, 1.4]), [0.0, 0.2, 0.7]
    one = fx.friction_curve(scene_with(stiffness=0.7), speeds, 0.05)
    array = fx.effects.CompliantArray(phases)
    found = fx.friction_curve(scene_with(array, stiffness=0.7), speeds, 0.05)
    for name in ("mean_force", "friction_force", "drag", "status"):
        assert np.array_equal(found[name], one[name])
    assert np.all(np.abs(found.peak_force) < 0.99 * np.abs(one.peak_force))
    assert np.all(np.abs(found.peak_force) > np.abs(found.mean_force))
    assert found.attrs["bristles"] == 3
    assert found.attrs["forces"].startswith("means over bristles")
    assert "bristles" not in one.attrs
    parts = fx.profiles.Sine(0.1), VERTICAL
    numbers = 0.05, 1.0, 0.21, fx.supports.Spring(0.7)
    slide = fx.steady_slide(*parts, *numbers, effects=(array,))
    expected = [float(slide.peak_plus), float(slide.peak_minus)]
    assert found.peak_force.values[:2] == pytest.approx(expected, rel=1e-7)
    together = fx.effects.CompliantArray([0.4, 0.4])
    same = fx.friction_curve(scene_with(together, stiffness=0.7), speeds, 0.05)
    assert np.array_equal(same.peak_force, one.peak_force)


def test_tips_that_never_rest_obey_the_law_of_a_constant_force():
    """`sqrt(rho^2 + (zeta v)^2)`: exact for a sine as k eps falls.

    Where it falls too far slides hardly forget their errors, and say so.
    """
    eps, gamma, rho = 1e-4, 0.3, 0.1
    scene = scene_with(fx.effects.LeadingOrder(), stiffness=0.3)
    speeds = np.array([0.3, 1.0, -1.0, 3.0])
    found = fx.friction_curve(scene, speeds, eps, gamma)
    drag = eps**gamma * speeds
    law = np.sign(speeds) * np.hypot(rho, drag)
    assert found.mean_force.values == pytest.approx(law, rel=2e-5)
    assert np.all(found.status == int(fx.Status.OK))
    assert np.all(np.abs(law) > rho * 1.001)
    soft = scene_with(fx.effects.LeadingOrder(), stiffness=1e-3)
    found = fx.friction_curve(soft, speeds, eps, gamma)
    assert np.max(np.abs(found.mean_force.values / law - 1)) > 1e-3
    assert np.all(found.status == int(fx.Status.OPEN_BRACKET))


def test_peaks_leave_a_fold_late_by_airys_number():
    """`peak - rho = c (|W'''|/2)^(-1/3) (k v zeta eps)^(2/3)` as eps falls.

    The spring gives way while the tip goes: `c = 2.338 - 2 x`, `x^2` the share of the
    excess that it gives, which falls like eps^(1/3) only. So c is fitted over several eps.
    """
    rho, speed = 0.1, 1.0
    scene = scene_with(fx.effects.LeadingOrder())
    fold = 0.5 * rho * (2 * np.pi) ** 2
    eps = np.array([1e-3, 1e-4, 1e-5, 1e-6])
    peaks = np.array([float(fx.friction_curve(scene, speed, e).peak_force[0]) for e in eps])
    seen = (peaks - rho) / (fold ** (-1 / 3) * (speed * eps**2) ** (2 / 3))
    x = np.sqrt((eps / (fold * speed)) ** (1 / 3))
    _, slope, airy = np.polyfit(x, seen, 2)
    assert airy == pytest.approx(2.33810741, rel=0.01)
    assert slope == pytest.approx(-2.0, rel=0.1)


@pytest.mark.parametrize("temperature", list(KNOWN))
def test_friction_with_noise_is_the_known_one(temperature):
    noise = fx.effects.Noise(temperature / EPS)
    speeds = np.array([*SPEEDS, -1e-3, 0.0])
    found = fx.friction_curve(cosine_scene(noise), speeds / EPS, EPS)
    friction = found.friction_force.values
    assert friction[:3] == pytest.approx(KNOWN[temperature], abs=3e-5)
    assert friction[3:] == pytest.approx([-friction[1], 0.0], rel=1e-12)
    assert found.drag.values == pytest.approx(speeds)
    assert np.all(found.error <= 1e-5)
    assert np.all(np.isnan(found.peak_force))
    assert np.all(found.status == 0)
    box = BOXES[temperature]
    again = spectral_friction(
        1e-3, temperature, steps=96, rounds=3, cells=box[0], box=box[1]
    )
    assert friction[1] == pytest.approx(again, rel=1e-3)
    alone = fx.friction_curve(cosine_scene(noise), speeds[1] / EPS, EPS)
    assert np.array_equal(alone.mean_force, found.mean_force[[1]])


BOXES = {1e-5: (160, (-1.3, 1.2)), 1e-4: (64, (-1.9, 1.8))}


def test_a_map_is_the_known_one_and_its_rows_are_curves():
    energies = np.array(list(KNOWN))
    speeds = np.array([*SPEEDS, -1e-3])
    scene = cosine_scene(fx.effects.Noise(1.0))
    found = fx.friction_curve(scene, speeds / EPS, EPS, temperatures=energies / EPS)
    assert found.friction_force.dims == ("temperature", "speed")
    assert found.thermal_energy.values == pytest.approx(energies, rel=1e-12)
    assert np.all(found.status == 0)
    assert np.all(found.error <= 1e-5)
    friction = found.friction_force.values
    assert friction[:, :3] == pytest.approx(np.array(list(KNOWN.values())), abs=3e-5)
    assert friction[:, 3] == pytest.approx(-friction[:, 1], rel=1e-12)
    for row, T in enumerate(KNOWN):
        noise = fx.effects.Noise(T / EPS)
        alone = fx.friction_curve(cosine_scene(noise), speeds[:2] / EPS, EPS)
        assert np.array_equal(alone.mean_force, found.mean_force[row, :2])
        cells, box = BOXES[T]
        again = spectral_friction(1e-2, T, steps=96, rounds=3, cells=cells, box=box)
        assert friction[row, 2] == pytest.approx(again, rel=1e-3)


def test_temperatures_are_those_of_the_scenes_exponent():
    scene = cosine_scene(fx.effects.Noise(7.0, 0.5))
    found = fx.friction_curve(scene, 0.1, EPS, temperatures=2e-4)
    assert found.thermal_energy.values == pytest.approx([2e-4 * EPS**0.5])
    same = cosine_scene(fx.effects.Noise(2e-4, 0.5))
    alone = fx.friction_curve(same, 0.1, EPS)
    assert found.mean_force.values[0] == pytest.approx(alone.mean_force.values, rel=1e-9)
    assert all(found[name].attrs["long_name"] for name in found.variables)


def test_maps_and_curves_are_drawn():
    scene = cosine_scene(fx.effects.Noise(1.0))
    speeds, warm = [0.01, 0.1, -0.1], [1e-3, 1.1e-3]  # of one size of box
    found = fx.friction_curve(scene, speeds, EPS, temperatures=warm)
    found["status"][0, 0] = 1
    lines, colours = fx.plot.draw_friction_curve(found).axes[:2]
    right = [line for line in lines.lines if line.get_label().startswith("$T$")]
    assert len(right) == 2
    force = found.friction_force.values
    assert right[1].get_ydata() == pytest.approx(force[1, :2])
    assert np.isnan(right[0].get_ydata()[0])
    shown = colours.collections[0].get_array()
    assert np.ma.count(shown) == 3  # one has failed
    assert colours.get_ylabel().endswith("(J)")
    told = [text.get_text() for text in lines.get_legend().get_texts()]
    assert told[2:] == ["to the right", "to the left"]
    (plain,) = fx.plot.draw_friction_curve(fx.friction_curve(cosine_scene(), 0.1, EPS)).axes
    assert plain.get_legend() is None
    assert plain.get_xlabel() == "speed (m/s)"


def test_a_temperature_2_percent_off_is_seen():
    cold, warm = (
        fx.friction_curve(cosine_scene(fx.effects.Noise(T / EPS)), 1e-2, EPS)
        for T in (1e-4, 1.02e-4)
    )
    change = float(cold.friction_force[0] - warm.friction_force[0])
    assert change > 10 * float(cold.error[0] + warm.error[0])
    assert warm.friction_force.values != pytest.approx([0.05264], abs=3e-5)


def test_colder_slides_tend_to_the_one_without_noise():
    plain = fx.friction_curve(cosine_scene(), 0.1, EPS)
    cold = fx.friction_curve(cosine_scene(fx.effects.Noise(1e-6)), 0.1, EPS)
    gap = float(plain.mean_force[0] - cold.mean_force[0])
    assert 0 < gap < 0.01 * float(plain.mean_force[0])


def test_columns_say_what_they_are():
    found = fx.friction_curve(scene_with(), [0.1, 0.2], 0.05)
    assert set(found.data_vars) == {
        "mean_force",
        "drag",
        "friction_force",
        "peak_force",
        "status",
    }
    assert all(found[name].attrs["long_name"] for name in found.variables)
    assert found.status.attrs["flag_meanings"].split()[0] == "ok"
    assert found.attrs["eps"] == 0.05


NOISE = fx.effects.Noise(1e-3)


@pytest.mark.parametrize(
    ("effects", "change", "message"),
    [
        ((), {"speeds": [0.1, 0.0]}, "speeds = .*needs speeds in m/s, not 0"),
        ((NOISE,), {"speeds": [np.nan]}, "speeds = .*needs speeds in m/s"),
        ((), {"speeds": [[0.1]]}, "speeds = .*needs one, or shape"),
        ((), {"eps": [0.1, 0.2]}, "eps = .*needs one number, eps > 0 in m"),
        (
            (),
            {"temperatures": [1e-3]},
            r"temperatures = .*needs None, or a scene with effects\.Noise",
        ),
        ((NOISE,), {"temperatures": [0.0]}, "temperatures = .*temperatures > 0"),
        ((NOISE,), {"temperatures": [[1.0]]}, "temperatures = .*one, or shape"),
        ((), {"gamma": 0.0}, "gamma = 0: needs gamma > 0"),
        (
            (fx.effects.CompliantArray(np.linspace(0, 1, 10**6)),),
            {},
            r"offsets: number of bristles = 1e\+06: needs at most",
        ),
        (
            (fx.effects.RigidArray([0.0, 0.5]),),
            {},
            r"effects\.RigidArray: rho_plus = 0: needs phases that leave friction",
        ),
    ],
)
def test_what_cannot_be_done_is_refused_by_name(effects, change, message):
    given = {"speeds": 0.1, "eps": 0.05, "gamma": 1.0} | change
    with pytest.raises(ValueError, match=message):
        fx.friction_curve(scene_with(*effects), **given)


def test_a_support_that_is_no_spring_is_refused():
    scene = scene_with(support=fx.supports.Convex(lambda z: z**2))
    with pytest.raises(ValueError, match=r"scene\.support = 'Convex': needs a Spring"):
        fx.friction_curve(scene, 0.1, 0.05)
