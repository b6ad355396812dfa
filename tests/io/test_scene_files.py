"""Scene files: exact round trips, and mistakes named on one line."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest

import frictionjax as fx
from frictionjax.io.scene_files import (
    default_study,
    load_study,
    parse_scene,
    scene_document,
)

ODD = 0.1 + 0.2  # more digits than a short format keeps
PROFILES = [
    fx.profiles.Sine(ODD / 3),
    fx.profiles.Fourier([ODD / 30, 0.0], [0.01, -1 / 300]),
    fx.profiles.Spline([0.0, 0.01, 1 / 30, 0.02, -0.01]),
]
BRISTLES = [
    fx.bristles.Homothetic(1 / 3),
    fx.bristles.VerticalSpring(1 / 3, 2 * ODD, ODD),
    fx.bristles.SlantedSpring(1 / 3, 2.2, 1.0, ODD),
    fx.bristles.AngularSpring(1 / 3, 2**0.5, 1.0, ODD),
    fx.bristles.Linear(-ODD, 1 / 3),
]
LOADS = [
    fx.loads.Ramp(1 / 3, ODD - 0.3),
    fx.loads.Sine(1.0488, ODD),
    fx.loads.Triangle(1 / 3, 3.0),
    fx.loads.PiecewiseLinear([0.0, ODD, 3.0], [0.0, 1 / 3, -1.0]),
    fx.loads.Pulled(fx.loads.PiecewiseLinear([0.0, ODD], [1 / 3, -1.0]), 1 / 7),
]


def scene(profile=PROFILES[0], bristle=BRISTLES[1], load=LOADS[1], effects=()):
    parts = profile, bristle, fx.supports.Spring(1 / 7), load, 10 / 3, 1e-3 / 3
    return fx.Scene(*parts, effects=effects)


EFFECTS = [
    (fx.effects.LeadingOrder(),),
    (fx.effects.RigidArray([0.0, ODD], [1.0, 1 / 3]), fx.effects.LeadingOrder()),
    (fx.effects.CompliantArray([0.0, 1 / 3, ODD]), fx.effects.RigidArray([0.0, 0.1])),
    (fx.effects.Noise(ODD, exponent=1 / 3),),
    (fx.effects.Inertia(ODD, exponent=1 / 3),),
]
# What `scene` takes, which each worker would call while it collects.
CHANGES = [
    *({"effects": some} for some in EFFECTS),
    {"bristle": BRISTLES[3], "effects": (fx.effects.NapFlip(ODD),)},
    *({"profile": part} for part in PROFILES),
    *({"bristle": part} for part in BRISTLES),
    *({"load": part} for part in LOADS),
]


@pytest.mark.parametrize("changes", CHANGES)
def test_round_trip_is_exact(changes, tmp_path):
    one = scene(**changes)
    fx.save_scene(one, tmp_path / "scene.toml")
    again = fx.load_scene(tmp_path / "scene.toml")
    old, new = (jax.tree_util.tree_flatten(s) for s in (one, again))
    assert old[1] == new[1]
    spline = isinstance(one.profile, fx.profiles.Spline)
    for a, b in zip(old[0], new[0], strict=True):
        np.testing.assert_allclose(a, b, rtol=1e-14 if spline else 0, atol=0)


def test_study_table_round_trips(tmp_path):
    study = {"eps": [0.1, 1 / 30], "gamma": [0.5], "accuracy": 1e-4}
    fx.save_scene(scene(), tmp_path / "scene.toml", study)
    assert load_study(tmp_path / "scene.toml").study == study


def test_default_scene_slides_both_ways_and_depends_on_direction():
    one, study = default_study()
    law = fx.friction(one)
    assert -law.rho_plus / law.rho_minus > 1.2
    z = fx.solve_limit(one).z
    assert z.max() > 0.5
    assert z.min() < -0.5
    eps = np.array(study["eps"])
    assert eps.size == 16
    assert eps[-1] < 2e-6
    assert np.all(np.diff(eps) < 0)
    assert np.ptp(np.log(eps[:-1] / eps[1:])) < 0.02  # geometric
    inverse = 1 / eps
    assert np.min(np.abs(inverse - np.round(inverse))[eps > 1e-3]) > 1e-3  # no knife edge
    assert study["gamma"] == [0.75, 1.0, 2.0]


FUNCTIONS = [
    ("profile", fx.profiles.Custom(lambda y: 0.01 * jnp.sin(2 * jnp.pi * y))),
    ("bristle", fx.bristles.Custom(lambda eta: 0.0 * eta, lambda eta: eta)),
    ("load", fx.loads.Custom(lambda t: 0.1 * t)),
    ("support", fx.supports.Convex(lambda z: z**2)),
]


@pytest.mark.parametrize(("table", "part"), FUNCTIONS, ids=[t for t, _ in FUNCTIONS])
def test_functions_cannot_be_saved(table, part, tmp_path):
    parts = {
        "profile": PROFILES[0],
        "bristle": BRISTLES[0],
        "support": fx.supports.Spring(1.0),
        "load": LOADS[0],
    }
    one = fx.Scene(**(parts | {table: part}), duration=1.0)
    with pytest.raises(ValueError, match=rf"scene\.{table} = .*functions"):
        fx.save_scene(one, tmp_path / "scene.toml")
    assert not (tmp_path / "scene.toml").exists()


def test_given_potential_cannot_be_saved():
    given = fx.GivenPotential(lambda Y: 0.01 * jnp.sin(2 * jnp.pi * Y))
    one = fx.Scene(
        potential=given, support=fx.supports.Spring(1.0), load=LOADS[0], duration=1.0
    )
    with pytest.raises(ValueError, match=r"scene\.potential = 'GivenPotential'.*functions"):
        scene_document(one)


TEXT = scene_document(*default_study())
MISTAKES = [
    (
        'kind = "SlantedSpring"',
        'kind = "Slanted"',
        r"\[bristle\] kind = 'Slanted'.*Angular",
    ),
    ('kind = "SlantedSpring"', "", r"\[bristle\] no kind: needs .*SlantedSpring"),
    ('kind = "SlantedSpring"', "kind = 3", r"\[bristle\] kind = 3: needs .*SlantedSpring"),
    ("angle = 1.0", "angel = 1.0", r"\[bristle\] angel is unknown: .*height, angle"),
    ("angle = 1.0", "", r"\[bristle\] angle is missing"),
    ("angle = 1.0", 'angle = "steep"', r"\[bristle\] angle = 'steep': needs a number"),
    ("angle = 1.0", "angle = true", r"\[bristle\] angle = True: needs a number \(rad, in"),
    ("angle = 1.0", "angle = [1.0, 2.0]", r"bristle\.angle = .*one number"),
    ("angle = 1.0", "angle = nan", r"bristle\.angle = nan: needs a finite number"),
    ("angle = 1.0", "angle = 1.55", r"bristle\.angle = 1\.55: .*cot\(angle\)"),
    ("angle = 1.0", f"angle = 1{'0' * 400}", r"\[bristle\] angle: needs 64-bit"),
    ("[load]", "[lood]", r"lood is unknown: needs one of duration.*load, effects, study"),
    ("[load]\nkind", "load = 3\n[lood]\nkind", "is unknown"),
    ("duration = 3.0", "", "duration is missing"),
    ("duration = 3.0", "duration = -1", r"scene\.duration = -1: needs duration > 0"),
    ("duration = 3.0", "duration = [3.0]", r"duration = \[3.0\]: needs a number"),
    ("duration = 3.0", "duration = ", r"not TOML \(Invalid value \(at line 1"),
    ("accuracy = 0.001", "accuracy = [0.1]", r"\[study\] accuracy = .*a number > 0"),
    ("accuracy = 0.001", "acuracy = 0.1", r"\[study\] acuracy is unknown.*accuracy"),
    ("gamma = [", "gamma = [-1.0, ", r"\[study\] gamma = \[-1.0.*numbers > 0"),
]


@pytest.mark.parametrize(("old", "new", "message"), MISTAKES)
def test_mistakes_are_named_on_one_line(old, new, message, tmp_path):
    assert old in TEXT
    path = tmp_path / "mine.toml"
    path.write_text(TEXT.replace(old, new, 1))
    with pytest.raises(ValueError, match=message) as caught:
        fx.load_scene(path)
    assert str(caught.value).startswith(f"{path}: ")
    assert "\n" not in str(caught.value)


def test_a_missing_table_is_named():
    start, _, rest = TEXT.partition("[support]")
    with pytest.raises(ValueError, match=r"mine: support is missing: needs all of .*load"):
        parse_scene(start + rest[rest.index("[load]") :], "mine")


def test_unreadable_files(tmp_path):
    with pytest.raises(ValueError, match=r"none\.toml: cannot be read \(No such file"):
        fx.load_scene(tmp_path / "none.toml")
    (tmp_path / "binary.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ValueError, match=r"binary\.toml: cannot be read \(UTF-16"):
        fx.load_scene(tmp_path / "binary.toml")
    (tmp_path / "deep.toml").write_text("a = " + "[" * 5000 + "]" * 5000)
    with pytest.raises(ValueError, match=r"deep\.toml: not a scene \(lists or tables nes"):
        fx.load_scene(tmp_path / "deep.toml")
    with pytest.raises(ValueError, match="path = None: needs the path of a TOML"):
        fx.load_scene(None)


BOM = "\ufeff"


@pytest.mark.parametrize("start", [BOM, "", BOM + "\r\n"])
def test_a_byte_order_mark_is_no_part_of_a_scene(start, tmp_path):
    (tmp_path / "scene.toml").write_bytes((start + TEXT).encode("utf-8"))
    assert eqx.tree_equal(fx.load_scene(tmp_path / "scene.toml"), default_study().scene)


@pytest.mark.parametrize(
    ("data", "said"),
    [
        ((BOM + TEXT).encode("utf-16-le"), "UTF-16; save it as UTF-8"),
        ((BOM + TEXT).encode("utf-16-be"), "UTF-16; save it as UTF-8"),
        (TEXT.encode("utf-16-le"), "UTF-16 or no text; save it as UTF-8"),
        (b"# 1\n# in \xb5m\n" + TEXT.encode(), "not UTF-8, byte 0xb5 in line 2; save it"),
        (b"\x89PNG\x00\x01", "no text; save it as UTF-8"),
    ],
)
def test_other_encodings_are_named(data, said, tmp_path):
    (tmp_path / "scene.toml").write_bytes(data)
    with pytest.raises(ValueError, match=rf"scene\.toml: cannot be read \({said}") as found:
        fx.load_scene(tmp_path / "scene.toml")
    assert "\n" not in str(found.value)


def measured_scene(folder, options):
    x = np.linspace(0.0, 1e-4, 401)
    trace = 1e-7 * np.sin(2 * np.pi * x / 1e-5)
    np.savetxt(folder / "trace.txt", np.stack([x, trace], axis=1), header="x (m) z (m)")
    profile = f'[profile]\nkind = "Fourier"\nheights = "trace.txt"\n{options}\n'
    start, _, rest = TEXT.partition("[profile]")
    path = folder / "scene.toml"
    path.write_text(start + profile + rest[rest.index("[bristle]") :])
    return path


def test_a_measured_trace_is_smoothed(tmp_path):
    options = "period = 1e-5\nharmonics = 3\nsmoothing = 1e-5"
    with pytest.warns(fx.profiles.SlopesUndetermined, match="a shorter smoothing takes"):
        one = fx.load_scene(measured_scene(tmp_path, options))
    assert one.profile.sin == pytest.approx([0.005, 0.0, 0.0], abs=1e-8)
    again = parse_scene(scene_document(one), "again").scene
    np.testing.assert_array_equal(again.profile.slope_error, one.profile.slope_error)
    np.testing.assert_array_equal(again.profile.slope_taken, one.profile.slope_taken)
    assert one.profile.slope_taken == pytest.approx(0.01 * np.pi, rel=1e-6)


def test_a_measured_trace_is_a_profile(tmp_path):
    one = fx.load_scene(measured_scene(tmp_path, "period = 1e-5\nharmonics = 3"))
    assert one.profile.sin == pytest.approx([0.01, 0.0, 0.0], abs=1e-8)
    assert one.profile.cos == pytest.approx([0.0, 0.0, 0.0], abs=1e-8)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ("harmonics = 2.5", r"\[profile\] harmonics = 2.5: needs a whole number"),
        ("period = [1.0]", r"\[profile\] period = \[1.0\]: needs a number"),
        ("cos = [1.0]", r"\[profile\] cos is unknown: needs one of heights, period"),
        ("pixel = 1e-6", "pixel = 1e-06: needs none"),
        ("period = 1e-5\nharmonics = 300", "trace.txt: harmonics = 300: needs"),
        ('length_unit = "furlong"', "trace.txt: length_unit = 'furlong': needs a unit"),
        ('outliers = "drop"', "trace.txt: outliers = 'drop': needs"),
        ("decimal = 1", r"\[profile\] decimal = 1: needs a text"),
    ],
)
def test_mistakes_about_a_measured_trace(options, message, tmp_path):
    with pytest.raises(ValueError, match=message):
        fx.load_scene(measured_scene(tmp_path, options))


EFFECT_MISTAKES = {
    '[[effects]]\nkind = "RigidAray"\noffsets = [0.0]': (
        r"\[\[effects\]\] kind = 'RigidAray': needs a kind that is .*\(RigidArray\?\)"
    ),
    "[[effects]]\noffsets = [0.0]": r"\[\[effects\]\] no kind: needs a kind that is one of",
    '[[effects]]\nkind = "RigidArray"': r"\[\[effects\]\] offsets is missing: needs all of",
    '[[effects]]\nkind = "RigidArray"\nofsets = [0.0]': (
        r"\[\[effects\]\] ofsets is unknown: needs one of .*\(offsets\?\)$"
    ),
    '[[effects]]\nkind = "LeadingOrder"\nmass = 1.0': (
        r"\[\[effects\]\] mass is unknown: needs no key$"
    ),
    '[[effects]]\nkind = "CompliantArray"\noffsets = "all"': (
        r"\[\[effects\]\] offsets = 'all': needs a list of numbers \(periods, a list\)$"
    ),
    '[[effects]]\nkind = "CompliantArray"\noffsets = [nan]': (
        r"effects\.CompliantArray\.offsets = .*needs finite places"
    ),
    '[effects]\nkind = "LeadingOrder"': r"effects = .*: needs tables \[\[effects\]\]$",
    '[[effects]]\nkind = "Inertia"\nmass = 0.0': (
        r"effects\.Inertia\.mass = 0: needs mass > 0 in kg"
    ),
    '[[effects]]\nkind = "Inertia"\nmass = 1.0\nexponent = "gamma"': (
        r"\[\[effects\]\] exponent = 'gamma': needs a number"
    ),
    '[[effects]]\nkind = "Inertia"\nmas = 1.0': r"mas is unknown: .*\(mass\?\)$",
    '[[effects]]\nkind = "Noise"\ntemperature = -1e-4': (
        r"effects\.Noise\.temperature = -0\.0001: needs temperature > 0 in J"
    ),
    '[[effects]]\nkind = "Noise"': r"\[\[effects\]\] temperature is missing",
    '[[effects]]\nkind = "NapFlip"\nbending_stiffness = [1.0, 2.0]': (
        r"effects\.NapFlip\.bending_stiffness = .*: needs one number"
    ),
    '[[effects]]\nkind = "NapFlip"\nbending_stiffness = 1.0': (
        r"scene\.bristle = SlantedSpring: needs an AngularSpring, as .* has NapFlip"
    ),
    '[[effects]]\nkind = "AxialLoad"\nbending_stiffness = 1.0': (
        r"scene\.bristle = SlantedSpring: needs an AngularSpring, as .* has AxialLoad"
    ),
    '[[effects]]\nkind = "Noise"\ntemperature = 1.0\n'
    '[[effects]]\nkind = "Inertia"\nmass = 1.0': (
        r"scene\.effects = Noise and Inertia: needs one of them"
    ),
    '[[effects]]\nkind = "RigidArray"\noffsets = [0.0]\n'
    '[[effects]]\nkind = "CompliantArray"\noffsets = true': (
        r"\[\[effects\]\] no\. 2 offsets = True: needs a list of numbers"
    ),
    '[[effects]]\nkind = "LeadingOrder"\n[[effects]]\nkind = "LeadingOrder"': (
        r"scene\.effects = LeadingOrder and LeadingOrder: needs one of each kind"
    ),
}


@pytest.mark.parametrize(("added", "words"), EFFECT_MISTAKES.items())
def test_mistakes_in_effects_are_one_line(added, words):
    text = f"{scene_document(scene(bristle=BRISTLES[2]))}\n{added}\n"
    with pytest.raises(ValueError, match=words) as caught:
        parse_scene(text, "rough.toml")
    assert str(caught.value).startswith("rough.toml: ")
    assert "\n" not in str(caught.value)


def test_a_misspelt_table_is_guessed():
    text = scene_document(scene(load=LOADS[-1])).replace("[bristle]", "[brisle]")
    with pytest.raises(ValueError, match=r"brisle is unknown: .*\(bristle\?\)"):
        parse_scene(text, "rough.toml")


def test_a_pulled_load_holds_the_table_of_its_position():
    document = scene_document(scene(load=LOADS[-1]))
    assert "[load.position]" in document
    for old, new, message in (
        (
            'kind = "PiecewiseLinear"',
            'kind = "Pulled"',
            r"\[load.position\] kind = 'Pulled'",
        ),
        ("times", "moments", r"\[load.position\] moments is unknown"),
    ):
        with pytest.raises(ValueError, match=message):
            parse_scene(document.replace(old, new), "scene.toml")
