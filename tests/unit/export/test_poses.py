"""``recon4 export`` writes the trajectory as KITTI poses, one per multiframe."""

import numpy as np
import pytest

from recon4.cli.main import main
from recon4.errors import StoreError
from recon4.export.map_files import export_poses
from recon4.mapping.undistort import place
from recon4.pose_graph.files import load_graph
from recon4.recording.formats.three_dtk import read_pose, read_scan
from recon4.store.frames import FrameStore
from recon4.store.project import read_artifacts
from tests.project_builder import add_multiframes, build_project, loop_walk


@pytest.fixture
def project(tmp_path):
    build_project(tmp_path / "room", points=100)
    add_multiframes(tmp_path / "room")
    return tmp_path / "room"


def test_every_multiframe_has_a_pose_in_the_file(project, tmp_path, capsys):
    t_ns = FrameStore.open(read_artifacts(project)["frames"]).t_mid_ns

    assert main(["export", str(project), str(tmp_path / "poses.txt")]) == 0

    poses = np.loadtxt(tmp_path / "poses.txt").reshape(-1, 3, 4)
    true = loop_walk().at(t_ns)
    assert f"{len(t_ns)} poses" in capsys.readouterr().out
    np.testing.assert_allclose(poses[:, :, 3], true.t, atol=1e-9)
    np.testing.assert_allclose(poses[:, :, :3], true.R, atol=1e-9)


def test_a_crs_is_refused_for_poses(project, tmp_path, capsys):
    assert main(["export", str(project), str(tmp_path / "p.txt"), "--crs", "EPSG:5514"]) == 2
    assert "is written as it is" in capsys.readouterr().err
    assert not (tmp_path / "p.txt").exists()


def test_a_project_without_a_trajectory_is_refused(tmp_path):
    build_project(tmp_path / "room", with_map=False)

    with pytest.raises(StoreError, match="no finished trajectory yet"):
        export_poses(tmp_path / "room", tmp_path / "p.txt")


def test_scans_for_3dtk_lie_in_the_map_where_their_poses_put_them(project, tmp_path, capsys):
    folder = tmp_path / "room.3dtk"

    assert main(["export", str(project), str(folder)]) == 0

    artifacts = read_artifacts(project)
    frames, graph = FrameStore.open(artifacts["frames"]), load_graph(artifacts["verification"])
    assert len(list(folder.glob("scan*.3d"))) == len(graph)
    assert " points\n" in capsys.readouterr().out
    for k, frame_id in enumerate(graph.frame_ids[:3]):
        columns = read_scan(folder / f"scan{k:03d}.3d")
        p_scan = np.stack([columns[axis] for axis in "xyz"], axis=1)
        row = int(np.flatnonzero(frames.index["frame_id"] == frame_id)[0])
        expected = place(frames[row], loop_walk(), frames.rig)
        p_map = read_pose(folder / f"scan{k:03d}.pose") @ p_scan
        np.testing.assert_allclose(p_map, expected, atol=2e-4)
    assert main(["export", str(project), str(folder)]) != 0
    assert "exists already" in capsys.readouterr().err
