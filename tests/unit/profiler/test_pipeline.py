"""The stages of a rig with a profiler on a short simulated walk."""

import shutil
from dataclasses import replace

import numpy as np
import pytest

from recon4.evaluation.ate import absolute_error, pair_poses
from recon4.model.pose_graph import EdgeKind, Verdict
from recon4.pose_graph.files import load_graph
from recon4.profiler.line_refine import refine_lines
from recon4.profiler.samples import line_points
from recon4.profiler.stage_odometry import run_line_odometry
from recon4.profiler.sweep_graph import build_sweep_graph
from recon4.profiler.sweeps import unwind_sweeps
from recon4.profiler.tuning import LineTuning
from recon4.progress import Silent
from recon4.settings.tuning import tuned
from recon4.store.arrays import load_arrays, load_trajectory
from recon4.store.frames import FrameStore
from recon4.store.line_store import LineStoreWriter, load_laser_scans, load_lines
from tests.said import line_texts


@pytest.fixture(scope="module")
def odometry(frames, settings, tmp_path_factory):
    out = tmp_path_factory.mktemp("odometry")
    figures = run_line_odometry(frames, out, settings=settings, progress=Silent())
    return out, figures


@pytest.fixture(scope="module")
def graph_folder(frames, odometry, settings, tmp_path_factory):
    out = tmp_path_factory.mktemp("graph")
    build_sweep_graph(frames, odometry[0], out, settings=settings, progress=Silent())
    return out


def position_rmse_m(trajectory, truth):
    return absolute_error(pair_poses(trajectory, truth)).position_m.rmse


def test_the_first_trajectory_is_near_the_truth(odometry, truth):
    folder, figures = odometry

    trajectory = load_trajectory(folder / "trajectory.npz")

    assert figures.imu
    assert figures.lost == 0
    assert not line_texts(figures)
    assert position_rmse_m(trajectory, truth) < 0.06


def test_turns_are_unwound_by_the_pose_of_every_point(frames, truth, settings):
    lines = load_lines(frames.folder)

    sweeps = unwind_sweeps(
        frames, lines, truth, settings=tuned(LineTuning, settings.lines), progress=Silent()
    )

    ends = lines.sweeps()
    assert len(sweeps) == len(ends) - 1
    assert sum(sweep.lines for sweep in sweeps.sweeps) == len(lines)
    # With the true poses the floor is flat in every turn.
    for k, sweep in enumerate(sweeps.sweeps):
        z = (truth.at(sweeps.t_ns[k : k + 1])[0] @ sweep.points.astype(float))[:, 2]
        floor = z[np.abs(z) < 0.1]
        assert len(floor) > 100
        assert np.abs(floor).mean() < 0.01


def test_turns_that_see_the_same_are_linked_and_registered(graph_folder):
    graph = load_graph(graph_folder)

    kinds = {kind: [e for e in graph.edges if e.kind is kind] for kind in EdgeKind}
    assert len(graph) >= 4
    assert len(kinds[EdgeKind.ODOMETRY]) == len(graph) - 1
    assert len(kinds[EdgeKind.NEIGHBOR]) >= 3
    accepted = [e for e in kinds[EdgeKind.NEIGHBOR] if e.verdict is Verdict.ACCEPTED]
    assert len(accepted) >= len(kinds[EdgeKind.NEIGHBOR]) / 2
    assert all(0.0 < edge.overlap <= 1.0 for edge in kinds[EdgeKind.NEIGHBOR])


def test_refined_lines_lie_within_two_centimeters(frames, odometry, graph_folder, settings, truth):
    before = load_trajectory(odometry[0] / "trajectory.npz")

    found = refine_lines(
        frames, odometry[0], load_graph(graph_folder).nodes, settings=settings, progress=Silent()
    )

    error = absolute_error(pair_poses(found.trajectory, truth))
    assert error.position_m.rmse < 0.02
    assert error.position_m.rmse < 0.7 * position_rmse_m(before, truth)
    assert np.degrees(error.rotation_rad.rmse) < 0.5
    assert found.rounds[-1].mean_m < found.rounds[0].mean_m
    assert len(found.support.match_ratio) == len(frames)
    assert np.median(found.support.match_ratio) > 0.5
    assert np.quantile(found.support.weak_sd_m, 0.9) < 0.05


def test_points_of_the_carrier_are_left_out(frames):
    near = line_points(frames, 3, every=1, min_range_m=0.0)
    far = line_points(frames, 3, every=1, min_range_m=4.0)

    sensor = frames.rig.sensors[1].T_body_sensor
    distance = np.linalg.norm(sensor.inverse() @ far.p_body, axis=1)
    assert distance.min() >= 4.0
    assert 0 < len(far) < len(near)


def test_a_recording_without_a_2d_laser_is_said_to_drift(frames, settings, tmp_path):
    sensors = tuple(
        replace(sensor, enabled=sensor.kind != "laser2d") for sensor in frames.rig.sensors
    )
    blind = replace(frames, rig=replace(frames.rig, sensors=sensors))

    figures = run_line_odometry(blind, tmp_path, settings=settings, progress=Silent())

    assert any("no 2-D laser" in text for text in line_texts(figures))


def test_a_recording_without_an_imu_is_said_to_lack_steps(frames, settings, tmp_path, truth):
    silent = replace(frames, imu=None)

    figures = run_line_odometry(silent, tmp_path, settings=settings, progress=Silent())

    steps = load_arrays(tmp_path / "steps.npz", ["lost"])
    assert not figures.imu
    assert any("no IMU" in text for text in line_texts(figures))
    assert len(steps["lost"]) == len(frames)
    found = load_trajectory(tmp_path / "trajectory.npz")
    assert position_rmse_m(found, truth) < 0.25


@pytest.mark.study
def test_a_2d_laser_silent_for_seconds_is_bridged_and_said(frames, settings, tmp_path, truth):
    folder = tmp_path / "frames"
    shutil.copytree(frames.folder, folder)
    scans = load_laser_scans(frames.folder)
    t_s = (scans.t_ns - scans.t_ns[0]) * 1e-9
    heard = scans[(t_s < 8.0) | (t_s > 13.0)]
    for name in ("laser2d.npz", "laser2d_range_m.npy"):
        (folder / name).unlink()
    writer = LineStoreWriter(folder)
    writer.append_scans(heard)
    writer.close()
    out = tmp_path / "odometry"
    out.mkdir()

    figures = run_line_odometry(FrameStore.open(folder), out, settings=settings, progress=Silent())

    assert figures.lost in range(5, 21)  # of 50: the IMU bridges 2 s from either side
    assert any("2-D tracking is missing" in text for text in line_texts(figures))
    assert position_rmse_m(load_trajectory(out / "trajectory.npz"), truth) < 0.25
