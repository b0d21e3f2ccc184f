"""Real scans without an IMU: registered in pairs, tracked, and lost in another place."""

import dataclasses

import numpy as np
import pytest

from recon4.cli.main import main
from recon4.geometry.se3 import SE3
from recon4.progress import Silent
from recon4.recording.formats.poses import read_tum
from recon4.recording.ingest import ingest
from recon4.recording.sources import Sources
from recon4.registration.odometry import Odometry
from recon4.registration.result import StopReason
from recon4.registration.scan_registration import make_scan, register_scans, search_scans
from recon4.registration.tuning import ScanTuning
from recon4.settings import Settings
from recon4.store.frames import FrameStore
from tests.benchmarks.loaders import muehlburg, nclt, nclt_truth, one_sensor
from tests.benchmarks.real_sequences import corridor

SCANS = ScanTuning()
AT_REST = "packets/veloview/vlp-16-test-90deg-1-50-frames.pcap"
"""A VLP-16 that is stationary for 1.5 s (multiframes 1 to 28) and then moved."""
FAR_AND_TURNED = 318
"""Key scan of nclt-hdl32 after which the vehicle is 8.2 m away and turned by 154°."""


@pytest.fixture(scope="module")
def key_scans(data):
    folder = data("sequences/nclt-hdl32")
    return [f.xyz.astype(np.float64) for f in nclt(folder)], nclt_truth(folder).T_a_b


@pytest.fixture(scope="module")
def corridor_frames(data):
    return corridor(data("sequences/vlp16-corridor"))


def register(scans, i, j, initial=None):
    target, source = make_scan(scans[i], SCANS), make_scan(scans[j], SCANS)
    return search_scans(target, source, initial=initial or SE3.identity(), settings=SCANS)


def off(T, T_true):
    error = T_true.inverse() @ T
    return float(np.linalg.norm(error.t)), float(np.rad2deg(error.angle()))


def track(frames, rig):
    odometry = Odometry(rig, Settings())
    return [odometry.push(frame) for frame in frames]


def length_m(steps):
    t_m = np.stack([step.T_odom_body.t for step in steps])
    return float(np.linalg.norm(np.diff(t_m, axis=0), axis=1).sum())


@pytest.mark.study
def test_sparse_key_scans_are_registered_within_centimeters(key_scans):
    scans, truth = key_scans
    errors = []
    for k in range(0, 449, 15):
        found = register(scans, k, k + 1)
        errors.append(off(found.T_target_source, truth[k].inverse() @ truth[k + 1]))
    far_m, turned_deg = np.array(errors).T

    assert np.median(far_m) < 0.045
    assert np.median(turned_deg) < 0.27
    assert far_m.max() < 0.5


def test_a_jump_of_eight_meters_and_half_a_turn_is_found(key_scans):
    scans, truth = key_scans
    T_true = truth[FAR_AND_TURNED].inverse() @ truth[FAR_AND_TURNED + 1]
    target, source = (make_scan(scans[FAR_AND_TURNED + k], SCANS) for k in (0, 1))

    found = search_scans(target, source, initial=SE3.identity(), settings=SCANS)
    alone = register_scans(target, source, initial=SE3.identity(), settings=SCANS)

    assert off(found.T_target_source, T_true)[0] < 0.3
    assert off(alone.T_target_source, T_true)[0] > 1.0
    assert not alone.converged


@pytest.mark.study
def test_scans_of_different_places_do_not_converge(key_scans):
    scans, _ = key_scans

    found = [register(scans, k, k + 100) for k in range(0, 330, 55)]

    assert [f.stop for f in found] == [StopReason.TOO_FEW] * len(found)


def test_a_corridor_keeps_its_length(corridor_frames):
    steps = track(corridor_frames, one_sensor("VLP-16"))

    assert not any(step.lost for step in steps)
    assert 12.3 < length_m(steps) < 13.1


@pytest.mark.study
def test_a_car_that_starts_to_drive_is_followed(data):
    folder = data("sequences/hdl64-muehlburg")

    steps = track(muehlburg(folder, slice(165, 210)), one_sensor("HDL-64E"))

    assert not any(step.lost for step in steps)
    assert 4.0 < np.linalg.norm(steps[-1].T_odom_body.t - steps[0].T_odom_body.t) < 12.0


def test_a_scanner_at_rest_does_not_drift(data, tmp_path):
    pcap = data(AT_REST)
    ingest(Sources((pcap,)), tmp_path, settings=Settings().ingest, progress=Silent())
    frames = FrameStore.open(tmp_path)
    resting = [frames[k] for k in range(1, 29)]

    steps = track(resting, frames.rig)

    T = SE3.stack(step.T_odom_body for step in steps)
    off = T[0].inverse() @ T
    assert np.linalg.norm(off.t, axis=1).max() < 0.005
    assert np.rad2deg(off.angle()).max() < 0.05


@pytest.mark.study
def test_the_finished_trajectory_of_a_scanner_at_rest_does_not_drift(data, tmp_path):
    pcap, few = data(AT_REST), ["--set", "map.voxel_m=0.1"]

    assert main(["process", str(pcap), "--out", str(tmp_path / "rest"), *few]) == 0

    T = read_tum(tmp_path / "rest" / "trajectory.tum")
    resting = T[slice(*np.searchsorted(T.t_ns, T.t_ns[0] + np.array([0, 1_500_000_000])))].T_a_b
    off = resting[0].inverse() @ resting
    assert len(resting.t) > 20
    assert np.linalg.norm(off.t, axis=1).max() < 0.01
    assert np.rad2deg(off.angle()).max() < 0.05


def test_frames_of_another_place_are_lost_and_tracking_continues_after_them(corridor_frames, data):
    good = corridor_frames[:14]
    strange = list(muehlburg(data("sequences/hdl64-muehlburg"), slice(3)))
    rows = [k for k in range(5, 8)]
    mixed = list(good)
    for row, other in zip(rows, strange, strict=True):
        place = good[row]
        every = slice(None, None, 3)
        mixed[row] = dataclasses.replace(
            place,
            xyz=np.ascontiguousarray(other.xyz[every]),
            ring=np.ascontiguousarray(other.ring[every] // 4),
            **{
                name: np.ascontiguousarray(getattr(other, name)[every])
                for name in ("intensity", "sensor", "echo")
            },
            dt_ns=np.full(len(other.xyz[every]), place.duration_ns // 2, np.int32),
        )

    steps = track(mixed, one_sensor("VLP-16"))
    whole = track(good, one_sensor("VLP-16"))

    assert [k for k, step in enumerate(steps) if step.lost] == rows
    apart_m, _ = off(steps[-1].T_odom_body, whole[-1].T_odom_body)
    assert apart_m < 0.3
