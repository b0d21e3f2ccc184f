import errno
import json
from dataclasses import replace

import numpy as np
import pytest

from recon4.errors import Cancelled, ConfigError
from recon4.geometry.se3 import SE3
from recon4.model.events import EdgeTried
from recon4.model.plain import to_plain
from recon4.model.pose_graph import Edge, EdgeKind, PoseGraph, Reason, Verdict
from recon4.pose_graph.candidates import (
    distance_schedule,
    neighbor_pairs,
    pairs_at_distances,
    retry_pairs,
    revisit_pairs,
    rounds,
)
from recon4.pose_graph.files import load_graph, save_graph
from recon4.pose_graph.pairs import tried_event
from recon4.pose_graph.search import OdometryTrack, build_graph, odometry_edges, search
from recon4.pose_graph.verification import verify
from recon4.progress import Silent
from recon4.registration.stage import run_odometry
from recon4.registration.submap import NodeRangeImages, node_rows
from recon4.semi_rigid.refine import refine
from recon4.settings import (
    GraphSettings,
    RegistrationSettings,
    Settings,
    VerificationSettings,
    override,
)
from recon4.store.arrays import load_trajectory
from tests.scanned_room import strolling, walk, without_points


def graph_at(t_m, edges=()):
    t_m = np.asarray(t_m, dtype=np.float64)
    rows = np.arange(len(t_m), dtype=np.int64)
    R = np.broadcast_to(np.eye(3), (len(t_m), 3, 3)).copy()
    return PoseGraph(rows, rows * 500_000_000, SE3(R, t_m), tuple(edges))


def line(nodes, step_m=0.5):
    t_m = np.zeros((nodes, 3))
    t_m[:, 0] = step_m * np.arange(nodes)
    return graph_at(t_m)


def laps(count, nodes=40, radius_m=10.0):
    """Round after round on a circle."""
    turn = 2 * np.pi * np.arange(count * nodes) / nodes
    return graph_at(radius_m * np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1))


def ends(pairs):
    return [(pair.i, pair.j) for pair in pairs]


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
    settings = GraphSettings(exhaustive=True, closed_trajectory=True)

    tried = [p for batch in rounds(nodes, settings) for p in ends(batch(line(nodes)))]

    # For even N a pair at d = N/2 comes up from both of its ends (A0 no. 5).
    assert sorted(tried) == [(i, j) for i in range(nodes) for j in range(i + 1, nodes)]


@pytest.mark.parametrize("nodes", [2, 3, 10, 11])
def test_an_open_walk_tries_each_pair_once_its_ends_included(nodes):
    settings = GraphSettings(exhaustive=True)

    tried = [p for batch in rounds(nodes, settings) for p in ends(batch(line(nodes)))]

    assert sorted(tried) == [(i, j) for i in range(nodes) for j in range(i + 1, nodes)]


def test_wrapping_pairs_need_a_closed_trajectory():
    graph = line(6)

    open_pairs = ends(pairs_at_distances(graph, distances=[2], settings=GraphSettings()))
    closed = ends(
        pairs_at_distances(graph, distances=[2], settings=GraphSettings(closed_trajectory=True))
    )

    assert open_pairs == [(0, 2), (1, 3), (2, 4), (3, 5)]
    assert closed == [*open_pairs, (0, 4), (1, 5)]


def test_registered_pairs_are_not_selected_again():
    tried = Edge(i=1, j=3, T_i_j=SE3.identity(), kind=EdgeKind.NEIGHBOR, verdict=Verdict.REJECTED)
    graph = line(5).with_edges((tried,))

    assert ends(pairs_at_distances(graph, distances=[2], settings=GraphSettings())) == [
        (0, 2),
        (2, 4),
    ]


@pytest.mark.parametrize(("mode", "stride", "farthest"), [
    ("10", 5, 2), ("10", 2, 5), ("10", 20, 1), ("overlap", 5, 4), ("beyond", 5, 4)
])  # fmt: skip
def test_mode_10_tries_ten_multiframes_and_the_others_their_neighbors(mode, stride, farthest):
    settings = GraphSettings(mode=mode, node_stride=stride)

    pairs = ends(neighbor_pairs(line(30), settings))

    assert max(j - i for i, j in pairs) == farthest
    assert len(rounds(30, settings)) == (1 if mode == "10" else 3)


