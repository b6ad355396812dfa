"""Traces: their files, and what `fit_trace` refuses, by name."""

import jax.numpy as jnp
import numpy as np
import pytest

import frictionjax as fx

SCENE = fx.Scene(
    fx.profiles.Sine(0.1),
    fx.bristles.SlantedSpring(1.0, 2.2, 1.0, 0.5),
    fx.supports.Spring(1.0),
    fx.loads.Sine(0.8, 10.0),
    10.0,
)


def test_files(tmp_path):
    path = tmp_path / "trace.csv"
    trace = fx.Trace([0.0, 0.1, 0.3, 0.4], force=[1.0, 2.0, 3.0, 4.0], uncertainty=0.1)
    trace.to_csv(path)
    again = fx.Trace.from_csv(path)
    np.testing.assert_array_equal(again.values, trace.values)
    np.testing.assert_array_equal(again.uncertainty, trace.uncertainty)
    with pytest.raises(ValueError, match="No such file"):
        fx.Trace.from_csv(tmp_path / "none.csv")


LOOP = "t,force,uncertainty\n0,1,0.1\n0.1,2,0.1\n0.3,3,0.1\n0.4,4,0.1\n"
IN_MS = "index;time (ms);force [mN];uncertainty (mN)\n1;0;1000;100\n2;100;2000;100\n"
UNITS_BELOW = "index;t;force;uncertainty\n-;ms;mN;mN"
IN_MS += "3;300;3000;100\n4;400;4000;100\n"


@pytest.mark.parametrize(
    "data",
    [
        LOOP.encode("utf-8-sig"),
        LOOP.encode("utf-16"),
        LOOP.replace(",", ";").replace(".", ",").encode(),
        LOOP.replace(",", "\t").replace(".", ",").encode("utf-16"),
        ("# a loop\n" + LOOP.replace(",", "  ")).encode(),
        IN_MS.encode(),
        IN_MS.replace(";", "\t").encode("utf-16-be"),
        IN_MS.replace(" [mN]", "/uN").replace("000;", "000000;").encode(),
        IN_MS.replace("index;time (ms);force [mN];uncertainty (mN)", UNITS_BELOW).encode(),
    ],
)
def test_files_of_other_programs(data, tmp_path):
    path = tmp_path / "loop.txt"
    path.write_bytes(data)
    trace = fx.Trace.from_csv(path)
    np.testing.assert_allclose(trace.ts, [0.0, 0.1, 0.3, 0.4], rtol=1e-15)
    np.testing.assert_allclose(trace.values, [1.0, 2.0, 3.0, 4.0], rtol=1e-15)
    np.testing.assert_allclose(trace.uncertainty, 0.1, rtol=1e-15)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("t,force\n", "lines = 1: needs a line of names and lines of numbers"),
        ("t,force,force\n0,1,2\n", "line 1, column 3 = 'force': needs another name than"),
        ("t,time,force\n0,1,2\n", "line 1, column 2 = 't': needs one column of times"),
        ("t,force\n0,1\n1,\n", r"line 3, column 2 .* = 'an empty cell': needs a number"),
        (
            "t;force;uncertainty\n0;1;0,1\n1;;0,1\n",
            r"line 3, column 2 \(force\) = 'an empty cell'",
        ),
        ("t,force\n0,a\n", r"line 2, column 2 \(force\) = 'a': needs a finite number"),
        ("t,force\n0,1\n0.2,nan\n", r"line 3, column 2 \(force\) = 'nan'"),
        ("t,force\n0,1\n2,1\n1,1\n", r"line 4, column 1 \(t\) = 1: needs increasing"),
        ("t,force\n0,1\n0,1\n", r"line 3, column 1 \(t\) = 0: needs increasing times"),
        ("t,force\n-1,1\n0,1\n", r"line 2, column 1 \(t\) = -1: needs times from 0 on"),
        ("t,force (lbf)\n0,1\n", "line 1, column 2 = 'lbf': needs a unit of force: N, kN"),
        ("t (mm),force\n0,1\n", "line 1, column 1 = 'mm': needs a unit of time: s, ms"),
        ("t,z/N\n0,1\n", "line 1, column 2 = 'N': needs a unit of length: m, km"),
        ("t,force,uncertainty\n0,1,0\n", r"line 2, column 3 \(uncertainty\) = 0: needs"),
        ("t,force/mN,uncertainty\n0,1,1\n", r"uncertainty \(-\)': needs a unit, or none"),
        ("s,force\n0,1\n", "columns = 's, force': needs t among them"),
        ("t,height\n0,1\n", "columns = 't, height': needs force or z among them"),
        ("t,force,z\n0,1,1\n", "columns = 't, force, z': needs one of force and z"),
        ("t,force,load\n0,1,1\n", "line 1, column 3 = 'load': needs t, force or z"),
        (",t,force\n0,0,1\n", "line 1, column 1 = '': needs a name"),
    ],
)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
def test_bad_files_are_named_by_line_and_column(text, message, encoding, tmp_path):
    path = tmp_path / "trace.csv"
    path.write_text(text, encoding=encoding)
    with pytest.raises(ValueError, match=f"trace.csv: .*{message}") as error:
        fx.Trace.from_csv(path)
    assert "\n" not in str(error.value)


