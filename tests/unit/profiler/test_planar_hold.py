"""The first trajectory holds what no surface holds, and the sides of a wall are kept apart."""

import numpy as np
import pytest

from recon4.evaluation.ate import absolute_error, pair_poses
from recon4.geometry.se3 import SE3
from recon4.model.trajectory import Trajectory
from recon4.pose_graph.files import load_graph
from recon4.profiler.imu_chain import initial_chain, linearize, make_drive
from recon4.profiler.line_refine import refine_lines
from recon4.profiler.planar_hold import PlanarHold, observed_motion
from recon4.profiler.stage_odometry import run_line_odometry, span_of
from recon4.profiler.sweep_graph import build_sweep_graph
from recon4.progress import Silent
from recon4.recording.formats.poses import read_tum
from recon4.recording.ingest import ingest
from recon4.recording.sources import Sources
from recon4.settings import IngestSettings
from recon4.simulation.backpack import BackpackModels, prepare_backpack, simulate_backpack
from recon4.simulation.profiler import Laser2dModel, ProfilerModel
from recon4.store.frames import FrameStore


@pytest.fixture(scope="module")
def chain(frames, settings, truth):
    """States that follow the truth, but drift by a meter."""
    drive = make_drive(
        frames.imu, frames.rig, span_of(frames), knot_s=0.1, settings=settings.odometry
    )
    drift = np.linspace(0.0, 1.0, len(truth))[:, None] * [1.0, 0.0, 0.0]
    drifted = Trajectory(truth.t_ns, SE3(truth.T_a_b.R, truth.T_a_b.t + drift))
    return initial_chain(drive).following(drifted)


def held(chain, truth, known):
    """Length of the chain in x against the truth, after a step with the hold alone [m]."""
    hold = PlanarHold.of(truth, chain.drive.knot_ns, np.full(len(chain) - 1, known))
    for _ in range(4):
        chain = chain.moved(linearize(chain).solve(hold.information(chain)))
    x = chain.vector[:, 0]
    at = truth.at(chain.drive.knot_ns, slack_ns=200_000_000).t[:, 0]
    return float((x[-1] - x[0]) - (at[-1] - at[0]))


def test_known_motion_holds_the_chain_and_unknown_motion_does_not(chain, truth):
    assert abs(held(chain, truth, True)) < 0.1
    assert abs(held(chain, truth, False)) > 0.3


def test_motion_is_known_where_the_2d_laser_observes_it():
    t_mid_ns = np.arange(5) * 100
    knot_ns = np.arange(-50, 500, 50)

    known = observed_motion(
        t_mid_ns,
        knot_ns,
        weak_sd_m=np.array([0.01, 0.2, 0.01, 0.01, np.nan]),
        lost=np.array([False, False, True, False, False]),
    )

    assert known.tolist() == [True, True, False, False, False, False, True, True, False, False]


@pytest.mark.study
def test_the_other_side_of_a_wall_is_another_wall(settings, tmp_path):
    models = BackpackModels(
        profiler=ProfilerModel(lines_hz=60.0, shots=240),
        laser2d=Laser2dModel(scans_hz=20.0, beams=541, angle_step_rad=0.00872665),
    )
    setup = prepare_backpack("office", seed=2, seconds=26.0, models=models)
    simulate_backpack(setup, tmp_path / "walk", progress=Silent())
    for folder in ("frames", "odometry", "graph"):
        (tmp_path / folder).mkdir()
    sources = Sources((tmp_path / "walk" / "rosbag2",), None)
    ingest(sources, tmp_path / "frames", settings=IngestSettings(), progress=Silent())
    frames = FrameStore.open(tmp_path / "frames")
    run_line_odometry(frames, tmp_path / "odometry", settings=settings, progress=Silent())
    build_sweep_graph(
        frames, tmp_path / "odometry", tmp_path / "graph", settings=settings, progress=Silent()
    )

    found = refine_lines(
        frames,
        tmp_path / "odometry",
        load_graph(tmp_path / "graph").nodes,
        settings=settings,
        progress=Silent(),
    )

    error = absolute_error(pair_poses(found.trajectory, read_tum(tmp_path / "walk" / "truth.tum")))
    assert error.position_m.rmse < 0.01  # 5 cm with gates as wide as the wall
