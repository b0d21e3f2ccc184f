"""Rigs of builders: a 2-D scanner that tilts, a single beam whose head spins, other rates."""

from dataclasses import dataclass

import numpy as np
import pytest

from recon4.evaluation.ate import absolute_error, pair_poses
from recon4.model.rig import parse_rig
from recon4.pose_graph.files import load_graph
from recon4.profiler.line_refine import refine_lines
from recon4.profiler.stage_odometry import run_line_odometry
from recon4.profiler.sweep_graph import build_sweep_graph
from recon4.progress import Silent
from recon4.recording.formats.poses import read_tum
from recon4.recording.ingest import ingest
from recon4.recording.sources import Sources
from recon4.settings import IngestSettings
from recon4.simulation.backpack import BackpackModels, prepare_backpack, simulate_backpack
from recon4.simulation.profiler import HeadModel, Laser2dModel, ProfilerModel
from recon4.store.frames import FrameStore
from recon4.store.line_store import load_lines
from recon4.workflows.choice import is_planar
from tests.said import line_texts

RIG = """\
name = "{name}"
[[sensor]]
name = "base"
kind = "laser2d"
topic = "/base/scan"
xyz_m = [0.1, 0.0, 0.3]
rpy_deg = [0.0, 0.0, 0.0]
[[sensor]]
name = "head"
kind = "profiler"
topic = "/head/scan"
head_topic = "/head/angle"
xyz_m = [-0.15, 0.0, 0.2]
rpy_deg = {rpy_deg}
[imu]
xyz_m = [0.0, 0.0, 0.0]
"""
SECONDS = 20.0


@dataclass(frozen=True, slots=True, kw_only=True)
class SpinningHead(HeadModel):
    """A head that spins in one direction."""

    def angle_rad(self, t_s):
        """One revolution in 6 s, reported without wrapping."""
        return np.pi / 3.0 * np.asarray(t_s)


TILTING = BackpackModels(
    profiler=ProfilerModel(
        lines_hz=40.0, shots=180, lowest_rad=-2.36, highest_rad=2.36, active=0.75,
        head=HeadModel(sweep_rad=1.57, sweep_s=2.0, reversal_s=0.2),
    ),
    laser2d=Laser2dModel(scans_hz=20.0, beams=271, angle_step_rad=0.0174533),
)  # fmt: skip
SPINNING = BackpackModels(
    profiler=ProfilerModel(
        lines_hz=30.0, shots=240, lowest_rad=-1.4, highest_rad=1.4, active=0.5, head=SpinningHead()
    ),
    laser2d=Laser2dModel(
        scans_hz=10.0, beams=181, angle_min_rad=-np.pi / 2.0, angle_step_rad=0.0174533
    ),
)


def walked(name, folder):
    """A recording of one of the rigs, with its rig file."""
    rpy_deg = "[-90.0, 0.0, 0.0]" if name == "tilting" else "[0.0, 0.0, 180.0]"
    rig = parse_rig(RIG.format(name=name, rpy_deg=rpy_deg), where="rig.toml")
    models = TILTING if name == "tilting" else SPINNING
    setup = prepare_backpack(
        "hall", seed=5, figure="circle", seconds=SECONDS, rig=rig, models=models
    )
    simulate_backpack(setup, folder, progress=Silent())
    return Sources((folder / "rosbag2",), rig)


@pytest.mark.parametrize(("name", "turn_s"), [("tilting", 2.0), ("spinning", 6.0)])
@pytest.mark.study
def test_another_rig_is_mapped_by_its_rig_file(tmp_path, settings, name, turn_s):
    sources = walked(name, tmp_path / "walk")
    for folder in ("frames", "odometry", "graph"):
        (tmp_path / folder).mkdir()
    assert not is_planar(sources)
    ingest(sources, tmp_path / "frames", settings=IngestSettings(), progress=Silent())
    frames = FrameStore.open(tmp_path / "frames")

    figures = run_line_odometry(frames, tmp_path / "odometry", settings=settings, progress=Silent())
    build_sweep_graph(
        frames, tmp_path / "odometry", tmp_path / "graph", settings=settings, progress=Silent()
    )
    refined = refine_lines(
        frames,
        tmp_path / "odometry",
        load_graph(tmp_path / "graph").nodes,
        settings=settings,
        progress=Silent(),
    )

    assert not line_texts(figures)
    assert len(load_lines(frames.folder).sweeps()) - 1 == pytest.approx(SECONDS / turn_s, abs=1.5)
    truth = read_tum(tmp_path / "walk" / "truth.tum")
    error = absolute_error(pair_poses(refined.trajectory, truth))
    assert error.position_m.rmse < 0.02
    assert np.degrees(error.rotation_rad.rmse) < 0.5
