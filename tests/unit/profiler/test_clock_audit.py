"""Clocks that differ are found by the heading and by the sharpness of the points, and said."""

import re
import shutil
from dataclasses import replace

import numpy as np
import pytest

from recon4.findings.witnesses.lines import line_findings
from recon4.geometry.se3 import SE3
from recon4.model.trajectory import Trajectory
from recon4.profiler.clock_audit import clock_lag, profiler_ahead_s, some_points
from recon4.profiler.fusion import PlanarPoses
from recon4.profiler.stage_odometry import line_figures, run_line_odometry, span_of
from recon4.progress import Silent
from recon4.settings import override
from recon4.store.arrays import save_record
from recon4.store.frames import FrameStore
from recon4.store.line_store import load_laser_scans
from tests.said import line_texts, texts


def planar_poses(truth, *, ahead_s=0.0, count=500):
    """Headings by a 2-D laser, if the clock of the IMU is ahead."""
    span_ns = int(truth.t_ns[-1] - truth.t_ns[0])
    t_ns = truth.t_ns[0] + np.linspace(0.1 * span_ns, 0.9 * span_ns, count).astype(np.int64)
    rng = np.random.default_rng(1)
    noise = np.zeros((count, 6))
    noise[:, 2] = 5e-4 * rng.standard_normal(count)
    T = truth.at(t_ns - round(1e9 * ahead_s)) @ SE3.exp(noise)
    return PlanarPoses(t_ns, T, np.tile(np.eye(3), (count, 1, 1)), SE3.identity())


def drifting(truth):
    """The attitude by a gyroscope with a bias."""
    turn = np.zeros((len(truth), 6))
    turn[:, 2] = 0.003 * 1e-9 * (truth.t_ns - truth.t_ns[0])
    return Trajectory(truth.t_ns, SE3.exp(turn) @ truth.T_a_b)


@pytest.mark.parametrize("ahead_s", [0.0, 0.05, -0.03, 0.012])
def test_the_difference_of_imu_and_laser_is_found(truth, ahead_s):
    lag = clock_lag(planar_poses(truth, ahead_s=-ahead_s), drifting(truth))

    assert lag.ahead_s == pytest.approx(ahead_s, abs=0.002)
    assert lag.is_wrong == (abs(ahead_s) > 0.01)


def test_a_walk_that_does_not_turn_shows_no_clock(truth):
    straight = Trajectory(truth.t_ns, SE3(np.tile(np.eye(3), (len(truth), 1, 1)), truth.T_a_b.t))

    assert clock_lag(planar_poses(straight), straight) is None


@pytest.mark.parametrize("ahead_s", [0.0, 0.03, -0.045])
def test_the_difference_of_the_profiler_is_found(frames, truth, ahead_s):
    points = some_points(frames, min_range_m=1.5)
    trajectory = Trajectory(truth.t_ns - round(1e9 * ahead_s), truth.T_a_b)

    assert profiler_ahead_s(points, trajectory) == pytest.approx(ahead_s, abs=0.004)


def shifted(frames, folder, *, imu_s=0.0, lines_s=0.0):
    """The recording with other clocks."""
    shutil.copytree(frames.folder, folder)
    shift_ns = round(1e9 * imu_s)
    save_record(folder / "imu.npz", replace(frames.imu, t_ns=frames.imu.t_ns + shift_ns))
    index = np.load(folder / "index.npy")
    index["t_ns"] += round(1e9 * lines_s)
    np.save(folder / "index.npy", index)
    return FrameStore.open(folder)


@pytest.mark.parametrize(
    ("clocks", "words"),
    [
        ({"imu_s": 0.06}, "the clock of the IMU is (59|60|61) ms ahead of that of the 2-D laser"),
        ({"lines_s": -0.04}, "the clock of the profiler is (39|40|41) ms behind those of the IMU"),
    ],
)
@pytest.mark.study
def test_wrong_clocks_are_said(frames, settings, tmp_path, clocks, words):
    store = shifted(frames, tmp_path / "frames", **clocks)
    (tmp_path / "out").mkdir()

    found = run_line_odometry(store, tmp_path / "out", settings=settings, progress=Silent())

    assert len(line_texts(found)) == 1
    assert "time_offset_s" in line_texts(found)[0]
    assert re.search(words, line_texts(found)[0]), line_texts(found)


@pytest.mark.parametrize("changed", ["without times", "as hector"])
@pytest.mark.study
def test_scans_that_are_not_undistorted_do_not_blame_the_clocks(
    frames, settings, tmp_path, changed
):
    shutil.copytree(frames.folder, tmp_path / "frames")
    arrays = dict(np.load(tmp_path / "frames" / "laser2d.npz"))
    if changed == "without times":
        np.savez(
            tmp_path / "frames" / "laser2d.npz",
            **arrays | {"time_step_s": 0.0 * arrays["time_step_s"]},
        )
    else:
        settings = override(settings, ["slam2d.method=hector"])
    (tmp_path / "out").mkdir()
    store = FrameStore.open(tmp_path / "frames")

    found = run_line_odometry(store, tmp_path / "out", settings=settings, progress=Silent())

    assert "clock" not in " ".join(line_texts(found))


def test_a_silent_laser_is_said(frames):
    scans, span_ns = load_laser_scans(frames.folder), span_of(frames)
    since_s = 1e-9 * (scans.t_ns - span_ns[0])
    kept = scans[(since_s < 5.0) | (since_s > 9.0)]

    (text,) = texts(line_findings(line_figures(kept, span_ns, is_used=True)))

    assert "silent for 4.1 s, first 5.0 s after the start" in text
    assert not list(line_findings(line_figures(scans, span_ns, is_used=True)))


def test_scans_of_another_time_are_said(frames):
    scans, span_ns = load_laser_scans(frames.folder), span_of(frames)
    away = replace(scans, t_ns=scans.t_ns + 5_000_000_000_000)

    (text,) = texts(line_findings(line_figures(away, span_ns, is_used=False)))

    assert "cover 5000." in text
    assert "are the clocks the same" in text
