"""Errors of single beams are found, corrected and checked; rings that are no beams are left out."""

from dataclasses import replace

import numpy as np
import pytest

from recon4.calibration.parameters import Parameters
from recon4.calibration.stage import beam_counts, run_calibration
from recon4.model.beams import BeamCorrections
from recon4.model.calibration_figures import RigOutcome
from recon4.model.rig import load_rig
from recon4.progress import Silent
from recon4.store.frames import CALIBRATED_RIG, FrameStore, open_frames
from tests.said import rig_texts
from tests.unit.calibration.conftest import AUTO, store

BEAMS = replace(AUTO, calibration=replace(AUTO.calibration, beams=True))
DRAWN = [0.006, np.deg2rad(0.03), np.deg2rad(0.04)]


def corrections(seed):
    """Corrections that a calibration must find; what nothing observes is zero."""
    rows = np.random.default_rng(seed).standard_normal((3, 16)) * np.array(DRAWN)[:, None]
    return rows - rows.mean(axis=1, keepdims=True)


def wrong_beams(dance):
    """The walk as sensors measure it whose beams need these corrections."""
    true = [BeamCorrections.of(corrections(seed)) for seed in (1, 2)]
    frames = []
    for frame in dance:
        xyz = frame.xyz.copy()
        for row, beams in enumerate(true):
            mine = frame.sensor == row
            xyz[mine], _ = BeamCorrections.of(-beams.rows).apply(xyz[mine], frame.ring[mine])
        frames.append(replace(frame, xyz=xyz))
    return replace(dance, frames=frames), true


@pytest.fixture(scope="module")
def calibrated(dance, tmp_path_factory):
    walk, true = wrong_beams(dance)
    recorded = store(tmp_path_factory.mktemp("beams"), walk, walk.rig, walk.imu)
    found = run_calibration(recorded.frames, recorded.odometry, settings=BEAMS, progress=Silent())
    return recorded, found, true


@pytest.mark.study
def test_the_beams_are_corrected_and_other_windows_confirm_it(calibrated):
    _, found, true = calibrated

    assert found.figures.applied
    assert found.after.rms_m < 0.95 * found.before.rms_m
    for sensor, beams in zip(found.rig.sensors, true, strict=True):
        error = sensor.beams.rows - beams.rows
        assert np.sqrt(np.mean(error[0] ** 2)) < 0.001
        assert np.sqrt(np.mean(error[2] ** 2)) < np.deg2rad(0.02)


@pytest.mark.study
def test_what_the_walk_shows_is_within_its_standard_deviation(calibrated):
    recorded, found, true = calibrated
    known = [row for row in found.figures.beams if row.status != "not observable"]
    error = [
        row.change - true[number].rows[quantity, int(row.axis)]
        for row in known
        for number, sensor in enumerate(recorded.frames.rig.sensors)
        for quantity, name in enumerate(("beam range", "beam elevation", "beam azimuth"))
        if row.sensor == sensor.name and row.quantity == name
    ]

    assert len(known) > 40
    assert any("beams differs by up to" in text for text in rig_texts(found.figures))
    assert np.mean(np.abs(error) < 3.0 * np.array([row.sd for row in known])) > 0.8


@pytest.mark.study
def test_the_calibrated_rig_corrects_the_points_of_the_recording(calibrated, dance, tmp_path):
    recorded, found, _ = calibrated
    found.save(tmp_path)

    corrected = open_frames(recorded.frames.folder, tmp_path)

    assert load_rig(tmp_path / CALIBRATED_RIG).calibration.sd_beam_mm > 0.0
    for k in (0, 50):
        ideal, raw, after = dance[k].xyz, recorded.frames[k].xyz, corrected[k].xyz
        far = np.linalg.norm(ideal, axis=1) > 1.0
        before_m, after_m = (np.sqrt(np.mean((xyz - ideal)[far] ** 2)) for xyz in (raw, after))
        assert after_m < 0.5 * before_m


@pytest.mark.study
def test_good_beams_are_left_alone(right):
    one = replace(BEAMS, calibration=replace(BEAMS.calibration, sensors="s1"))
    found = run_calibration(right.frames, right.odometry, settings=one, progress=Silent())

    assert not found.figures.applied and found.rig is None
    assert found.figures.outcome.rig is RigOutcome.BEAMS_AGREE


def test_parameters_change_a_rig_as_they_compare_two(dance):
    parameters = Parameters.of(dance.rig, reference=0, lidars=(1,), imu=True)
    parameters = parameters.with_beams(dance.rig, {0: 16, 1: 16})
    delta = 0.001 * np.random.default_rng(3).standard_normal(len(parameters))

    changed = parameters.changed(dance.rig, delta)

    assert len(parameters) == 14 + 2 * 3 * 16
    assert np.allclose(parameters.between(dance.rig, changed), delta, atol=1e-9)
    assert parameters.listed[14].name.endswith("beam range 0")
    assert parameters.listed[-1].name.endswith("beam azimuth 15")


def test_the_mean_azimuth_stays_and_the_mean_range_is_known_to_a_millimeter(dance):
    parameters = Parameters.of(dance.rig, reference=0, lidars=(1,), imu=False)
    parameters = parameters.with_beams(dance.rig, {0: 16, 1: 16})
    common, azimuth = np.zeros(len(parameters)), np.zeros(len(parameters))
    for row in (0, 1):
        common[parameters.of_beams(row).start + np.arange(16)] = 1e-3
    azimuth[parameters.of_beams(1).start + 32 + np.arange(16)] = 1e-3

    assert azimuth @ parameters.prior @ azimuth > 1e5
    assert common @ parameters.prior @ common == pytest.approx(1.0, abs=0.1)


def test_rings_that_are_bands_of_elevation_are_no_beams(dance, right):
    generic = [replace(sensor, model="generic") for sensor in dance.rig.sensors]
    frames = FrameStore.open(right.frames.folder, replace(dance.rig, sensors=tuple(generic)))
    assert beam_counts(frames, (0, 1)) == {0: 16, 1: 16}

    bands = [replace(frame, ring=(frame.ring // 4).astype(np.uint8)) for frame in dance]
    banded = replace(dance, frames=bands, rig=replace(dance.rig, sensors=tuple(generic)))
    assert beam_counts(banded, (0, 1)) == {}