def test_mode_10_stays_within_ten_multiframes_in_an_exhaustive_search_too():
    settings = GraphSettings(mode="10", exhaustive=True)

    tried = [p for batch in rounds(30, settings) for p in ends(batch(line(30)))]

    assert max(j - i for i, j in tried) == 2


def test_a_pair_starts_from_the_poses_of_the_graph():
    graph = line(4)
    pair = neighbor_pairs(graph, GraphSettings())[0]

    np.testing.assert_allclose(pair.T_i_j.t, [0.5, 0, 0])
    assert pair.kind is EdgeKind.NEIGHBOR


def test_revisits_are_near_in_space_but_not_in_time():
    graph = laps(2)
    settings = GraphSettings()

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

    pairs = revisit_pairs(graph, settings=GraphSettings(), limit=3)

    # Node 130 lies in the fourth lap; 10, 50 and 90 are the same place in the laps before.
    assert [i for i, j in ends(pairs) if j == 130] == [10, 50, 90]


def test_a_single_visit_is_represented_more_than_once_but_not_by_neighbors():
    pairs = revisit_pairs(laps(2, nodes=120), settings=GraphSettings(), limit=6)

    earlier = [i for i, j in ends(pairs) if j == 180 and i < 120]  # those of the lap before
    assert 60 in earlier
    assert len(earlier) > 2
    assert min(np.diff(earlier)) > 2


def test_no_node_has_more_revisits_than_the_limit_and_two_limits_never_repeat():
    graph = laps(6)

    few = revisit_pairs(graph, settings=GraphSettings(), limit=2)
    made = tuple(
        Edge(i=p.i, j=p.j, T_i_j=p.T_i_j, kind=p.kind, verdict=Verdict.ACCEPTED) for p in few
    )
    more = revisit_pairs(graph.with_edges(made), settings=GraphSettings(), limit=6)

    assert np.bincount([p.j for p in few]).max() == 2
    assert not set(ends(few)) & set(ends(more))
    assert np.bincount([p.j for p in [*few, *more]]).max() <= 8