ROWS = "0;1000\n0.1;2000\n0.3;3000\n0.4;4000\n"


@pytest.mark.parametrize(
    "header",
    [
        "# force in mN\nt;force\n",
        "# a loop\n# Force [mN], time in s\nt;force\n",
        "% units of force: mN\n# load 5 uN for 3 min\nt;force\n",
        "t;force, mN\n",
        "t;force mN\n",
        "time (s);Friction force (mN)\n",
        "t, s;lateral force, mN\n",
    ],
)
def test_units_in_comments_and_behind_names(header, tmp_path):
    path = tmp_path / "loop.txt"
    path.write_text(header + ROWS)
    np.testing.assert_allclose(fx.Trace.from_csv(path).values, [1, 2, 3, 4], rtol=1e-15)
    *comments, names = header.splitlines()
    path.write_text(f"{names}\n{ROWS}" + "\n".join(comments))
    np.testing.assert_allclose(fx.Trace.from_csv(path).values, [1, 2, 3, 4], rtol=1e-15)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("# all in mN\nt;force\n" + ROWS, "line 1 = '# all in mN': needs its unit in the"),
        ("t;force\n" + ROWS + "# units: s, mN\n", "line 6 = '# units: s, mN': needs its"),
        (
            "# force in N\nt;force (mN)\n" + ROWS,
            "line 1 = '# force in N': needs mN, as lin",
        ),
        ("# force in lbf\nt;force\n" + ROWS, "line 2, column 2 = 'lbf': needs a unit of"),
        (
            "t;force;friction force\n0;1;1\n",
            "column 3 = 'force': needs one column of force",
        ),
        ("t;normal force\n0;1\n", "line 1, columns = 't, normal force': needs force or z"),
        ("t (us);force (uN)\n1290000;25,875\n", r"line 2, column 2 \(force\) = '25,875'"),
        ("t;force\n1,000;2,500\n1,250;2,125\n", 'needs decimal="," where commas mark d'),
    ],
)
def test_units_and_commas_that_are_not_clear_are_asked_about(text, message, tmp_path):
    path = tmp_path / "trace.csv"
    path.write_text(text)
    with pytest.raises(ValueError, match=f"trace.csv: .*{message}") as error:
        fx.Trace.from_csv(path)
    assert "\n" not in str(error.value)


