"""Loaders of the real sequences and the peers, on a few frames of each."""

from collections.abc import Callable
from dataclasses import replace
from itertools import islice
from pathlib import Path

import numpy as np
import pytest

from recon4.model.samples import ImuSamples
from tests.benchmarks import loaders, peers


def test_nclt_scans_fit_their_true_poses(data: Callable[[str], Path]) -> None:
    from scipy.spatial import cKDTree

    folder = data("sequences/nclt-hdl32")
    first, second = islice(loaders.nclt(folder), 2)
    truth = loaders.nclt_truth(folder)

    T_world = truth.at(np.array([first.t_mid_ns, second.t_mid_ns]))
    placed = T_world[1] @ second.xyz
    near = cKDTree(T_world[0] @ first.xyz).query(placed)[0]
    raw = cKDTree(first.xyz).query(second.xyz)[0]

    assert len(truth) == 450
    assert np.median(near) < 0.3  # the scans are thinned to voxels of some decimeters
    assert np.median(near) < 0.9 * np.median(raw)


def test_a_range_image_becomes_a_level_street(data: Callable[[str], Path]) -> None:
    frame = next(loaders.muehlburg(data("sequences/hdl64-muehlburg")))

    assert 0.09e9 < frame.duration_ns < 0.12e9
    assert np.all(np.diff(frame.dt_ns) >= 0)
    lowest = frame.xyz[frame.ring < 16]
    heights = np.percentile(lowest[:, 2], [10, 25, 40])
    assert heights == pytest.approx(-1.9, abs=0.25)  # the road, as seen from the roof


def test_the_other_street_has_an_ins_row_a_scan(data: Callable[[str], Path]) -> None:
    folder = data("sequences/hdl64-durlacher")
    t_ns, rows = loaders.durlacher_ins(folder)

    frames = list(islice(loaders.durlacher(folder), 2))

    assert len(t_ns) >= len(list(folder.glob("scan*.png")))
    assert rows[0, 0] == pytest.approx(49.008875)
    assert frames[1].t_ns == pytest.approx(frames[0].t_ns + frames[0].duration_ns, abs=5e6)


def test_frames_survive_the_store(data: Callable[[str], Path], tmp_path: Path) -> None:
    frames = list(islice(loaders.nclt(data("sequences/nclt-hdl32")), 3))

    store = loaders.store(frames, loaders.one_sensor("HDL-32E"), tmp_path / "frames")

    assert len(store) == 3
    np.testing.assert_allclose(store[2].xyz, frames[2].xyz, rtol=0, atol=2.0**-12 + 1e-5)


def test_the_gyroscope_alone_turns_the_body_without_its_bias() -> None:
    t_s = np.arange(0.0, 5.0, 0.005)
    rate = np.where(t_s > 2.0, np.deg2rad(30.0), 0.0)
    gyro = np.stack([0 * t_s, 0 * t_s, rate], axis=1) + np.array([0.01, -0.02, 0.03])
    imu = ImuSamples((t_s * 1e9).astype(np.int64), gyro, np.zeros((len(t_s), 3)))

    turned = peers.gyro_rotation(imu, loaders.one_sensor("VLP-16"))

    assert np.rad2deg(turned.T_a_b[-1].rpy()) == pytest.approx([0, 0, 89.85], abs=0.2)


@pytest.mark.parametrize("peer", ["kiss", "vgicp"])
def test_a_peer_follows_a_real_scan_moved_by_known_steps(
    data: Callable[[str], Path], peer: str
) -> None:
    scan = next(loaders.nclt(data("sequences/nclt-hdl32")))
    steps_m = [0.0, 0.1, 0.2, 0.3]
    frames = [
        replace(scan, frame_id=k, t_ns=k * loaders.FRAME_NS, xyz=scan.xyz - np.float32([x, 0, 0]))
        for k, x in enumerate(steps_m)
    ]
    register = peers.kiss_icp(deskew=False, voxel_m=1.0) if peer == "kiss" else peers.vgicp()

    found = peers.run(peer, register, frames, loaders.one_sensor("HDL-32E"))

    expected = np.stack([steps_m, [0.0] * 4, [0.0] * 4], axis=1)
    assert found.trajectory.T_a_b.t == pytest.approx(expected, abs=0.1)
    assert len(found.register_s) == 4
