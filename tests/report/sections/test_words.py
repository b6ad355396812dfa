"""Words and legends of reports."""

import pytest

import frictionjax as fx
from frictionjax.convergence import Verdict
from frictionjax.report import cost_page, design_page, nap_page, study_page
from frictionjax.report.sections.words import status_legend, verdict_legend, words_section


def test_every_status_has_its_meaning_and_count():
    rows = status_legend([0, 0, int(fx.Status.MAX_STEPS)]).rows
    assert {row[0] for row in rows} == {one.name.lower() for one in fx.Status}
    found = {name: (count, meaning) for name, count, meaning in rows}
    assert found["ok"][0] == "2"
    assert found["max_steps"] == ("1", fx.Status.MAX_STEPS.message)


def test_every_verdict_is_explained():
    names = {verdict.name.lower().replace("_", " ") for verdict in Verdict}
    assert {row[0] for row in verdict_legend().rows} == names


@pytest.mark.parametrize("page", [study_page, cost_page, design_page, nap_page])
def test_words_that_a_report_names_are_known(page):
    assert len(words_section(page._WORDS).blocks[0]) > 1000
