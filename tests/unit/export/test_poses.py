"""``recon4 export`` writes the trajectory as KITTI poses, one per multiframe."""

import numpy as np
import pytest

from recon4.cli.main import main
from recon4.errors import StoreError
from recon4.recording.formats.poses import read_kitti
from recon4.results import export_poses
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

    poses = read_kitti(tmp_path / "poses.txt", t_ns)
    true = loop_walk().at(t_ns)
    assert f"{len(t_ns)} poses" in capsys.readouterr().out
    np.testing.assert_allclose(poses.T_a_b.t, true.t, atol=1e-9)
    np.testing.assert_allclose(poses.T_a_b.R, true.R, atol=1e-9)


def test_a_crs_is_refused_for_poses(project, tmp_path, capsys):
    assert main(["export", str(project), str(tmp_path / "p.txt"), "--crs", "EPSG:5514"]) == 2
    assert "--crs is for maps" in capsys.readouterr().err
    assert not (tmp_path / "p.txt").exists()


def test_a_project_without_a_trajectory_is_refused(tmp_path):
    build_project(tmp_path / "room", with_map=False)

    with pytest.raises(StoreError, match="no finished trajectory yet"):
        export_poses(tmp_path / "room", tmp_path / "p.txt")
