"""Bad input of a calibration: a clear error or "not observable", and the old rig stays."""

import shutil
from dataclasses import replace

import numpy as np
import pytest

from recon4.calibration.stage import run_calibration
from recon4.cli.main import main
from recon4.geometry.se3 import SE3
from recon4.model.rig import format_rig, load_rig
from recon4.progress import Silent
from recon4.recording.report import ImportReport
from recon4.recording.samples.clean import clean_imu
from recon4.store.arrays import load_arrays, save_arrays
from recon4.store.frames import FrameStore, FrameWriter
from tests.said import outcome_text, rig_texts
from tests.unit.calibration.conftest import AUTO, SETTINGS, mounted, store, tracked

WRONG = {"turn_deg": (0.9, -0.8, 0.9), "shift_m": (0.012, -0.010, 0.012)}


def run(recorded, settings=AUTO):
    return run_calibration(recorded.frames, recorded.odometry, settings=settings, progress=Silent())


@pytest.mark.study
def test_a_sensor_that_the_recording_lacks_is_not_observable_and_stays(dance, tmp_path):
    wrong = mounted(dance.rig, 1, **WRONG)
    absent = replace(wrong.sensors[1], name="absent", T_body_sensor=SE3.identity())
    rig = replace(wrong, sensors=(*wrong.sensors, absent))
    with FrameWriter(tmp_path / "frames", rig) as writer:
        for frame in dance:
            writer.append(frame)
        writer.add(imu=dance.imu)

    found = run(tracked(tmp_path, FrameStore.open(tmp_path / "frames"), dance.rig))

    of_absent = [row for row in found.figures.parameters if row.sensor == "absent"]
    assert [row.status for row in of_absent] == ["not observable"] * 7
    assert not any("absent" in text for text in rig_texts(found.figures))
    if found.rig:
        assert np.array_equal(found.rig.sensors[2].T_body_sensor.R, np.eye(3))
        assert np.array_equal(found.rig.sensors[2].T_body_sensor.t, np.zeros(3))


@pytest.mark.study
def test_a_walk_of_five_seconds_shows_nothing_and_changes_nothing(dance, tmp_path):
    short = replace(dance, frames=dance.frames[:50])

    found = run(store(tmp_path, short, mounted(dance.rig, 1, **WRONG), dance.imu))

    assert not found.figures.applied
    assert found.rig is None
    assert outcome_text(found.figures) == (
        "Rig: the walk shows nothing of it. 14 of 14 parameters are not observable."
    )


@pytest.mark.parametrize(("with_imu", "windows"), [(True, 3), (False, 0)])
@pytest.mark.study
def test_poses_that_nothing_holds_compare_no_sensors(right, tmp_path, with_imu, windows):
    """Without an IMU they follow one of the LiDARs along what the multiframe does not observe."""
    odometry = tmp_path / "odometry"
    shutil.copytree(right.odometry, odometry)
    steps = load_arrays(odometry / "steps.npz")
    save_arrays(odometry / "steps.npz", steps | {"weak_sd_m": np.full(len(steps["lost"]), 0.06)})
    frames = right.frames if with_imu else replace(right.frames, imu=None)

    found = run(replace(right, frames=frames, odometry=odometry), SETTINGS)

    assert found.figures.windows == windows


def test_samples_that_are_no_numbers_are_left_out_and_counted(dance, tmp_path):
    gyro = dance.imu.gyro_rad_s.copy()
    gyro[::10] = np.nan
    report = ImportReport()
    imu = clean_imu(replace(dance.imu, gyro_rad_s=gyro), offset_s=0.0, jumps_ns=(), report=report)

    found = run(store(tmp_path, dance, dance.rig, imu))

    assert report.counts["imu_nan"] == len(gyro[::10])
    assert not rig_texts(found.figures)
    assert not found.figures.applied
    assert {row.sensor for row in found.figures.parameters} == {"s1", "imu"}


@pytest.mark.study
def test_a_gyroscope_alone_shows_no_position_of_the_imu(dance, tmp_path):
    imu = replace(dance.imu, accel_m_s2=np.full_like(dance.imu.accel_m_s2, np.nan))

    found = run(store(tmp_path, dance, dance.rig, imu))

    of_imu = {(row.quantity, row.axis): row.status for row in found.figures.parameters
              if row.sensor == "imu"}  # fmt: skip
    assert {of_imu["position", axis] for axis in "xyz"} == {"not observable"}
    assert of_imu["rotation", "z"] == "consistent"
    assert not found.figures.applied


PAIR = "0 0 0 0 0 0 1 {sensor}\n"


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        (["0 0 0 0 0 0 2"], "length 1"),
        (["nan 0 0 0 0 0 1"], "finite"),
        (["0 0 0 0 0 0 1", "5 0 0 1 0 0 0", "0 9 0 0 1 0 0"], "hand-eye|contradict"),
    ],
)
def test_pairs_that_are_wrong_write_no_rig(tmp_path, capsys, rows, said):
    rig = tmp_path / "rig.toml"
    rig.write_text(format_rig(load_rig("4recon")))
    before = rig.read_bytes()
    pairs = tmp_path / "pairs.csv"
    pairs.write_text("".join(PAIR.format(sensor=row) for row in rows))
    out = tmp_path / "new.toml"

    code = main(
        ["calibrate", str(pairs), "--rig", str(rig), "--out", str(out), "--method", "pairs"]
    )

    assert code != 0
    assert not out.exists()
    assert rig.read_bytes() == before
    text = capsys.readouterr().err
    assert any(word in text for word in said.split("|")), text
