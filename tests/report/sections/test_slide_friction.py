"""Friction that is told in words: of the scene as it moves, not of a part of it."""

import json

import numpy as np
import pytest
from command_line import run
from html_pages import checked_page
from sweep_like import sweep_like

import frictionjax as fx
from frictionjax.report import study_results
from frictionjax.report.job import read_job
from frictionjax.report.sections import friction_of_slides, friction_sentence
from frictionjax.report.study_words import picture_of, verdict_sentence

TURNED = "0.3618 N to the left once the rod has turned over: 0.4472 to 1."


def example(folder, name):
    file = folder / f"{name}.toml"
    assert run("scenes", name, "--out", file).exit_code == 0
    return file


def told_of_friction(monkeypatch, folder, file):
    """Tables of a study of a scene file, whose cells are others, and no pictures."""
    monkeypatch.setattr(study_results, "study_figures", lambda *_: iter(()))
    data = sweep_like(failed=False).assign_attrs(method="auto", source="frictionjax 0")
    text = study_results.write_results(read_job(str(file)), data, folder, 1.0)
    return " ".join(text.split())


def test_a_study_tells_friction_of_the_rod_turned_over(tmp_path, monkeypatch):
    """It told that of the rod if it kept its nap."""
    told = told_of_friction(monkeypatch, tmp_path, example(tmp_path, "nap-flip"))
    assert f"Friction becomes 0.1618 N to the right and {TURNED}" in told
    assert "rho_minus -0.485398 N" in told  # of the table, which says whose it is
    assert "(friction if the rod kept its nap: `nap` has that of it turned over)" in told


def test_the_picture_of_the_loop_tells_the_levels_that_it_shows(tmp_path):
    scene = read_job(str(example(tmp_path, "nap-flip"))).scene
    slides = friction_of_slides(scene)
    told, _ = picture_of("loop", fx.study(sweep_like(failed=False)), slides, 1.0)
    assert "-0.3618 N on the way to the left once the rod has turned over" in told


def test_friction_of_a_scene_with_noise_is_told_as_that_without(tmp_path, monkeypatch):
    told = told_of_friction(monkeypatch, tmp_path, example(tmp_path, "noise"))
    assert "0.1 N to the right and 0.1 N to the left without noise: 1 to 1." in told
    assert "(friction without noise: `friction_curve` has that with it)" in told


@pytest.mark.parametrize(("overdamped", "said"), [(0, " without inertia"), (1, "")])
def test_where_mass_stays_friction_is_told_as_that_without(overdamped, said):
    found = fx.study(sweep_like(failed=False))
    flags = np.full(found.orders.gamma.size, overdamped)
    orders = found.orders.assign(overdamped=("gamma", flags))
    law = fx.friction(read_job(None).scene)
    told = verdict_sentence(found._replace(orders=orders), law)
    assert f"0.08795 N to the left{said}: 1.369 to 1." in told


def test_friction_from_the_shell_says_whose_it_is(tmp_path):
    file = example(tmp_path, "nap-flip")
    text = run("friction", file).stdout
    assert "(friction if the rod kept its nap" in text
    assert TURNED in text
    numbers = json.loads(run("friction", file, "--json").stdout)
    assert numbers["condition"] == "if the rod kept its nap"
    assert numbers["rho_minus"] == pytest.approx(-0.485398, rel=1e-5)
    stiff = file.read_text().replace("bending_stiffness = 0.1", "bending_stiffness = 9.0")
    file.write_text(stiff)
    text = run("friction", file).stdout
    assert "(friction if the rod kept its nap" in text
    assert "turned over:" not in text


def test_the_report_of_a_nap_tells_one_friction_of_one_rod(tmp_path, monkeypatch):
    """Of a rod by its scene, and by the option."""
    nothing_drawn = "frictionjax.report.friction._nap_pictures"
    monkeypatch.setattr(nothing_drawn, lambda *_: ({}, []))
    upright = '[[effects]]\nkind = "NapFlip"\nbending_stiffness = 0.1\n'
    file = example(tmp_path, "nap-flip")
    for text, option in ((file.read_text(), ()), (None, ("--bending-stiffness", 0.1))):
        if text is None:
            file.write_text(file.read_text().replace(upright, ""))
        assert run("nap", file, *option, "--report", "--out", tmp_path).exit_code == 0
        page = checked_page((tmp_path / "report.html").read_text(encoding="utf-8"))
        said = "to the left against 0.3618 N once the rod has turned over"
        assert said in page.text
        assert "to the left if the rod kept its nap." in page.text
        assert "(friction if the rod kept its nap" in page.text


def test_a_scene_without_such_effects_has_no_condition():
    law = fx.friction(read_job(None).scene)
    assert friction_sentence(law).endswith("0.08795 N to the left: 1.369 to 1.")
    assert "(friction" not in str(law.table())
    assert friction_of_slides(read_job(None).scene).rho_minus == law.rho_minus
