"""A rig file that is wrong is found, measured and, on request, calibrated."""

from dataclasses import replace

import numpy as np
import pytest

from recon4.calibration.parameters import Parameters
from recon4.calibration.stage import run_calibration
from recon4.errors import ConfigError, StoreError
from recon4.geometry.se3 import so3_exp
from recon4.model.calibration_figures import RigOutcome
from recon4.model.hidden_points import HiddenPoints
from recon4.model.rig import load_rig
from recon4.progress import Silent
from recon4.store.frames import FrameStore, open_frames
from tests import scanned_room
from tests.said import outcome_text, rig_texts
from tests.unit.calibration.conftest import (
    AUTO,
    CALIBRATION,
    COLUMNS,
    SETTINGS,
    circle,
    imu_mounted,
    mounted,
    planar,
    store,
    straight,
    tracked,
)

WRONG = {"turn_deg": (0.9, -0.8, 0.9), "shift_m": (0.012, -0.010, 0.012), "late_s": 0.005}


def run(recorded, settings=SETTINGS):
    return run_calibration(recorded.frames, recorded.odometry, settings=settings, progress=Silent())


def rows_of(result, sensor):
    return [row for row in result.figures.parameters if row.sensor == sensor]


@pytest.fixture(scope="module")
def wrong(dance, tmp_path_factory):
    """1.5° and 2 cm off, both clocks 5 ms off, the IMU 1.5° off."""
    rig = imu_mounted(mounted(dance.rig, 1, **WRONG), turn_deg=(-0.9, 0.8, 0.9), late_s=-0.005)
    return store(tmp_path_factory.mktemp("wrong"), dance, rig, dance.imu)


@pytest.fixture(scope="module")
def audited(wrong):
    return run(wrong)


@pytest.fixture(scope="module")
def calibrated(wrong):
    return run(wrong, AUTO)


@pytest.fixture(scope="module")
def confirmed(right):
    """A calibration is requested: it ends with the audit, as nothing contradicts the rig file."""
    return run(right, AUTO)


@pytest.mark.study
def test_a_rig_file_that_is_right_is_confirmed(confirmed):
    found = confirmed

    assert not rig_texts(found.figures)
    assert found.figures.outcome.rig is RigOutcome.AGREES
    assert not any(row.status == "off" for row in found.figures.parameters)
    assert not found.figures.changes
    assert sum(row.status == "consistent" for row in found.figures.parameters) >= 11


@pytest.mark.study
def test_errors_of_mounts_and_clocks_are_measured_with_a_true_deviation(wrong, audited):
    found = audited

    parameters = Parameters.of(wrong.true, reference=0, lidars=(1,), imu=True)
    error = np.array([row.change for row in found.figures.parameters]) - parameters.between(
        wrong.frames.rig, wrong.true
    )
    unit = np.array([row.unit for row in found.figures.parameters])
    position = np.array([row.quantity == "position" for row in found.figures.parameters])
    imu = np.array([row.sensor == "imu" for row in found.figures.parameters])
    assert np.rad2deg(np.abs(error[unit == "rad"])).max() < 0.1
    assert np.abs(error[position & ~imu]).max() < 0.004
    assert np.abs(error[unit == "s"]).max() < 5e-4
    sd = np.array([row.sd for row in found.figures.parameters])
    assert np.mean(np.abs(error) < 3.0 * sd) >= 0.9
    assert len(rig_texts(found.figures)) == 2
    assert (
        "the LiDAR 's1' differs from it. Its rotation differs by 1.5" in rig_texts(found.figures)[0]
    )


@pytest.mark.study
def test_an_audit_changes_nothing(audited):
    assert not audited.figures.applied
    assert audited.rig is None


@pytest.mark.study
def test_a_confirmed_calibration_is_written_and_used(wrong, calibrated, tmp_path):
    found = calibrated
    figures = found.save(tmp_path)

    assert figures.applied, figures.outcome
    assert figures.windows == 2 * AUTO.calibration.windows
    assert found.after.rms_m < found.before.rms_m
    assert found.after.offset_m < 0.5 * found.before.offset_m
    assert found.after.imu_rms < found.before.imu_rms
    frames = open_frames(wrong.frames.folder, tmp_path)
    there = frames.rig.sensors[1].T_body_sensor
    true = wrong.true.sensors[1].T_body_sensor
    assert np.rad2deg((true.inverse() @ there).angle()) < 0.1
    assert np.linalg.norm(there.t - true.t) < 0.006
    late_ns = wrong.frames[3].dt_ns - frames[3].dt_ns
    of_second = wrong.frames[3].sensor == 1
    assert np.all(late_ns[~of_second] == 0)
    np.testing.assert_allclose(late_ns[of_second], 5e6, atol=5e5)
    assert abs(int(frames.imu.t_ns[0] - wrong.frames.imu.t_ns[0]) - 5_000_000) < 500_000
    assert load_rig(tmp_path / "rig.toml").name == wrong.true.name


