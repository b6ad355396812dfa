"""Results as tables: in a shell, in a notebook, in files."""

import csv

from frictionjax._text import ResultTable, in_columns

ROWS = ("a", "1.5"), ("<b>", "-20, 7")
TABLE = ResultTable(("name", "x_1, N"), ROWS, note="5 % & more")


def test_columns_line_up():
    text = in_columns(("name", "x"), [("a", "1.5"), ("long", "-20")], left=1)
    assert text.splitlines() == ["name    x", "a     1.5", "long  -20"]


def test_meanings_are_words():
    text = in_columns(("x", "meaning"), [("1.5", "a"), ("-20", "longer")], meanings=1)
    assert text.splitlines() == ["  x  meaning", "1.5  a", "-20  longer"]


def test_it_prints_itself():
    lines = ["name  x_1, N", "a        1.5", "<b>   -20, 7", "5 % & more"]
    assert str(TABLE).splitlines() == repr(TABLE).splitlines() == lines


def test_in_a_notebook_nothing_is_taken_for_a_tag():
    page = TABLE._repr_html_()
    assert "&lt;b&gt;" in page
    assert "<b>" not in page
    assert page.endswith("</table><p>5 % &amp; more</p>")
    assert page.count("text-align: left") == page.count("<tr>") == 3


def test_a_page_says_what_a_table_is_of():
    page = TABLE.to_html("<Loads>")
    assert page.startswith("<table><caption>&lt;Loads&gt;</caption><thead><tr><th scope=")
    assert page.count('<th scope="col"') == 2
    assert page.count("<td ") == 4


def test_a_column_of_meanings_is_flush_left_wherever_it_is_shown():
    table = ResultTable(("x", "meaning"), (("1.5", "a"),), left=0, meanings=1)
    assert str(table) == in_columns(table.header, table.rows, meanings=1)
    assert table.to_latex().startswith(r"\begin{tabular}{rl}")
    sides = [part.split('"')[0] for part in table.to_html().split("text-align: ")[1:]]
    assert sides == ["right", "left"] * 2


def test_csv_is_read_back():
    rows = [tuple(row) for row in csv.reader(TABLE.to_csv().splitlines())]
    assert rows == [TABLE.header, *TABLE.rows]


def test_latex_has_a_column_each_and_no_bare_signs():
    lines = TABLE.to_latex().splitlines()
    assert lines[0] == r"\begin{tabular}{lr}"
    assert lines[1] == r"name & x\_1, N \\"
    assert lines[2] == r"\hline"
    assert lines[4] == r"$<$b$>$ & -20, 7 \\"
    assert lines[-1] == r"\end{tabular}"