def test_the_number_of_pairs_is_linear_in_the_path_length():
    count = [
        len(revisit_pairs(laps(n), settings=GraphSettings(), limit=6))
        + len(neighbor_pairs(laps(n), GraphSettings()))
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

    tolerant = revisit_pairs(graph_at(t_m), settings=GraphSettings(), limit=2)
    strict = revisit_pairs(graph_at(t_m), settings=GraphSettings(drift_ratio=0.0), limit=2)

    assert 799 in [j for _, j in ends(tolerant)]
    assert 799 not in [j for _, j in ends(strict)]


def test_a_single_node_has_no_pairs():
    settings = GraphSettings()

    assert neighbor_pairs(line(1), settings) == []
    assert revisit_pairs(line(1), settings=settings, limit=6) == []
    assert rounds(1, replace(settings, exhaustive=True)) == []


# -- odometry edges


ROWS = np.array([2, 7, 12])


def consecutive(T_odom_body, *, lost=(), motion_cov=None, settings=None):
    was_lost = np.isin(np.arange(15), lost)
    cov = np.zeros((15, 6, 6)) if motion_cov is None else np.tile(motion_cov, (15, 1, 1))
    return odometry_edges(
        T_odom_body, ROWS, was_lost, motion_cov=cov, settings=settings or GraphSettings()
    )


def test_odometry_edges_join_consecutive_nodes():
    edges = consecutive(line(3).T_map_body)

    assert [(e.i, e.j) for e in edges] == [(0, 1), (1, 2)]
    assert all(e.kind is EdgeKind.ODOMETRY and e.verdict is Verdict.ACCEPTED for e in edges)
    np.testing.assert_allclose(edges[0].T_i_j.t, [0.5, 0, 0])


def test_an_odometry_edge_is_never_surer_than_its_floor():
    g = GraphSettings()

    sd = np.diag(consecutive(line(3).T_map_body)[0].information) ** -0.5

    np.testing.assert_allclose(sd, np.repeat([g.odometry_sd_rad, g.odometry_sd_m], 3))


def test_deviations_of_the_motion_between_two_nodes_add_up_in_the_axes_of_the_second():
    # A corridor along odom's x leaves 2 cm a frame open; the body looks along odom's y.
    looking_along_y = SE3.from_rpy(0, 0, np.pi / 2, t=[0.0, 0.0, 0.0])
    T = SE3.stack([looking_along_y] * 3)
    cov = np.diag([0, 0, 0, 0.02**2, 0, 0])

    edge = consecutive(T, motion_cov=cov)[0]

    g = GraphSettings()
    sd = np.sqrt(np.diag(np.linalg.inv(edge.information)))
    assert sd[4] == pytest.approx(np.hypot(5 * 0.02, g.odometry_sd_m))
    assert sd[3] == pytest.approx(g.odometry_sd_m)
    assert sd[5] == pytest.approx(g.odometry_sd_m)


def test_an_odometry_edge_is_open_along_what_odometry_left_open():
    askew = SE3.from_rpy(0, 0, 0.5, t=[0.0, 0.0, 0.0])

    edge = consecutive(SE3.stack([askew] * 3), motion_cov=np.diag([0, 0, 0, 0.02**2, 0, 0]))[0]

    _, axes = np.linalg.eigh(np.linalg.inv(edge.information)[3:, 3:])
    assert abs(axes[:, 2] @ askew.R.T @ [1.0, 0.0, 0.0]) > 0.999


def test_an_odometry_edge_counts_the_motion_after_its_first_node_up_to_its_second():
    T, sd_m = line(3).T_map_body, []
    for frame in (ROWS[0], ROWS[0] + 1, ROWS[1], ROWS[1] + 1):
        cov = np.zeros((15, 6, 6))
        cov[frame] = 0.01**2 * np.eye(6)
        edge = odometry_edges(
            T, ROWS, np.zeros(15, bool), motion_cov=cov, settings=GraphSettings()
        )[0]
        sd_m.append(np.sqrt(np.linalg.inv(edge.information)[5, 5]))

    assert [sd > 0.01 for sd in sd_m] == [False, True, True, False]


def test_an_odometry_edge_across_a_lost_multiframe_is_weak():
    whole, broken = consecutive(line(3).T_map_body, lost=[9])

    assert (np.diag(whole.information) > 1e4 * np.diag(broken.information)).all()
    assert np.linalg.eigvalsh(broken.information).min() > 0


# -- the stage


@pytest.fixture(scope="module")
def stroll():
    return walk(strolling, 24)


def settings_of(*assignments):
    return override(Settings(), ["graph.workers=1", *assignments])


@pytest.fixture(scope="module")
def searched(stroll, tmp_path_factory):
    folder, watch = tmp_path_factory.mktemp("searched"), Silent()
    (folder / "odometry").mkdir()
    (folder / "graph").mkdir()
    run_odometry(stroll, folder / "odometry", settings=Settings(), progress=Silent())
    facts = build_graph(
        stroll,
        folder / "odometry",
        folder / "graph",
        settings=settings_of("graph.node_stride=3"),
        progress=watch,
    )
    return folder, facts, watch


def gaps_m(T, T_true):
    delta = (T_true[0].inverse() @ T_true).inverse() @ (T[0].inverse() @ T)
    return np.linalg.norm(delta.t, axis=1)


def test_the_stage_keeps_and_reports_every_registered_pair(searched):
    folder, figures, watch = searched
    graph = load_graph(folder / "graph")

    assert figures.nodes == len(graph) == 8
    tried = [(e.i, e.j) for e in graph.edges if e.kind is not EdgeKind.ODOMETRY]
    assert len(tried) == len(set(tried))
    reported = [event for event in watch.events if isinstance(event, EdgeTried)]
    assert sorted((event.i, event.j) for event in reported) == sorted(tried)
    json.dumps(to_plain(reported), allow_nan=False)


def test_the_poses_of_the_graph_are_true(searched, stroll):
    graph = load_graph(searched[0] / "graph")

    assert gaps_m(graph.T_map_body, stroll.truth.at(graph.t_ns)).max() < 0.02
    for edge in graph.edges:
        if edge.in_graph and edge.kind is not EdgeKind.ODOMETRY:
            T_true = stroll.truth.at(graph.t_ns[[edge.i, edge.j]])
            off = (T_true[0].inverse() @ T_true[1]).inverse() @ edge.T_i_j
            assert np.linalg.norm(off.t) < 0.02


def test_the_event_of_an_edge_never_registered_has_no_error():
    edge = Edge(
        i=0, j=1, T_i_j=SE3.identity(), kind=EdgeKind.LOOP, verdict=Verdict.REJECTED, overlap=0.1
    )

    assert tried_event(edge).error_m is None
    assert tried_event(edge.evolve(error_m=0.02)).error_m == 0.02


def test_two_threads_find_the_same_edges_as_one(searched, stroll):
    folder, _, _ = searched
    out = folder / "two"
    out.mkdir()
    build_graph(
        stroll,
        folder / "odometry",
        out,
        settings=override(Settings(), ["graph.workers=2", "graph.node_stride=3"]),
        progress=Silent(),
    )

    one, two = load_graph(folder / "graph"), load_graph(out)

    assert len(one.edges) == len(two.edges)
    for a, b in zip(one.edges, two.edges, strict=True):
        assert (a.i, a.j, a.verdict, a.reason) == (b.i, b.j, b.verdict, b.reason)
        np.testing.assert_array_equal(a.T_i_j.t, b.T_i_j.t)
        np.testing.assert_array_equal(a.information, b.information)
    np.testing.assert_array_equal(one.T_map_body.t, two.T_map_body.t)


def test_who_asks_to_stop_is_heard(searched, stroll):
    class Stop(Silent):
        def advance(self, done=1):
            raise Cancelled("enough")

    with pytest.raises(Cancelled):
        build_graph(
            stroll, searched[0] / "odometry", searched[0], settings=settings_of(), progress=Stop()
        )


# -- tried again


def test_a_pair_turned_down_is_tried_again_once_its_poses_have_moved():
    def edge(i, j, verdict, kind=EdgeKind.LOOP):
        return Edge(i=i, j=j, T_i_j=SE3.identity(), kind=kind, verdict=verdict)

    refused, kept = Verdict.REJECTED, Verdict.ACCEPTED
    edges = [edge(0, 3, refused), edge(1, 3, kept), edge(0, 2, refused), edge(1, 2, refused)]
    graph = graph_at([[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0.3, 0]], edges)
    before = {
        (0, 3): SE3.from_rpy(0, 0, 0, t=[3, 0, 0]),
        (1, 3): SE3.from_rpy(0, 0, 0, t=[9, 0, 0]),
        (0, 2): SE3.from_rpy(0, 0, 0, t=[2, 0.15, 0]),
        (1, 2): SE3.from_rpy(0, 0, 0.05, t=[1, 0, 0]),
    }

    again = retry_pairs(graph, before, move_m=0.2)

    assert ends(again) == [(0, 3), (1, 2)]
    assert [pair.kind for pair in again] == [EdgeKind.LOOP, EdgeKind.LOOP]
    np.testing.assert_array_equal(again[0].T_i_j.t, [3, 0.3, 0])


def drifting_search(stroll, folder, watch, *assignments):
    """Odometry drifts by 12 cm per node; only initial poses within 30 cm converge."""
    t_s = (stroll.truth.t_ns - stroll.truth.t_ns[0]) * 1e-9
    drift = 0.4 * t_s[:, None] * [1.0, 0.0, 0.0]
    T = stroll.truth.T_a_b
    odometry = OdometryTrack(
        replace(stroll.truth, T_a_b=SE3(T.R, T.t + drift)),
        np.zeros(len(stroll), bool),
        np.broadcast_to(0.01 * np.eye(6), (len(stroll), 6, 6)),
    )
    return search(
        stroll,
        odometry,
        settings=settings_of(
            *("graph.node_stride=3", "graph.target_reach=1", "graph.source_reach=1"),
            *("registration.max_move_m=0.3", *assignments),
        ),
        progress=watch,
        scratch=folder,
    )


def test_pairs_rejected_because_of_a_poor_pose_are_registered_again(stroll, tmp_path):
    watch = Silent()
    once = drifting_search(stroll, tmp_path, Silent(), "graph.retry_rounds=0")
    again = drifting_search(stroll, tmp_path, watch)

    assert sum(e.reason is Reason.NOT_CONVERGED for e in once.edges) >= 5
    assert not any(e.reason is Reason.NOT_CONVERGED for e in again.edges)
    assert sum(e.in_graph for e in again.edges) > sum(e.in_graph for e in once.edges)
    # One edge per pair, that of the last registration; every registration was reported.
    pairs = [(e.i, e.j) for e in again.edges if e.kind is not EdgeKind.ODOMETRY]
    assert len(pairs) == len(set(pairs)) == len(once.edges) - len(once) + 1
    reported = [(e.i, e.j) for e in watch.events if isinstance(e, EdgeTried)]
    assert len(reported) > len(pairs)
    assert set(reported) == set(pairs)


def test_the_scratch_of_a_search_lies_in_its_own_folder_and_is_gone_after(
    stroll, tmp_path, monkeypatch
):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "no such folder"))

    drifting_search(stroll, tmp_path, Silent(), "graph.retry_rounds=0")

    assert list(tmp_path.iterdir()) == []


