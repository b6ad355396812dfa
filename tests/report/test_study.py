"""What a study keeps: times between which slips of the largest eps can be seen."""

import gc
import sys

import numpy as np
import pytest
import xarray as xr

import frictionjax as fx
from frictionjax.plot.trajectories import window_of_slips
from frictionjax.report.folder import write_record
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


def test_data_that_cannot_be_written_leave_no_view_of_freed_memory(tmp_path, monkeypatch):
    """An error that is kept keeps what was to be written; Python 3.13 says so, not 3.11."""
    data = {"sweep": xr.Dataset({"z": ("time", np.arange(3.0))})}
    said, kept = [], []
    monkeypatch.setattr(sys, "unraisablehook", said.append)
    with pytest.raises(OSError, match="sweep") as failed:
        write_record(tmp_path / "no folder", data, "", "")
    frame = failed.value.__traceback__
    while frame is not None:
        kept += frame.tb_frame.f_locals.values()
        frame = frame.tb_next
    views = [one for one in kept if isinstance(one, memoryview)]
    assert all(isinstance(view.obj, bytes) for view in views)
    del failed, frame, kept, views
    gc.collect()
    assert not said
