"""Places of a walk: drawn once, and laid onto each other once, for all searches."""

from dataclasses import replace

import numpy as np

from recon4.geometry.se3 import SE3
from recon4.pose_graph import stored_images
from recon4.pose_graph.density_images import TurnedImage, overlays, yaws_within
from recon4.pose_graph.places import PlaceDrawer
from recon4.pose_graph.stored_images import ChosenImages, StoredImages
from recon4.pose_graph.tuning import RecognitionTuning
from tests.unit.pose_graph.walls import TWO_CUBES, image, straight, turned, walls_of

SETTINGS = RecognitionTuning()


class SeenWalls:
    """Walls around each node of `straight`; counts how often a node is looked at."""

    def __init__(self, scratch):
        self.scratch, self.looked = scratch, []
        x, y = walls_of(TWO_CUBES * 5.0, 4000).T
        self._walls_m = np.stack([x, y, np.zeros(len(x))], axis=1)

    def ends(self, node):
        self.looked.append(node)
        p_m = self._walls_m - [float(node), 0.0, 0.0]
        near = p_m[np.linalg.norm(p_m, axis=1) < 10.0]
        return np.stack([near, near + np.array([0.0, 0.0, 0.05])], axis=1)


def moved_from(graph, node, shift_m):
    """The graph with all nodes from one on moved along y."""
    t = graph.T_map_body.t.copy()
    t[node:, 1] += shift_m
    return graph.with_poses(SE3(graph.T_map_body.R, t))


def test_a_place_is_drawn_again_only_where_its_walls_have_moved(tmp_path):
    views, walk, settings = SeenWalls(tmp_path), straight(41), replace(SETTINGS, reach_m=7.5)
    drawer = PlaceDrawer(views, settings, leveled=True)
    first = drawer.draw(walk)
    assert set(views.looked) == set(range(41))
    views.looked.clear()

    same = drawer.draw(moved_from(walk, 20, 0.04))
    assert views.looked == []
    np.testing.assert_array_equal(same.descriptors, first.descriptors)

    bent = moved_from(walk, 20, 0.3)
    again, fresh = drawer.draw(bent), PlaceDrawer(views, settings, leveled=True).draw(bent)
    assert again.node.tolist() == first.node.tolist()
    for k, node in enumerate(first.node):
        is_astride = 20 - settings.reach_m <= node < 20 + settings.reach_m
        expected = (fresh if is_astride else first).images[k]
        np.testing.assert_array_equal(again.images[k].walls_m, expected.walls_m)
        np.testing.assert_array_equal(again.descriptors[k], expected.descriptor)


def test_an_image_is_laid_onto_another_once_for_all_searches(tmp_path, monkeypatch):
    stored, calls = StoredImages(tmp_path), []

    def counted(*given, **named):
        calls.append(named["yaws"])
        return overlays(*given, **named)

    monkeypatch.setattr(stored_images, "overlays", counted)
    for yaw in (0.0, 0.4, 1.0):
        stored.append(image(turned(walls_of(TWO_CUBES), yaw, np.zeros(2))))
    narrow, wide = yaws_within(0.5), yaws_within(1.2)

    first = ChosenImages(stored, [0, 2]).laid_from(1, most=2)
    found = [first.onto(0, narrow), first.onto(0, wide), first.onto(0, narrow)]
    assert [len(yaws) for yaws in calls] == [len(narrow), len(wide)]
    assert found[0] == found[2] != found[1]

    again = ChosenImages(stored, [0, 1, 2])
    assert again.laid_from(2, most=2).onto(0, wide) == found[1]
    assert len(calls) == 2
    other = again.laid_from(1, most=2).onto(0, wide)
    assert len(calls) == 3
    assert other == overlays(stored[0], TurnedImage(stored[1]), yaws=wide, most=2)


def test_a_place_is_drawn_again_where_it_has_turned_or_its_walls_were_left_out(tmp_path):
    views, walk = SeenWalls(tmp_path), straight(41)
    drawer = PlaceDrawer(views, SETTINGS, leveled=True)
    known = np.arange(41) < 20
    assert not len(drawer.draw(walk, turned=known).images[-1].walls_m)
    views.looked.clear()

    assert len(drawer.draw(walk).images[-1].walls_m)
    assert min(views.looked) >= 20 - SETTINGS.reach_m
    views.looked.clear()

    drawer.draw(walk.with_poses(SE3.from_rpy(0.0, 0.0, 0.002, t=[9.0, 1.0, 0.0]) @ walk.T_map_body))
    assert views.looked == []
    drawer.draw(walk.with_poses(SE3.from_rpy(0.0, 0.0, 0.01, t=[9.0, 1.0, 0.0]) @ walk.T_map_body))
    assert set(views.looked) == set(range(41))
