"""The walk in few points, while there is no map."""

import numpy as np
import pytest

from recon4.geometry.se3 import SE3
from recon4.model.trajectory import Trajectory
from recon4.store.frames import FrameStore
from recon4.store.project import read_artifacts
from recon4_app.viewer.cloud.multiframes import Multiframes
from recon4_app.viewer.cloud.palette import paint
from recon4_app.viewer.cloud.preview import HEIGHTS, JobPreview
from recon4_app.viewer.scene.source import ProjectSource
from recon4_app.viewer.tuning import CLOUD_PREVIEW
from tests.project_builder import ROOM_M, add_multiframes, build_project, loop_walk


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    root = tmp_path_factory.mktemp("projects") / "office"
    build_project(root, with_map=False)
    add_multiframes(root)
    return root


@pytest.fixture
def preview(project):
    return JobPreview(Multiframes(FrameStore.open(read_artifacts(project)["frames"])))


def nodes(preview, line, palette="viridis"):
    return preview.nodes(line, palette=palette, size_m=0.02)


def until(seconds):
    return loop_walk()[: 10 * seconds + 3]


def test_a_multiframe_a_second_lies_where_it_was_seen(preview):
    drawn = nodes(preview, until(25))

    p_map = np.concatenate([node.position_m + node.p_node for node in drawn])
    assert 0.75 < len(p_map) / (26 * 400) < 0.9  # walls higher than that hide the walk
    assert (p_map > -0.01).all() and (
        p_map < np.array([*ROOM_M[:2], 1.2 + HEIGHTS.high]) + 0.01
    ).all()
    on_floor = np.abs(p_map[:, 2]) < 0.01
    assert 0.3 < on_floor.mean() < 0.6
    floor = np.concatenate([node.rgb for node in drawn])[on_floor]
    assert (floor == paint(np.array([-1.2]), HEIGHTS, "viridis")).all(axis=1).mean() > 0.9


def test_a_walk_that_grows_places_its_last_seconds_only(preview):
    before = nodes(preview, until(25))
    after = nodes(preview, until(28))

    assert [node.path for node in before] == [node.path for node in after]
    kept = [a.p_node is b.p_node and a.rgb is b.rgb for a, b in zip(before, after, strict=True)]
    assert kept == [True, True, False]
    added = len(after[-1].p_node) - len(before[-1].p_node)
    assert 0.7 < added / (3 * 400) < 0.95
    assert len(before[-1].p_node) > (26 - 2 * CLOUD_PREVIEW.piece) * 250


def test_where_the_poses_move_the_points_move_too(preview):
    walk = until(25)
    moved = walk.T_a_b.t + np.where(np.arange(len(walk)) > 120, 0.5, 0.0)[:, None]

    before = nodes(preview, walk)
    after = nodes(preview, Trajectory(walk.t_ns, SE3(walk.T_a_b.R, moved)))

    assert after[0].p_node is before[0].p_node
    np.testing.assert_allclose(after[2].position_m - before[2].position_m, 0.5)


def test_another_palette_sends_colors_only(preview):
    viridis, turbo = (nodes(preview, until(5), palette)[0] for palette in ("viridis", "turbo"))

    assert viridis.p_node is turbo.p_node
    assert (viridis.rgb != turbo.rgb).any()


def test_of_a_long_walk_each_multiframe_shows_less(preview):
    preview._of_one = 20

    (node,) = nodes(preview, until(5))

    assert 60 < len(node.p_node) <= 6 * 20


def test_a_project_has_a_preview_until_it_has_a_map(project, tmp_path):
    content = ProjectSource(project, tmp_path).content

    assert content.cloud is None
    assert len(content.preview.nodes(content.trajectory, palette="gray", size_m=0.02)) == 6
    build_project(project, points=100)
    assert ProjectSource(project, tmp_path).content.preview is None