def test_the_mark_of_decimals_of_a_trace_can_be_said(tmp_path):
    path = tmp_path / "trace.csv"
    path.write_text("t;force (uN)\n1;25,875\n2;1,125,875\n3;1,000\n4;900.5\n")
    whole = fx.Trace.from_csv(path, decimal=".").values
    np.testing.assert_allclose(whole, [25875e-6, 1125875e-6, 1e-3, 900.5e-6], rtol=1e-15)
    path.write_text("t;force\n1;25,875\n2;1.125,875\n3;1,000\n4;900,500\n")
    marked = fx.Trace.from_csv(path, decimal=",").values
    np.testing.assert_allclose(marked, [25.875, 1125.875, 1.0, 900.5], rtol=1e-15)
    with pytest.raises(ValueError, match="decimal = ';': needs a point"):
        fx.Trace.from_csv(path, decimal=";")


FOUR = [0.0, 1.0, 2.0, 3.0]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"ts": FOUR}, "trace = 'nothing': needs one of force and z"),
        ({"ts": FOUR, "force": FOUR, "z": FOUR}, "trace = 'force and z'"),
        ({"ts": FOUR[:3], "force": FOUR[:3]}, "4 or more times"),
        ({"ts": [0, 1, 1, 2], "z": FOUR}, "increasing times"),
        ({"ts": [-1, 1, 2, 3], "z": FOUR}, "times from 0 on"),
        ({"ts": [0, 1, np.nan, 2], "z": FOUR}, "finite times"),
        ({"ts": FOUR, "force": [0, 1, np.nan, 2]}, "trace.force = .*finite values"),
        ({"ts": FOUR, "z": FOUR[:2]}, r"trace.z = .*the shape \(4,\) of ts"),
        ({"ts": FOUR, "z": FOUR, "uncertainty": 0.0}, "uncertainties > 0"),
        ({"ts": FOUR, "z": FOUR, "uncertainty": [1, 1, np.inf, 1]}, "uncertainties > 0"),
        ({"ts": FOUR, "z": FOUR, "uncertainty": [1, 1]}, "trace.uncertainty"),
        ({"ts": FOUR, "z": "high"}, "trace.z"),
        (
            {"ts": FOUR, "force": [0, 3e300, 0, 1]},
            r"trace.force = .e\+300: needs values up to",
        ),
        (
            {"ts": FOUR, "z": [0, 1, 2, -4e60]},
            r"trace.z = -.e\+60: needs values up to 1e\+50",
        ),
        ({"ts": FOUR, "z": FOUR, "uncertainty": 1e200}, "needs uncertainties up to 1e"),
    ],
)
def test_bad_traces_are_named(arguments, message):
    with pytest.raises(ValueError, match=message):
        fx.Trace(**arguments)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"trace": None}, "trace = None: needs a Trace"),
        ({"scene": None}, "scene = None: needs a Scene"),
        ({"eps": 0.0}, "eps = 0: needs eps > 0"),
        ({"gamma": -1.0}, "gamma = -1: needs gamma > 0"),
        ({"within": 0.0}, "within = 0"),
        ({"harmonics": 0}, "harmonics = 0: needs a whole number"),
        ({"max_steps": 1.5}, "max_steps = 1.5"),
        ({"starts": 0}, "starts = 0: needs a whole number >= 1"),
        ({"accuracy": 1.0}, "accuracy = 1: needs"),
        ({"progress": "yes"}, "progress = 'yes': needs True or False"),
        ({"trace": fx.Trace([0, 1, 2, 11], z=FOUR)}, r"times in \[0, duration\]"),
    ],
)
def test_bad_arguments_are_named(options, message):
    known = {"trace": fx.Trace(FOUR, z=FOUR), "scene": SCENE, "eps": 0.05}
    with pytest.raises(ValueError, match=message):
        fx.fit_trace(**known | options)


def test_forces_that_the_support_cannot_have_are_named():
    bounded = fx.supports.Convex(lambda z: jnp.sqrt(1 + z**2))  # |Phi'| < 1
    scene = fx.Scene(SCENE.profile, SCENE.bristle, bounded, SCENE.load, 10.0)
    with pytest.raises(ValueError, match="forces that the support can have"):
        fx.fit_trace(fx.Trace(FOUR, force=[0.0, 5.0, 0.0, 0.0]), scene, 0.05)
