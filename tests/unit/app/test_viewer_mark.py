"""The marked stretch of the walk."""

import numpy as np
import pytest

from recon4.geometry.se3 import SE3
from recon4.model.trajectory import Trajectory
from recon4.store.frames import FrameStore
from recon4.store.project import read_artifacts
from recon4_app.viewer.client.view import Stretch, ViewState
from recon4_app.viewer.cloud.multiframes import Multiframes
from recon4_app.viewer.scene.build import Content
from recon4_app.viewer.scene.mark import stretch_marks, stretch_nodes, stretch_positions
from recon4_app.viewer.scene.nodes import LabelNode, LinesNode
from tests.project_builder import add_multiframes, build_project, loop_walk

WALK = loop_walk()
"""600 poses at 10 Hz."""


def marking(stretch):
    return ViewState(stretch=stretch)


@pytest.fixture(scope="module")
def multiframes(tmp_path_factory):
    root = tmp_path_factory.mktemp("project") / "office"
    build_project(root, points=100)
    add_multiframes(root)
    return Multiframes(FrameStore.open(read_artifacts(root)["frames"]))


def test_a_stretch_follows_the_newest_trajectory_and_not_the_stated_places():
    up_m = np.array([0.0, 0.0, 5.0])
    corrected = Trajectory(WALK.t_ns, SE3(WALK.T_a_b.R, WALK.T_a_b.t + up_m))
    stretch = Stretch(span_s=(20.0, 30.0), places=((0.0, 0.0, 0.0),))

    p_map = stretch_positions(Content(trajectory=corrected), stretch)

    np.testing.assert_allclose(p_map, corrected.T_a_b.t[200:301], atol=1e-9)


def test_the_ends_of_a_stretch_lie_between_two_poses():
    p_map = stretch_positions(Content(trajectory=WALK), Stretch(span_s=(20.05, 20.15)))

    assert len(p_map) == 3
    np.testing.assert_allclose(p_map[0], WALK.T_a_b.t[200:202].mean(axis=0), atol=1e-3)


def test_a_moment_is_one_place_with_its_time():
    nodes = list(stretch_nodes(Content(trajectory=WALK), marking(Stretch(span_s=(7.0, 7.0)))))

    label = next(node for node in nodes if isinstance(node, LabelNode))
    assert label.text == "7.0 s"
    np.testing.assert_allclose(label.position_m, WALK.T_a_b.t[70], atol=1e-9)


def test_places_without_a_time_are_marked_where_they_are():
    stretch = Stretch(places=((1.0, 2.0, 3.0), (4.0, 2.0, 3.0)))

    lines = next(n for n in stretch_nodes(Content(), marking(stretch)) if isinstance(n, LinesNode))

    ends = lines.segments.mean(axis=1) + lines.position_m
    assert {tuple(p) for p in ends.round(3).tolist()} == set(stretch.places)


@pytest.mark.parametrize("span_s", [(-5.0, 1e12), (59.0, 1e12)])
def test_a_stretch_that_ends_after_the_walk_ends_with_it(span_s):
    p_map = stretch_positions(Content(trajectory=WALK), Stretch(span_s=span_s))

    np.testing.assert_allclose(p_map[-1], WALK.T_a_b.t[-1])


def test_a_stretch_that_the_walk_does_not_have_is_not_marked():
    content = Content(trajectory=WALK)

    assert not len(stretch_positions(content, Stretch(span_s=(60.5, 61.0))))
    assert list(stretch_nodes(content, marking(Stretch(span_s=(60.5, 61.0))))) == []
    assert list(stretch_nodes(content, marking(None))) == []


@pytest.mark.parametrize(
    ("span_s", "expected"),
    [
        ((20.0, 30.0), ((200, "20.0 s to 30.0 s"), (300, ""))),
        ((7.0, 7.0), ((70, "7.0 s"),)),
        ((-5.0, 1e12), ((0, "-5.0 s to 1000000000000.0 s"), (598, ""))),
        ((60.5, 61.0), ()),
        (None, ()),
    ],
)
def test_the_slider_of_the_multiframes_marks_the_ends_of_the_stretch(multiframes, span_s, expected):
    content = Content(trajectory=WALK, multiframes=multiframes)
    stretch = Stretch(span_s=span_s, places=((0.0, 0.0, 0.0),))

    assert stretch_marks(content, marking(stretch)) == expected
    assert stretch_marks(content, marking(None)) == ()
    assert stretch_marks(Content(), marking(stretch)) == ()
