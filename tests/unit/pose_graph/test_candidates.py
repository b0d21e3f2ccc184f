"""Which multiframes become nodes, and which pairs are tried."""

from dataclasses import replace

import numpy as np
import pytest

from recon4.geometry.se3 import SE3
from recon4.model.pose_graph import Edge, EdgeKind, Verdict, known_history
from recon4.pose_graph.candidates import (
    distance_schedule,
    neighbor_pairs,
    pairs_at_distances,
    revisit_pairs,
    rounds,
)
from recon4.pose_graph.tuning import GraphTuning
from recon4.registration.submap import node_rows
from tests.unit.pose_graph.graphs import ends, graph_at, laps, line

# -- which multiframes become nodes


def test_every_fifth_multiframe_is_a_node_from_the_middle_of_the_first_five():
    assert node_rows(np.arange(21), 5, np.zeros(21, bool)).tolist() == [2, 7, 12, 17]


def test_lost_multiframes_are_not_nodes():
    lost = np.zeros(21, bool)
    lost[[7, 8]] = True

    assert node_rows(np.arange(21), 5, lost).tolist() == [2, 12, 17]


@pytest.mark.parametrize(("count", "rows"), [(1, [0]), (2, [1]), (3, [2]), (8, [2, 7])])
def test_a_recording_shorter_than_the_stride_has_a_node(count, rows):
    assert node_rows(np.arange(count), 5, np.zeros(count, bool)).tolist() == rows


def test_there_is_a_node_even_where_tracking_was_lost():
    lost = np.ones(12, bool)
    lost[4] = False

    assert node_rows(np.arange(12), 5, lost).tolist() == [4]
    assert node_rows(np.arange(12), 5, np.ones(12, bool)).tolist() == [0]


# -- which pairs are tried


@pytest.mark.parametrize("farthest", [0, 1, 2, 7, 90, 1000])
def test_the_schedule_holds_each_distance_once_and_grows(farthest):
    batches = distance_schedule(farthest)

    assert [d for batch in batches for d in batch] == list(range(1, farthest + 1))
    assert len(batches) <= 8 + 6 * np.log2(max(farthest, 2))


@pytest.mark.parametrize("nodes", [2, 3, 4, 9, 10])
def test_a_closed_walk_tries_each_pair_once(nodes):
    settings = GraphTuning(exhaustive=True, closed_trajectory=True)

    tried = [p for batch in rounds(nodes, settings) for p in ends(batch(line(nodes)))]

    # For even N a pair at d = N/2 comes up from both of its ends (A0 no. 5).
    assert sorted(tried) == [(i, j) for i in range(nodes) for j in range(i + 1, nodes)]


@pytest.mark.parametrize("nodes", [2, 3, 10, 11])
def test_an_open_walk_tries_each_pair_once_its_ends_included(nodes):
    settings = GraphTuning(exhaustive=True)

    tried = [p for batch in rounds(nodes, settings) for p in ends(batch(line(nodes)))]

    assert sorted(tried) == [(i, j) for i in range(nodes) for j in range(i + 1, nodes)]


def test_wrapping_pairs_need_a_closed_trajectory():
    graph = line(6)

    open_pairs = ends(pairs_at_distances(graph, distances=[2], settings=GraphTuning()))
    closed = ends(
        pairs_at_distances(graph, distances=[2], settings=GraphTuning(closed_trajectory=True))
    )

    assert open_pairs == [(0, 2), (1, 3), (2, 4), (3, 5)]
    assert closed == [*open_pairs, (0, 4), (1, 5)]


def test_registered_pairs_are_not_selected_again():
    tried = Edge(
        i=1,
        j=3,
        T_i_j=SE3.identity(),
        kind=EdgeKind.NEIGHBOR,
        judgments=known_history(Verdict.REJECTED),
    )
    graph = line(5).with_edges((tried,))

    assert ends(pairs_at_distances(graph, distances=[2], settings=GraphTuning())) == [
        (0, 2),
        (2, 4),
    ]


@pytest.mark.parametrize(("mode", "stride", "farthest"), [
    ("10", 5, 2), ("10", 2, 5), ("10", 20, 1), ("overlap", 5, 4), ("beyond", 5, 4)
])  # fmt: skip
def test_mode_10_tries_ten_multiframes_and_the_others_their_neighbors(mode, stride, farthest):
    settings = GraphTuning(mode=mode, node_stride=stride)

    pairs = ends(neighbor_pairs(line(30), settings))

    assert max(j - i for i, j in pairs) == farthest
    assert len(rounds(30, settings)) == (1 if mode == "10" else 3)


