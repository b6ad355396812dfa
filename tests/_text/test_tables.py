"""Text files of instruments: read whatever wrote them, or refused by line and column."""

import codecs

import numpy as np
import pytest

from frictionjax._text import decoded, read_table
from frictionjax._text.units import Heading, heading_of

PLAIN = "t,force\n0,1.5\n0.25,-2\n"
NUMBERS = [[0.0, 1.5], [0.25, -2.0]]


@pytest.mark.parametrize(
    "text",
    [
        PLAIN,
        PLAIN.replace("\n", "\r\n"),
        PLAIN.replace(",", ";"),
        PLAIN.replace(",", "\t"),
        PLAIN.replace(",", "  "),
        PLAIN.replace(",", ";").replace(".", ","),
        PLAIN.replace(",", "\t").replace(".", ","),
        PLAIN.replace(",", " ").replace(".", ","),
        PLAIN.replace(",", ";").replace("\n", ";\n"),
        "# made by hand\n\n" + PLAIN + "\n% the end\n",
        "# a loop\n# t,force\n0,1.5\n0.25,-2\n",
        't,force\n"0","1,5"\n"0,25","-2"\n',
        "t;force\n0;1.5E0\n2.5D-1;-2\n",
    ],
)
def test_the_same_numbers_however_they_are_written(text):
    np.testing.assert_array_equal(read_table(text.encode()).numbers, NUMBERS)


@pytest.mark.parametrize(
    "encoding",
    ["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "utf-32", "cp1252"],
)
def test_the_same_text_in_every_encoding(encoding):
    text = "t (\u00b5s);force (mN)\n0;1,5\n0,25;-2\n"
    assert decoded(text.encode(encoding)) == text
    table = read_table(text.encode(encoding))
    np.testing.assert_array_equal(table.numbers, NUMBERS)
    assert table.headings == [Heading("t", "us"), Heading("force", "mN")]


@pytest.mark.parametrize(
    ("text", "name", "unit"),
    [
        ("t (ms)", "t", "ms"),
        ("Force [mN]", "force", "mN"),
        ("force/mN", "force", "mN"),
        ("force / mN", "force", "mN"),
        ("z_\u03bcm", "z", "um"),
        ("height_m", "height", "m"),
        ("rest_length", "rest_length", ""),
        ("uncertainty", "uncertainty", ""),
        ("force (lbf)", "force", "lbf"),
    ],
)
def test_headings(text, name, unit):
    assert heading_of(text) == (name, unit)


def test_units_on_a_line_of_their_own():
    table = read_table(b"index;t;force\n-;[ms];mN\n1;0;1.5\n2;0.25;-2\n")
    assert table.headings == [("index", ""), ("t", "ms"), ("force", "mN")]
    assert table.lines == [3, 4]
    assert table.place(1, 2) == "line 4, column 3 (force)"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "lines = 0: needs a line of names"),
        ("t,force\n", "lines = 1: needs a line of names"),
        ("0,1\n2,3\n", "line 1 = '0 1': needs names of the columns"),
        (
            "t,force\n0,1\n1,\n",
            r"line 3, column 2 \(force\) = 'an empty cell': needs a number",
        ),
        ("t,force\n0,1\n,2\n", r"line 3, column 1 \(t\) = 'an empty cell': needs a number"),
        ("t,force\n0,1\n1\n", r"line 3, column 2 .* = 'an empty cell': needs a number"),
        ("t,force\n0,1\n1,2,3\n", "line 3 = '3 fields': needs 2, one for each name"),
        ("t;force\n0;1\n1;BAD\n", r"line 3, column 2 \(force\) = 'BAD': needs a finite"),
        ("t;force\n0;1\n1;nan\n", r"line 3, column 2 \(force\) = 'nan': needs a finite"),
        ("t;force\n0;inf\n", r"line 2, column 2 \(force\) = 'inf': needs a finite"),
        (
            "t;force\n0.5;1\n1,5;2\n",
            r"line 3, column 1 \(t\) = '1,5': needs decimal points",
        ),
        ("t;force\n0,5;1\n1;1.5\n", r"line 3, column 2 .* = '1.5': needs decimal commas"),
        ("t;force\n0;1.234,5\n", r"line 2, column 2 .*'1.234,5': needs a finite number"),
        ("t,force\n0,1,2,3\n", "line 2 = '4 fields': needs 2"),
        ("t,force,t\n0,1,2\n", "line 1, column 3 = 't': needs another name than column 1"),
        ("t (s),t (ms)\n0,1\n", r"column 2 = 't \(ms\)': needs another name than column 1"),
        (",t,force\n0,1,2\n", "line 1, column 1 = '': needs a name"),
        (
            "t;force (N)\ns;N\n0;1\n",
            r"column 2 = 'force \(N\)': needs its unit in one place",
        ),
        ("t;force\ns;lbf\n0;1\n", r"line 2, column 2 \(force\) = 'lbf': needs a unit"),
        ("t;force\ns;N\n", "lines = 'names alone': needs lines of numbers"),
    ],
)
def test_what_is_no_table_is_named_by_line_and_column(text, message):
    with pytest.raises(ValueError, match=message) as error:
        read_table(text.encode())
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (bytes(range(256)) * 8, "file = 'bytes': needs text, and no binary file"),
        (codecs.BOM_UTF16_LE + b"t\0;", "byte .*: needs text in UTF-16"),
        (b"t;force\x81\n", "byte 8: needs text in CP1252"),
    ],
)
def test_what_is_no_text_is_named(data, message):
    with pytest.raises(ValueError, match=message):
        read_table(data)
