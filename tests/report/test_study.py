"""What a study keeps: times between which slips of the largest eps can be seen."""

import numpy as np

import frictionjax as fx
from frictionjax.plot.trajectories import window_of_slips
from frictionjax.report.job import read_job
from frictionjax.report.study import study_times
from frictionjax.report.study_words import verdict_sentence


def test_rows_without_an_order_say_so():
    """They said: like eps^nan in the median row."""
    scenes = [read_job(None).scene.replace(z0=z0) for z0 in (0.0, 0.01)]
    found = fx.study(fx.sweep(scenes, [0.1, 0.05], 1.0))
    told = verdict_sentence(found, fx.friction(scenes[0]))
    assert "nan" not in told
    assert told.startswith("At gamma = 1, in none of the rows of the map: too few cells")


def test_the_default_study_shows_a_few_slips_close_up():
    job = read_job(None)
    ts, eps = study_times(job), float(np.max(job.study["eps"]))
    limit = np.asarray(fx.solve_limit(job.scene, ts).z)
    window = window_of_slips(ts, limit, eps)
    assert window is not None
    inside = (ts >= window[0]) & (ts <= window[1])
    slips = np.ptp(limit[inside]) / eps
    assert inside.sum() / slips >= 8
