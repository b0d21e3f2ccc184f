"""Real logs of 2-D lasers: loops closed, compared with the relations of the Freiburg benchmark."""

import bz2
import itertools

import numpy as np
import pytest

from recon4.evaluation.relations import read_relations, relation_errors
from recon4.evaluation.trajectories import find_trajectory
from recon4.model.usability import Usability
from recon4.pipeline import process
from recon4.recording.lasers.laser2d import read_laser2d
from recon4.recording.report import ImportReport
from recon4.recording.sources import Sources
from recon4.settings import Settings, override
from recon4.workflows.planar_results import Summary2d
from tests.planar_walks import write_carmen

PUBLISHED_M, PUBLISHED_DEG = 0.045, 0.6
"""Class of published graph SLAM on the log aces."""


@pytest.mark.study
def test_aces_is_as_good_as_published_graph_slam(tmp_path, data):
    summary = process(Sources((data("laser2d/aces.clf.bz2"),)), tmp_path)

    errors = relation_errors(
        find_trajectory(tmp_path), read_relations(data("laser2d/aces.relations"))
    )
    assert isinstance(summary, Summary2d)
    assert (errors.relations, errors.outside) == (1279, 0)
    assert errors.translation_mean_m < PUBLISHED_M
    assert np.rad2deg(errors.rotation_mean_rad) < PUBLISHED_DEG
    assert summary.loops > 50
    assert summary.verdict.usability is Usability.GOOD
    assert sum(stage.cpu_seconds for stage in summary.stages) < 0.2 * summary.duration_s


@pytest.mark.study
def test_aces_needs_no_odometry(tmp_path, data):
    """Its first third, in which it comes back to places."""
    whole = read_laser2d([data("laser2d/aces.clf.bz2")], ImportReport())
    write_carmen(tmp_path / "aces.log", whole[: len(whole) // 3])
    relations = read_relations(data("laser2d/aces.relations"))
    settings = override(Settings(), ["slam2d.use_odometry=false"])
    process(Sources((tmp_path / "aces.log",)), tmp_path / "out", settings=settings)

    errors = relation_errors(find_trajectory(tmp_path / "out"), relations)
    assert errors.relations > 300
    assert errors.translation_mean_m < PUBLISHED_M
    assert np.rad2deg(errors.rotation_mean_rad) < PUBLISHED_DEG


@pytest.mark.parametrize("cut", [0.3, pytest.param(0.9, marks=pytest.mark.study)])
def test_intel_that_is_cut_off_is_mapped_as_far_as_it_goes(tmp_path, data, cut):
    packed = data("laser2d/intel.clf.bz2").read_bytes()
    (tmp_path / "cut.clf.bz2").write_bytes(packed[: int(cut * len(packed))])

    found = read_laser2d([tmp_path / "cut.clf.bz2"], report := ImportReport())

    assert report.outcome == "lossy"
    assert 0.7 * cut * 13631 < len(found) < 13631


@pytest.mark.study
def test_intel_closes_its_loops(tmp_path, data):
    """The first of three rounds; all of them: ``python -m tests.benchmarks.laser2d``."""
    log = tmp_path / "intel.clf"
    with bz2.open(data("laser2d/intel.clf.bz2")) as packed:
        scans = (line for line in packed if line.startswith(b"FLASER"))
        log.write_bytes(b"".join(itertools.islice(scans, 5000)))

    summary = process(Sources((log,)), tmp_path / "out")

    assert isinstance(summary, Summary2d)
    assert (summary.scans, summary.lost) == (5000, 0)
    assert summary.loops > 150
    assert summary.grid.crossing_ratio < 0.07
    assert summary.verdict.usability is Usability.GOOD
    assert sum(stage.cpu_seconds for stage in summary.stages) < 0.2 * summary.duration_s
