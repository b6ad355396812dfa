"""The report of a nap: both directions, and whether the bristle turns over."""

import time

import pytest
from command_line import run
from html_pages import checked_page

import frictionjax as fx
from frictionjax.coefficients import coefficient_table
from frictionjax.contact import nap
from frictionjax.report.job import ReportRequest, read_job
from frictionjax.report.nap_page import NapFacts, nap_page, verdict_of_nap


def test_the_scene_that_is_built_in_has_a_report(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = run("nap", "--report")
    assert result.exit_code == 0, result.output
    folder = tmp_path / "frictionjax-nap"
    assert {path.name for path in folder.iterdir()} == {"report.html", "scene.toml"}
    page = checked_page((folder / "report.html").read_text(encoding="utf-8"))
    assert "0.120394" in page.text
    assert "0.087947" in page.text
    assert "frictionjax nap --report" in page.text
    assert "this bristle is none" in page.text


def test_a_rod_that_turns_over_is_told_in_words():
    surface, rod = fx.profiles.Sine(0.5), fx.bristles.AngularSpring(1.0, 2**0.5, 1.0, 0.3)
    turned = verdict_of_nap(nap(surface, rod, 0.1))
    assert "0.4854 N: 3 times as much" in turned
    assert "it turns over, and then holds against 0.3618 N: 2.236 times as much" in turned
    assert "then holds against" not in verdict_of_nap(nap(surface, rod, 0.5))


@pytest.mark.parametrize("stiffness", [None, 0.1])
def test_the_command_that_makes_it_again_has_the_stiffness(stiffness):
    job = read_job(None, bristle="angular")
    request = ReportRequest("frictionjax nap", time.perf_counter())
    found = nap(job.scene.profile, job.scene.bristle, stiffness)
    law = fx.friction(job.scene)
    table = coefficient_table(law)
    facts = NapFacts(job, found, stiffness, law, law, table, {}, 'kind = "x"')
    text = checked_page(nap_page(facts, request)).text
    assert ("--bending-stiffness 0.1 " in text) == (stiffness is not None)
    for number in (found.rho_with, found.rho_against, found.axial_with):
        assert f"{number:.6g}" in text
