"""Place recognition: images from above, bounds, and which corrections are accepted."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy import fft

from recon4.geometry.se3 import SE3
from recon4.kernels.overlap import nearest_ranges, seen_through_ratio
from recon4.model.pose_graph import (
    EdgeKind,
    Judge,
    Measure,
    Reason,
    Verdict,
)
from recon4.pose_graph import best_paths
from recon4.pose_graph.bounds import relative_bounds
from recon4.pose_graph.density_images import (
    TurnedImage,
    layers_of,
    overlays,
    yaws_within,
)
from recon4.pose_graph.places import PlaceDrawer, Places
from recon4.pose_graph.recognition import recognize
from recon4.pose_graph.recognized_groups import RecognizedChain, judge_chains
from recon4.pose_graph.stored_images import StoredImages
from recon4.pose_graph.tuning import RecognitionTuning
from recon4.pose_graph.tuning_places import DENSITY, BoundTuning
from recon4.progress import Silent
from tests.unit.pose_graph.walls import TWO_CUBES, edge, image, straight, turned, walls_of

SETTINGS = RecognitionTuning()


# -- images from above


def test_the_best_overlay_is_the_rotation_and_shift_between_two_visits():
    walls = walls_of(TWO_CUBES)
    seen = turned(walls, np.deg2rad(-70.0), np.array([1.0, -2.0]))

    best = overlays(image(walls), TurnedImage(image(seen)), yaws=yaws_within(np.pi), most=1)[0]

    back = turned(seen, best.yaw_rad, np.array(best.shift_m))
    assert np.linalg.norm(back - walls, axis=1).max() < 0.7


def test_a_score_is_that_of_the_correlation_over_all_shifts():
    walls = walls_of(TWO_CUBES)
    target = image(walls)
    source = TurnedImage(image(turned(walls, 0.0, np.array([2.0, -3.2]))))

    best = overlays(target, source, yaws=np.zeros(1), most=1)[0]

    cells = DENSITY.cells
    whole = fft.irfft2(target.spectrum * source.spectrum(0.0), s=(cells, cells))
    across, along = (round(shift / DENSITY.cell_m) for shift in best.shift_m)
    assert (across, along) == (-5, 8)
    assert best.score == whole[across, along] == whole.max()


def test_an_image_without_walls_is_laid_onto_like_any_other(tmp_path):
    walls = walls_of(TWO_CUBES)
    stored = StoredImages(tmp_path)
    stored.append(image(walls))
    stored.append(image(walls).without_walls())
    source = TurnedImage(image(turned(walls, 0.5, np.array([1.0, -2.0]))))

    whole, bare = (overlays(one, source, yaws=yaws_within(0.6), most=2) for one in stored)

    assert len(stored[1].walls_m) == 0
    assert bare == whole


def test_the_descriptor_depends_neither_on_heading_nor_on_position():
    walls = walls_of(TWO_CUBES)
    here = image(walls).descriptor
    again = image(turned(walls, 1.0, np.array([2.0, 1.0]))).descriptor
    other = image(walls_of(np.array([[-9.0, 1.0], [9.0, 1.0], [9.0, -1.0]]))).descriptor

    assert here @ again > 0.95
    assert here @ other < here @ again - 0.03


# -- free space


def test_a_point_in_front_of_what_was_seen_contradicts_it():
    wall = np.array([[5.0, 0.01 * k, 0.01 * m] for k in range(-20, 21) for m in range(-20, 21)])
    buffer = nearest_ranges(wall, 180, 90, 5)
    same, closer, behind = (wall * factor for factor in (1.0, 0.5, 2.0))
    ratios = [
        seen_through_ratio(buffer, p, np.eye(3), np.zeros(3), 0.1, 0.3)
        for p in (same, closer, behind)
    ]

    assert ratios == [0.0, 1.0, 0.0]


# -- bounds


def test_errors_add_up_along_the_walk_and_a_loop_closure_shortens_it():
    ends = np.array([0, 40])
    open_m = relative_bounds(straight(41), ends, leveled=True).horizontal_m[0, 1]
    loop = edge(2, 38, kind=EdgeKind.LOOP)
    closed_m = relative_bounds(straight(41, loop), ends, leveled=True).horizontal_m[0, 1]

    assert open_m == pytest.approx(4.0, rel=0.05)
    assert closed_m == pytest.approx(0.5, rel=0.1)


def test_heights_of_a_leveled_walk_do_not_drift():
    ends = np.array([0, 36])
    leveled, free = (
        relative_bounds(straight(37), ends, leveled=known).vertical_m[0, 1]
        for known in (True, False)
    )

    assert leveled == pytest.approx(0.6)
    assert free > 3.5


def test_a_rejected_edge_shortens_nothing():
    loop = edge(2, 38, kind=EdgeKind.LOOP, reason=Reason.ERROR)
    bounds = relative_bounds(straight(41, loop), np.array([0, 40]), leveled=True)

    assert bounds.horizontal_m[0, 1] == pytest.approx(4.0, rel=0.05)


def test_bounds_of_a_long_walk_are_hardly_larger_than_the_best_path(monkeypatch):
    walk = straight(121, edge(20, 100, kind=EdgeKind.LOOP))
    nodes = np.arange(121)
    exact = relative_bounds(walk, nodes, leveled=True)
    monkeypatch.setattr(best_paths, "BOUNDS", BoundTuning(anchors=12, chunk=5))
    bounded = relative_bounds(walk, nodes, leveled=True)
    rows = nodes[:, None], nodes[None, :]
    for name in ("horizontal_m", "vertical_m", "yaw_rad"):
        one, other = (getattr(of, name)[rows] for of in (exact, bounded))
        assert (other >= one - 1e-9).all()
        assert np.diagonal(other, 1) == pytest.approx(np.diagonal(one, 1))
    assert (bounded.horizontal_m[rows] - exact.horizontal_m[rows]).max() < 2.2  # 22 m of path


def test_paths_are_followed_only_from_places_that_are_asked_for(monkeypatch):
    monkeypatch.setattr(best_paths, "BOUNDS", BoundTuning(anchors=12, chunk=5))
    nodes = np.arange(121)
    walk = straight(121, edge(20, 100, kind=EdgeKind.LOOP))
    some, all_m = (relative_bounds(walk, nodes, leveled=True).horizontal_m for _ in range(2))
    every = all_m[nodes[:, None], nodes[None, :]]

    np.testing.assert_array_equal(some[:90, 90], every[:90, 90])
    assert [*some.followed] == [some.anchor[90]]
    assert some[3, 117] == every[3, 117]
    assert {*some.followed} == {some.anchor[90], some.anchor[117]}
    assert some[nodes[:0], nodes[:0]].shape == (0,)


def test_a_height_on_the_edge_of_a_layer_belongs_to_the_layer_above():
    edges_m = np.arange(*DENSITY.heights_m)
    heights_m = np.concatenate([edges_m[:-1], edges_m[:-1] + 0.1, [-9.0, 9.0]])

    assert layers_of(heights_m).tolist() == [2] * (len(edges_m) - 1)


def test_images_come_back_from_the_disk_as_they_were(tmp_path):
    drawn = [image(walls_of(TWO_CUBES, count)) for count in (300, 5, 2000)]
    stored = StoredImages(tmp_path)
    for one in drawn:
        stored.append(one)

    for one, other in zip(drawn, stored, strict=True):
        for name in ("walls_m", "spectrum", "descriptor"):
            np.testing.assert_array_equal(getattr(one, name), getattr(other, name))
            assert getattr(one, name).dtype == getattr(other, name).dtype
    np.testing.assert_array_equal(stored.descriptors[2], drawn[2].descriptor)
    assert list(tmp_path.iterdir()) == []


def test_where_every_place_is_known_none_is_drawn(tmp_path):
    known = [edge(k - 5, k, kind=EdgeKind.LOOP) for k in range(5, 41)]
    registrar = SimpleNamespace(recognition=SETTINGS)
    drawer = PlaceDrawer(SimpleNamespace(scratch=tmp_path), SETTINGS, leveled=True)
    start = (edge(0, k, kind=EdgeKind.LOOP) for k in range(2, 5))

    found = recognize(straight(41, *known, *start), registrar, drawer, progress=Silent())

    assert found == []


# -- which corrections are accepted


WALK = straight(41)


def places_of(graph, *, every=1):
    """A place at every n-th node."""
    nodes = np.arange(0, len(graph), every)
    bounds = relative_bounds(graph, nodes, leveled=True)
    return Places(graph, nodes, np.arange(len(graph), dtype=float), (), np.zeros((41, 1)), bounds)


def test_the_drift_at_a_node_is_that_of_a_meter_of_path():
    places = places_of(straight(41), every=4)

    assert places.drift_of_meter(13).across_m == pytest.approx(0.1, rel=0.05)
    assert places.drift_between(2, 22).across_m == pytest.approx(2.0, rel=0.05)


def chain(first, *, off_m=(0.0, 0.0, 0.0), nodes=5, bad=0):
    """Nodes from ``first`` on, seen again at nodes 0, 1, …, moved by ``off_m``."""
    edges = [
        edge(k, first + k, kind=EdgeKind.LOOP, T_i_j=SE3(
            np.eye(3), np.array([float(first), 0.0, 0.0]) + off_m))
        for k in range(nodes)
    ]  # fmt: skip
    edges += [
        edge(nodes + k, first + nodes + k, kind=EdgeKind.LOOP, reason=Reason.SEEN_THROUGH)
        for k in range(bad)
    ]
    return RecognizedChain(place=first, earlier=0, edges=edges)


def reasons(*chains, settings=SETTINGS, walk=WALK):
    judged = judge_chains(places_of(walk), chains, settings=settings)
    out, at = [], 0
    for one in chains:
        out.append({e.reason for e in judged[at : at + len(one.edges)]} - {Reason.SEEN_THROUGH})
        at += len(one.edges)
    return out


def test_a_correction_within_the_uncertainty_is_accepted():
    assert reasons(chain(30, off_m=(2.0, 3.0, 0.1))) == [{Reason.NONE}]


def test_the_group_says_how_many_nodes_confirm_a_correction():
    few = chain(30, nodes=SETTINGS.min_places - 1)
    doubted = chain(30, nodes=SETTINGS.min_places, bad=SETTINGS.min_places)
    edges = [
        judge_chains(places_of(WALK), [one], settings=SETTINGS)[0]
        for one in (chain(30), few, doubted)
    ]

    assert all(edge.judgments[0].by is Judge.SEARCH for edge in edges)
    last = [edge.judgments[-1] for edge in edges]
    assert {one.by for one in last} == {Judge.PLACES}
    assert [(one.verdict, one.measure) for one in last] == [
        (Verdict.ACCEPTED, Measure.CONFIRMED),
        (Verdict.REJECTED, Measure.CONFIRMED),
        (Verdict.REJECTED, Measure.CONTRADICTED),
    ]
    assert last[0].value >= last[0].limit and last[1].value < last[1].limit
    assert last[2].value > last[2].limit


def test_a_correction_beyond_the_uncertainty_is_ambiguous():
    assert reasons(chain(30, off_m=(0.0, 9.0, 0.0))) == [{Reason.AMBIGUOUS}]


def test_a_storey_is_beyond_the_uncertainty_however_far_the_walk_drifts():
    assert reasons(chain(30, off_m=(0.0, 0.0, 3.0))) == [{Reason.AMBIGUOUS}]


def test_two_corrections_that_are_equally_good_are_both_ambiguous():
    found = reasons(chain(30, off_m=(1.0, 0.0, 0.0)), chain(30, off_m=(-4.0, 0.0, 0.0), nodes=4))

    assert found == [{Reason.AMBIGUOUS}, {Reason.AMBIGUOUS}]


def test_a_weaker_rival_does_not_count():
    found = reasons(chain(28, off_m=(1.0, 0.0, 0.0), nodes=9), chain(30, off_m=(-4, 0, 0), nodes=4))

    assert found[0] == {Reason.NONE}


def test_one_place_alone_is_not_accepted():
    assert reasons(chain(30, nodes=2)) == [{Reason.UNCONFIRMED}]


def test_views_that_contradict_a_correction_outvote_it():
    assert reasons(chain(30, bad=2)) == [{Reason.UNCONFIRMED}]


def test_chains_that_agree_support_each_other():
    apart = (chain(26, nodes=2), replace(chain(32, nodes=2), place=32))

    assert reasons(*apart) == [{Reason.NONE}, {Reason.NONE}]


@pytest.mark.parametrize(("sd_m", "found"), [(0.1, Reason.NONE), (0.005, Reason.UNCONFIRMED)])
def test_corrections_may_differ_by_the_drift_that_the_graph_states(sd_m, found):
    walk = straight(41)
    walk = walk.with_edges(tuple(edge(e.i, e.j, sd_m=sd_m) for e in walk.edges))
    apart = (chain(26, nodes=2), chain(33, nodes=2, off_m=(0.0, 1.3, 0.0)))

    assert reasons(*apart, walk=walk) == [{found}, {found}]


def test_corrections_of_different_storeys_do_not_agree_however_far_the_walk_drifts():
    walk = straight(41)
    unsure = np.diag([1e8, 1e8, 1e8, 1.0, 1.0, 1e4])
    walk = walk.with_edges(tuple(e.evolve(information=unsure) for e in walk.edges))
    apart = (chain(26, nodes=2), chain(33, nodes=2, off_m=(0.0, 0.0, 3.0)))

    assert reasons(*apart, walk=walk) == [{Reason.UNCONFIRMED}, {Reason.UNCONFIRMED}]