def test_mode_10_stays_within_ten_multiframes_in_an_exhaustive_search_too():
    settings = GraphTuning(mode="10", exhaustive=True)

    tried = [p for batch in rounds(30, settings) for p in ends(batch(line(30)))]

    assert max(j - i for i, j in tried) == 2


def test_a_pair_starts_from_the_poses_of_the_graph():
    graph = line(4)
    pair = neighbor_pairs(graph, GraphTuning())[0]

    np.testing.assert_allclose(pair.T_i_j.t, [0.5, 0, 0])
    assert pair.kind is EdgeKind.NEIGHBOR


def test_revisits_are_near_in_space_but_not_in_time():
    graph = laps(2)
    settings = GraphTuning()

    pairs = revisit_pairs(graph, settings=settings, limit=6)

    assert pairs
    for pair in pairs:
        assert pair.kind is EdgeKind.LOOP
        assert pair.j - pair.i > settings.neighbors
        distance_m = np.linalg.norm(graph.T_map_body.t[pair.i] - graph.T_map_body.t[pair.j])
        assert distance_m <= settings.revisit_radius_m + settings.drift_ratio * 63 * 2
    assert (0, 40) in ends(pairs)


def test_each_visit_is_represented_before_any_comes_twice():
    graph = laps(4)

    pairs = revisit_pairs(graph, settings=GraphTuning(), limit=3)

    # Node 130 lies in the fourth lap; 10, 50 and 90 are the same place in the laps before.
    assert [i for i, j in ends(pairs) if j == 130] == [10, 50, 90]


def test_a_single_visit_is_represented_more_than_once_but_not_by_neighbors():
    pairs = revisit_pairs(laps(2, nodes=120), settings=GraphTuning(), limit=6)

    earlier = [i for i, j in ends(pairs) if j == 180 and i < 120]  # those of the lap before
    assert 60 in earlier
    assert len(earlier) > 2
    assert min(np.diff(earlier)) > 2


def test_no_node_has_more_revisits_than_the_limit_and_two_limits_never_repeat():
    graph = laps(6)

    few = revisit_pairs(graph, settings=GraphTuning(), limit=2)
    made = tuple(
        Edge(
            i=p.i,
            j=p.j,
            T_i_j=p.T_i_j,
            kind=p.kind,
            judgments=known_history(Verdict.ACCEPTED),
        )
        for p in few
    )
    more = revisit_pairs(graph.with_edges(made), settings=GraphTuning(), limit=6)

    assert np.bincount([p.j for p in few]).max() == 2
    assert not set(ends(few)) & set(ends(more))
    assert np.bincount([p.j for p in [*few, *more]]).max() <= 8


def test_the_number_of_pairs_is_linear_in_the_path_length():
    count = [
        len(revisit_pairs(laps(n), settings=GraphTuning(), limit=6))
        + len(neighbor_pairs(laps(n), GraphTuning()))
        for n in (10, 20, 40)
    ]

    # The first laps have fewer earlier visits than the limit.
    assert count[1] / count[0] < 2.3
    assert count[2] / count[1] < 2.15


def test_the_revisit_radius_grows_with_the_path_length():
    # Back at the start after 800 m, 7 m off: more than 4 m, less than 4 m + 0.5 % of the path.
    out, back = np.linspace(0, 400, 400), np.linspace(400, 0, 400)
    t_m = np.zeros((800, 3))
    t_m[:, 0] = np.concatenate([out, back])
    t_m[400:, 1] = np.linspace(0, 7, 400)

    tolerant = revisit_pairs(graph_at(t_m), settings=GraphTuning(), limit=2)
    strict = revisit_pairs(graph_at(t_m), settings=GraphTuning(drift_ratio=0.0), limit=2)

    assert 799 in [j for _, j in ends(tolerant)]
    assert 799 not in [j for _, j in ends(strict)]


def test_a_single_node_has_no_pairs():
    settings = GraphTuning()

    assert neighbor_pairs(line(1), settings) == []
    assert revisit_pairs(line(1), settings=settings, limit=6) == []
    assert rounds(1, replace(settings, exhaustive=True)) == []
