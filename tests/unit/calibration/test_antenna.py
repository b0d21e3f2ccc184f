"""The GNSS receiver in the stage ``calibration``: compared always, corrected on request."""

from dataclasses import replace

import numpy as np
import pytest

from recon4.calibration.antenna import with_antenna
from recon4.calibration.recorded_walk import RecordedWalk
from recon4.calibration.result import CalibrationResult
from recon4.calibration.stage import run_calibration
from recon4.georeference.crs import GeodeticOrigin, to_geodetic
from recon4.georeference.stage import RefinedWalk, level_and_georeference
from recon4.georeference.tuning import GnssTuning
from recon4.model.calibration_figures import (
    CalibrationFigures,
    CalibrationOutcome,
    GnssOutcome,
    RigOutcome,
)
from recon4.model.pose_graph import Edge, EdgeKind, PoseGraph, Verdict, known_history
from recon4.model.rig import load_rig, parse_rig
from recon4.model.samples import GnssSamples
from recon4.progress import Silent
from recon4.settings import Settings
from tests.said import rig_texts
from tests.unit.calibration.conftest import CALIBRATION

ARM = np.array([-0.2, 0.1, 0.6])
ERROR = np.array([0.1, -0.07, 0.0])
LATE_S = 0.04
PLACE = GeodeticOrigin(np.deg2rad(49.2), np.deg2rad(16.6), 250.0)
NEAR = GnssTuning(min_extent_m=0.5)


def settings(mode, sensors="gnss"):
    return Settings(calibration=replace(CALIBRATION, mode=mode, sensors=sensors), gnss=NEAR)


@pytest.fixture(scope="module")
def outdoors(dance, right):
    """The lever arm is 12 cm off, and the clock of the receiver 40 ms ahead."""
    t_ns = np.arange(dance.truth.t_ns[0] + 10**8, dance.truth.t_ns[-1] - 10**8, 2 * 10**7)
    T = dance.truth.at(t_ns)
    rng = np.random.default_rng(4)
    p = T @ np.tile(ARM, (len(t_ns), 1)) + 0.005 * rng.standard_normal((len(t_ns), 3))
    roll, pitch, yaw = T.rpy().T
    gnss = GnssSamples(
        t_ns + round(1e9 * LATE_S),
        *to_geodetic(PLACE, p),
        np.full((len(t_ns), 3), 0.005),
        np.full(len(t_ns), 4, np.uint8),
        np.stack([roll, -pitch, 0.5 * np.pi - yaw], axis=1),
    )
    rig = replace(right.frames.rig, p_body_antenna=ARM + ERROR)
    return replace(right, frames=replace(right.frames, gnss=gnss, rig=rig, recorded=rig))


@pytest.fixture(scope="module")
def walk(outdoors):
    return RecordedWalk.of(outdoors.frames, outdoors.odometry, Settings().odometry)


@pytest.fixture(scope="module")
def agreed():
    """What was found of LiDARs that are where the rig says."""
    return CalibrationResult(
        figures=CalibrationFigures(outcome=CalibrationOutcome(rig=RigOutcome.AGREES))
    )


@pytest.mark.study
def test_heights_above_sea_level_are_raised_by_the_geoid_that_the_settings_have(walk):
    rows = np.arange(0, len(walk.trajectory), 20)
    nodes = walk.trajectory.T_a_b[rows]
    edges = tuple(
        Edge(
            i=i,
            j=i + 1,
            T_i_j=nodes[i].inverse() @ nodes[i + 1],
            kind=EdgeKind.ODOMETRY,
            information=1e5 * np.eye(6),
            judgments=known_history(Verdict.ACCEPTED),
        )
        for i in range(len(rows) - 1)
    )
    graph = PoseGraph(rows, walk.trajectory.t_ns[rows], nodes, edges)
    refined = RefinedWalk(trajectory=walk.trajectory, graph=graph)

    heights_m = []
    for gnss in (NEAR, replace(NEAR, heights="orthometric", geoid_separation_m=44.2)):
        made = level_and_georeference(
            walk.frames, refined, settings=Settings(gnss=gnss), progress=Silent()
        )
        heights_m.append(made.georeference.origin.ellipsoidal_height_m)

    assert heights_m[1] - heights_m[0] == pytest.approx(44.2)


@pytest.mark.study
def test_an_audit_compares_the_receiver_and_changes_nothing(walk, agreed):
    found = with_antenna(agreed, walk, settings=settings("audit"), progress=Silent())

    assert [row.sensor for row in found.figures.parameters] == ["gnss"] * 4
    assert found.figures.outcome.rig is RigOutcome.AGREES
    assert found.figures.outcome.gnss is GnssOutcome.CONTRADICTS
    assert not found.figures.applied
    assert found.rig is None
    assert not found.figures.is_severe


def test_on_request_the_receiver_is_corrected_and_its_fixes_are_shifted(
    outdoors, walk, agreed, tmp_path
):
    found = with_antenna(agreed, walk, settings=settings("auto"), progress=Silent())
    found.save(tmp_path)

    assert found.figures.applied, found.figures.outcome
    assert (
        "the GNSS antenna differs from it. Its position differs by 1" in rig_texts(found.figures)[0]
    )
    assert "The calibrated rig is used for this map." in rig_texts(found.figures)[0]
    rig = load_rig(tmp_path / "rig.toml")
    assert np.all(np.abs(rig.p_body_antenna - ARM)[:2] < 0.01)
    assert rig.gnss_time_offset_s == pytest.approx(-LATE_S, abs=0.002)
    assert rig.calibration.method == "gnss"
    assert 0.0 < rig.calibration.sd_gnss_ms < 2.0
    note = parse_rig((tmp_path / "rig.toml").read_text("utf-8"), where="rig").calibration
    assert note == rig.calibration


def test_a_sensor_that_is_not_named_stays(walk, agreed):
    found = with_antenna(agreed, walk, settings=settings("auto", sensors="imu"), progress=Silent())

    assert found is agreed


def test_with_mounts_that_are_wrong_nothing_is_corrected(walk):
    wrong = CalibrationResult(figures=CalibrationFigures(exchanged=(("front", "rear"),)))

    found = with_antenna(wrong, walk, settings=settings("auto"), progress=Silent())

    assert len(found.figures.parameters) == 4
    assert found.rig is None


def test_the_note_of_the_mounts_stays_beside_that_of_the_receiver(walk, agreed):
    note = parse_rig(
        'name = "r"\n[[sensor]]\nname = "a"\n[calibration]\ndate = "2026-01-02"\n'
        'method = "joint"\nsd_deg = 0.02\nsd_mm = 1.0\nsd_ms = 0.1\n',
        where="rig",
    ).calibration
    rig = replace(walk.frames.rig, calibration=note)
    noted = replace(walk, frames=replace(walk.frames, rig=rig, recorded=rig))

    found = with_antenna(agreed, noted, settings=settings("auto"), progress=Silent())

    assert found.rig.calibration.method == "joint"
    assert found.rig.calibration.date == "2026-01-02"
    assert found.rig.calibration.sd_antenna_mm > 0.0


def test_the_stage_runs_it(outdoors):
    found = run_calibration(
        outdoors.frames, outdoors.odometry, settings=settings("audit"), progress=Silent()
    )

    assert [row.sensor for row in found.figures.parameters] == ["gnss"] * 4