def test_a_full_disk_is_reported_before_the_search_begins(tmp_path):
    resource = pytest.importorskip("resource")
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, before[1]))
    try:
        with pytest.raises(OSError, match=r"too large|No space") as caught:
            NodeRangeImages(50, Settings(), tmp_path)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)

    assert caught.value.errno in {errno.EFBIG, errno.ENOSPC}


@pytest.mark.parametrize(
    "assignment", ["node_stride=0", "workers=0", "retry_rounds=-1", "retry_move_m=0"]
)
def test_invalid_settings_of_the_graph_are_rejected(assignment):
    with pytest.raises(ConfigError, match=assignment.partition("=")[0]):
        settings_of(f"graph.{assignment}")


def test_pairs_are_not_registered_as_single_scans():
    with pytest.raises(ConfigError, match=r"planes.*single scans"):
        RegistrationSettings(solver="scans")


# -- tiny recordings


def tiny(frames, folder):
    """All stages from multiframes to refined trajectory."""
    for name in ("odometry", "graph", "verified", "refined"):
        (folder / name).mkdir()
    settings = settings_of()
    run_odometry(frames, folder / "odometry", settings=settings, progress=Silent())
    build_graph(frames, folder / "odometry", folder / "graph", settings=settings, progress=Silent())
    found = verify(load_graph(folder / "graph"), settings=VerificationSettings())
    save_graph(folder / "verified", found.graph)
    facts = refine(
        frames,
        folder / "odometry",
        load_graph(folder / "verified"),
        settings=settings,
        progress=Silent(),
    ).save(folder / "refined")
    json.loads((folder / "refined" / "refine.json").read_text(), parse_constant=pytest.fail)
    return found.graph, load_trajectory(folder / "refined" / "trajectory.npz"), facts


@pytest.mark.parametrize("count", [1, 2, 4])
def test_a_recording_of_few_multiframes_goes_through(stroll, tmp_path, count):
    frames = replace(stroll, frames=stroll.frames[:count])

    graph, trajectory, _ = tiny(frames, tmp_path)

    assert len(graph) == 1
    assert graph.edges == ()
    at = trajectory.at(frames.t_mid_ns)
    assert gaps_m(at, frames.true_poses()).max() < 0.02


def test_a_recording_without_a_single_point_goes_through(stroll, tmp_path):
    empty = [without_points(frame) for frame in stroll.frames[:8]]

    graph, trajectory, facts = tiny(replace(stroll, frames=empty), tmp_path)

    assert len(graph) >= 1
    assert np.isfinite(trajectory.T_a_b.t).all()
    assert facts.rounds == ()


def test_all_lost_leaves_one_node(stroll, tmp_path):
    n = len(stroll)
    odometry = OdometryTrack(stroll.truth, np.ones(n, bool), np.zeros((n, 6, 6)))
    graph = search(stroll, odometry, settings=settings_of(), progress=Silent(), scratch=tmp_path)

    assert len(graph) == 1
    assert graph.edges == ()