class Slipped:
    """A walk in whose second half a LiDAR has turned by 2.5° about its own y axis."""

    def __init__(self, walk):
        self.rig, self._frames = walk.rig, list(walk)

    def __iter__(self):
        R = so3_exp(np.deg2rad([0.0, 2.5, 0.0])).astype(np.float32)
        for k, frame in enumerate(self._frames):
            turned = (frame.sensor == 1) & (2 * k >= len(self._frames))
            yield replace(frame, xyz=np.where(turned[:, None], frame.xyz @ R.T, frame.xyz))


def test_a_mount_that_slips_during_the_walk_is_announced_and_not_calibrated(dance, tmp_path):
    slipped = store(tmp_path, Slipped(dance), dance.rig, dance.imu)

    figures = run(slipped, AUTO).figures

    assert figures.changes and figures.is_severe
    (text,) = rig_texts(figures)
    assert "The rig does not stay the same during the walk" in text
    assert "A mount has slipped, or a clock has jumped" in text
    assert not figures.applied


@pytest.mark.study
def test_a_right_rig_file_is_not_changed_on_request(right, confirmed, tmp_path):
    figures = confirmed.save(tmp_path)

    assert not figures.applied
    assert not (tmp_path / "rig.toml").exists()
    assert open_frames(right.frames.folder, tmp_path).rig.sensors[1].T_body_sensor.t.tolist() == (
        right.true.sensors[1].T_body_sensor.t.tolist()
    )


@pytest.fixture(scope="module")
def exchanged(dance, tmp_path_factory):
    """Each LiDAR has the mount of the other in the rig file."""
    first, second = dance.rig.sensors
    rig = replace(
        dance.rig,
        sensors=(
            replace(first, T_body_sensor=second.T_body_sensor),
            replace(second, T_body_sensor=first.T_body_sensor),
        ),
    )
    return store(tmp_path_factory.mktemp("exchanged"), dance, rig, dance.imu)


EXCHANGED = "The mounts of 's0' and 's1' seem to be exchanged in the rig file."


@pytest.mark.study
def test_exchanged_mounts_are_called_so(exchanged):
    figures = run(exchanged).figures

    assert rig_texts(figures) == [f"{EXCHANGED} Exchange them in the rig file."]
    assert not figures.imu_faults


@pytest.mark.study
def test_exchanged_mounts_are_called_so_where_their_points_passed_for_moving_objects(exchanged):
    """What a LiDAR sees through a wrong mount contradicts the map, as moving objects do."""
    moving = ((frame.sensor == 1) & (np.arange(len(frame)) % 128 > 0) for frame in exchanged.frames)
    hidden = HiddenPoints.of(moving)
    recorded = replace(exchanged, frames=replace(exchanged.frames, hidden=hidden))

    assert EXCHANGED in " ".join(rig_texts(run(recorded).figures))


@pytest.mark.study
def test_an_imu_that_is_far_off_asks_for_no_other_mounts(dance, tmp_path, monkeypatch):
    def never(*_args, **_named):
        raise AssertionError("mounts are searched")

    monkeypatch.setattr("recon4.calibration.calibrate.search_mounts", never)
    found = run(store(tmp_path, dance, imu_mounted(dance.rig, turn_deg=(0, 0, 90)), dance.imu))

    turned = np.rad2deg(np.linalg.norm([row.change for row in rows_of(found, "imu")[:3]]))
    assert turned == pytest.approx(90.0, abs=0.2)


@pytest.mark.study
def test_without_an_imu_the_lidars_are_compared(dance, tmp_path):
    found = run(store(tmp_path, dance, mounted(dance.rig, 1, **WRONG), None))

    assert {row.sensor for row in found.figures.parameters} == {"s1"}
    turned = np.rad2deg(np.linalg.norm([row.change for row in rows_of(found, "s1")[:3]]))
    assert turned == pytest.approx(1.5, abs=0.1)


@pytest.mark.study
def test_one_lidar_without_an_imu_leaves_nothing_to_compare(dance, tmp_path):
    first, second = dance.rig.sensors
    rig = replace(dance.rig, sensors=(first, replace(second, enabled=False)))
    found = run(store(tmp_path, dance, rig, None))

    assert found.figures.outcome.rig is RigOutcome.NOTHING_TO_COMPARE
    assert found.figures.parameters == ()


@pytest.mark.study
def test_who_stands_still_learns_nothing_wrong(tmp_path):
    still = scanned_room.walk(scanned_room.standing, 60, noise_m=0.01, columns=COLUMNS)
    found = run(store(tmp_path, still, imu_mounted(still.rig, turn_deg=(0, 0, 1.5)), still.imu))

    status = {(row.quantity, row.axis): row.status for row in rows_of(found, "imu")}
    assert status["rotation", "z"] == "not observable"
    assert status["clock", ""] == "not observable"


