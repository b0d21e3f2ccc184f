"""The mount and clock of a profiler are found by the sharpness of the map."""

from dataclasses import replace

import numpy as np
import pytest

from recon4.calibration.line_entropy import (
    calibrate_profiler,
    occupied,
    profiler_parameters,
    profiler_walk,
)
from recon4.errors import ConfigError
from recon4.geometry.se3 import SE3
from recon4.model.rig import load_rig
from recon4.progress import Silent
from recon4.recording.formats.poses import read_tum
from recon4.recording.ingest import ingest
from recon4.recording.sources import Sources
from recon4.settings import IngestSettings
from recon4.simulation.backpack import BackpackModels, prepare_backpack, simulate_backpack
from recon4.simulation.profiler import Laser2dModel, ProfilerModel
from recon4.store.frames import FrameStore
from recon4.workflows.calibration_methods import CalibrationChoice, calibrate_by


@pytest.fixture(scope="module")
def walk(tmp_path_factory):
    folder = tmp_path_factory.mktemp("backpack")
    models = BackpackModels(
        profiler=ProfilerModel(lines_hz=60.0, shots=150), laser2d=Laser2dModel(scans_hz=2.0)
    )
    setup = prepare_backpack("hall", seed=5, figure="eight", seconds=36.0, models=models)
    simulate_backpack(setup, folder / "walk", progress=Silent())
    sources = Sources((folder / "walk" / "rosbag2",), None)
    ingest(sources, folder / "frames", settings=IngestSettings(), progress=Silent())
    return profiler_walk(
        FrameStore.open(folder / "frames"), read_tum(folder / "walk" / "truth.tum")
    )


def mounted_wrong(walk, *, turn_deg, shift_m, ahead_s):
    rig = walk.recorded
    sensors, row = list(rig.sensors), rig.row_of("profiler")
    T = sensors[row].T_body_sensor
    turn = SE3.exp(np.concatenate([np.deg2rad(turn_deg), np.zeros(3)]))
    sensors[row] = replace(sensors[row], T_body_sensor=SE3(turn.R @ T.R, T.t + np.asarray(shift_m)))
    t_ns = walk.t_ns + round(1e9 * ahead_s)
    return replace(walk, t_ns=t_ns, recorded=replace(rig, sensors=tuple(sensors)))


@pytest.mark.study
def test_the_map_is_sharpest_with_the_true_mount(walk):
    rig = walk.recorded
    wrong = mounted_wrong(walk, turn_deg=(0.0, 0.5, 0.0), shift_m=(0.0, 0.0, 0.0), ahead_s=0.0)

    assert occupied(walk, rig, cube_m=0.05) < occupied(walk, wrong.recorded, cube_m=0.05)


@pytest.mark.study
def test_rotation_and_clock_are_found(walk):
    few = replace(walk, t_ns=walk.t_ns[::6], p_sensor=np.ascontiguousarray(walk.p_sensor[::6]))
    wrong = mounted_wrong(few, turn_deg=(0.8, -0.7, 1.0), shift_m=(0.0, 0.0, 0.0), ahead_s=0.03)
    parameters = profiler_parameters(wrong.recorded)
    known = np.array([parameter.quantity == "position" for parameter in parameters.listed])

    found = calibrate_profiler(wrong, parameters.fixing(known))

    assert np.rad2deg(found.change[:3]) == pytest.approx([-0.8, 0.7, -1.0], abs=0.2)
    assert found.change[3:6].tolist() == [0.0, 0.0, 0.0]
    assert found.change[6] == pytest.approx(-0.03, abs=0.005)


@pytest.mark.parametrize("method", ["joint", "maps"])
def test_methods_that_compare_lidars_refuse_a_profiler(tmp_path, method):
    sources = Sources((tmp_path / "bag",), load_rig("wuerzburg"))

    with pytest.raises(ConfigError, match="with a profiler; use entropy or pairs"):
        calibrate_by(CalibrationChoice(method), sources, tmp_path / "out", progress=Silent())