@pytest.mark.study
def test_turns_about_the_vertical_leave_axes_unobservable(tmp_path):
    flat = scanned_room.walk(planar, 70, noise_m=0.01, columns=COLUMNS)
    found = run(store(tmp_path, flat, flat.rig, flat.imu), AUTO)

    unknown = {(row.sensor, row.quantity, row.axis) for row in found.figures.parameters
               if row.status == "not observable"}  # fmt: skip
    assert ("imu", "position", "z") in unknown
    assert not found.figures.applied


@pytest.fixture(scope="module")
def on_a_circle():
    """At a constant turn rate, where heading and clock of a LiDAR look alike."""
    return scanned_room.walk(circle, 90, noise_m=0.01, columns=COLUMNS)


@pytest.mark.study
def test_on_a_circle_a_right_rig_file_raises_no_alarm(on_a_circle, tmp_path, monkeypatch):
    """Noise added up to 0.28 s in the direction that is not shown, and other mounts were tried."""

    def never(*_args, **_named):
        raise AssertionError("mounts are searched")

    monkeypatch.setattr("recon4.calibration.calibrate.search_mounts", never)
    found = run(store(tmp_path, on_a_circle, on_a_circle.rig, on_a_circle.imu))

    assert not rig_texts(found.figures)
    clock = {row.quantity: row for row in rows_of(found, "s1")}["clock"]
    assert clock.status == "not observable"
    assert abs(clock.change) < 1e-3


@pytest.mark.study
@pytest.mark.parametrize(("motion", "corrected"), [(circle, 4), (straight, 0)])
def test_what_a_walk_does_not_show_keeps_its_value_and_pulls_nothing_along(
    motion, corrected, tmp_path
):
    """Held at their wrong values, they pulled others 25 cm away."""
    walk = scanned_room.walk(motion, 120, noise_m=0.01, columns=COLUMNS)
    turn_deg, shift_m = np.array([0.866, -0.866, 0.866]), np.array([0.0115, -0.0115, 0.0115])
    rig = mounted(walk.rig, 1, turn_deg=turn_deg, shift_m=shift_m, late_s=0.005)
    rig = imu_mounted(rig, turn_deg=-turn_deg, late_s=-0.005)
    found = run(store(tmp_path, walk, rig, walk.imu), AUTO)

    parameters = Parameters.of(rig, reference=0, lidars=(1,), imu=True)
    before = np.abs(parameters.between(walk.rig, rig))
    after = np.abs(parameters.between(walk.rig, found.rig or rig))
    assert np.all(after <= before + 1e-5)
    assert np.sum(after < 0.1 * before) >= corrected
    status = {(row.quantity, row.axis): row.status for row in rows_of(found, "s1")}
    assert status["clock", ""] == "not observable"


def test_only_the_sensors_that_are_named_are_calibrated(wrong):
    only = replace(CALIBRATION, sensors="s1")
    found = run(wrong, replace(SETTINGS, calibration=only))

    assert {row.sensor for row in found.figures.parameters} == {"s1"}


@pytest.mark.parametrize(
    "change", [{"sensors": "s1, camera"}, {"reference": "camera"}, {"reference": "imu"}]
)
def test_a_sensor_that_is_not_in_the_rig_is_refused(right, change):
    with pytest.raises(ConfigError, match=r"expected .* got '(camera|imu)'"):
        run(right, replace(SETTINGS, calibration=replace(CALIBRATION, **change)))


@pytest.mark.study
def test_a_calibration_that_is_refused_leaves_the_warnings_of_the_audit(wrong, audited):
    short = replace(CALIBRATION, mode="auto", windows=2)
    found = run(wrong, replace(SETTINGS, calibration=short))

    assert not found.figures.applied
    assert found.figures.outcome.rig is RigOutcome.TOO_SHORT
    assert "too short to check the calibrated rig" in outcome_text(found.figures)
    assert rig_texts(found.figures) == rig_texts(audited.figures)
    assert found.figures.is_severe


def test_a_few_multiframes_are_too_few(dance, tmp_path):
    few = replace(dance, frames=dance.frames[:5])
    found = run(store(tmp_path, few, mounted(dance.rig, 1, **WRONG), dance.imu), AUTO)

    assert not found.figures.applied


def test_off_is_off(right):
    found = run(right, replace(SETTINGS, calibration=replace(CALIBRATION, mode="off")))

    assert found.figures.outcome.rig is RigOutcome.OFF


def test_a_calibrated_rig_of_other_sensors_is_refused(right, dance):
    renamed = tuple(replace(sensor, name=sensor.name + "x") for sensor in dance.rig.sensors)

    with pytest.raises(StoreError, match="other sensors"):
        FrameStore.open(right.frames.folder, replace(dance.rig, sensors=renamed))


@pytest.mark.study
def test_tracking_with_the_calibrated_rig_is_better(wrong, calibrated, tmp_path):
    repeated = tracked(tmp_path, wrong.frames.with_rig(calibrated.rig), wrong.true)

    before = np.load(wrong.odometry / "steps.npz")["error_m"]
    after = np.load(repeated.odometry / "steps.npz")["error_m"]
    assert np.nanmedian(after) < 0.7 * np.nanmedian(before)
