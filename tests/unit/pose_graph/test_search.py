"""The stage ``graph``: what is registered, tried again and kept."""

import errno
import json
from dataclasses import replace

import numpy as np
import pytest

from recon4.errors import Cancelled, ConfigError
from recon4.geometry.se3 import SE3
from recon4.model.events import EdgeTried
from recon4.model.plain import to_plain
from recon4.model.pose_graph import Edge, EdgeKind, Reason, Verdict, known_history
from recon4.pose_graph import node_views
from recon4.pose_graph.candidates import (
    retry_pairs,
)
from recon4.pose_graph.files import load_graph, save_graph
from recon4.pose_graph.node_views import NodeRangeImages
from recon4.pose_graph.pairs import PairRegistrar, tried_event
from recon4.pose_graph.search import OdometryTrack, SearchMeans, build_graph, search
from recon4.pose_graph.tuning import GraphTuning
from recon4.pose_graph.verification import verify
from recon4.progress import Silent
from recon4.registration.stage import run_odometry
from recon4.registration.tracked_walk import WalkInputs
from recon4.registration.tuning import OverlapTuning
from recon4.semi_rigid.refine import refine
from recon4.settings import (
    RegistrationSettings,
    Settings,
    VerificationSettings,
    override,
)
from recon4.store.arrays import load_trajectory
from recon4.store.unfinished import keeping
from tests.scanned_room import strolling, walk, without_points
from tests.tuned import with_tuning
from tests.unit.pose_graph.graphs import ends, graph_at

# -- the stage


@pytest.fixture(scope="module")
def stroll():
    return walk(strolling, 24)


def settings_of(*assignments):
    return with_tuning(Settings(), "graph.workers=1", *assignments)


@pytest.fixture(scope="module")
def searched(stroll, tmp_path_factory):
    folder, watch = tmp_path_factory.mktemp("searched"), Silent()
    (folder / "odometry").mkdir()
    (folder / "graph").mkdir()
    run_odometry(WalkInputs(stroll, Settings(), Silent()), folder / "odometry")
    facts = build_graph(
        stroll,
        folder / "odometry",
        SearchMeans(folder / "graph"),
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
        i=0,
        j=1,
        T_i_j=SE3.identity(),
        kind=EdgeKind.LOOP,
        overlap=0.1,
        judgments=known_history(Verdict.REJECTED),
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
        SearchMeans(out),
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
            stroll,
            searched[0] / "odometry",
            SearchMeans(searched[0]),
            settings=settings_of(),
            progress=Stop(),
        )


class StopsAt(Silent):
    """Asks to stop after a number of pairs, and counts those that were registered."""

    def __init__(self, pairs):
        super().__init__()
        self.left, self.task = pairs, ""

    def start(self, name, total, unit):
        super().start(name, total, unit)
        self.task = name

    def advance(self, done=1):
        if self.task == "pairs":
            self.left -= done
            if self.left < 0:
                raise Cancelled("enough")


def test_a_search_that_was_stopped_goes_on_with_the_same_result(
    searched, stroll, tmp_path, monkeypatch
):
    made = {"solve": 0, "view": 0}

    def counted(name, function):
        def call(*given, **named):
            made[name] += 1
            return function(*given, **named)

        return call

    monkeypatch.setattr(PairRegistrar, "_solve", counted("solve", PairRegistrar._solve))
    monkeypatch.setattr(
        node_views, "make_range_image", counted("view", node_views.make_range_image)
    )

    def run(progress):
        made.update(solve=0, view=0)
        settings = settings_of("graph.node_stride=3", "graph.workers=1")
        with keeping(tmp_path, "graph", "key"):
            odometry = searched[0] / "odometry"
            means = SearchMeans(tmp_path)
            build_graph(stroll, odometry, means, settings=settings, progress=progress)
        return dict(made)

    with pytest.raises(Cancelled):
        run(StopsAt(9))
    again = run(Silent())
    fresh = run(Silent())

    assert fresh["solve"] >= again["solve"] + 9
    assert (again["view"], fresh["view"] > 0) == (0, True)
    for name in ("graph.npz", "edges.json"):
        assert (tmp_path / name).read_bytes() == (searched[0] / "graph" / name).read_bytes()


# -- tried again


def test_a_pair_turned_down_is_tried_again_once_its_poses_have_moved():
    def edge(i, j, verdict, kind=EdgeKind.LOOP):
        return Edge(
            i=i,
            j=j,
            T_i_j=SE3.identity(),
            kind=kind,
            judgments=known_history(verdict),
        )

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
        np.zeros(len(stroll), int),
    )
    return search(
        stroll,
        odometry,
        settings=settings_of(
            *("graph.node_stride=3", "graph.target_reach=1", "graph.source_reach=1"),
            *("registration.max_move_m=0.3", *assignments),
        ),
        progress=watch,
        means=SearchMeans(folder),
    )


def test_pairs_rejected_because_of_a_poor_pose_are_registered_again(stroll, tmp_path):
    watch = Silent()
    once = drifting_search(stroll, tmp_path, Silent(), "graph.retry_rounds=0")
    again = drifting_search(stroll, tmp_path, watch)

    assert sum(e.reason is Reason.NOT_CONVERGED for e in once.edges) >= 5
    assert not any(e.reason is Reason.NOT_CONVERGED for e in again.edges)
    assert sum(e.in_graph for e in again.edges) > sum(e.in_graph for e in once.edges)
    # The history has what the first registration said.
    earlier = [e for e in again.edges for one in e.judgments if one.reason is Reason.NOT_CONVERGED]
    assert len(earlier) >= 5
    assert all(len(e.judgments) >= 2 for e in earlier)
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
            NodeRangeImages(50, GraphTuning(), overlap=OverlapTuning(), scratch=tmp_path)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)

    assert caught.value.errno in {errno.EFBIG, errno.ENOSPC}


@pytest.mark.parametrize("assignment", ["node_stride=0", "workers=0"])
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
    run_odometry(WalkInputs(frames, settings, Silent()), folder / "odometry")
    means = SearchMeans(folder / "graph")
    build_graph(frames, folder / "odometry", means, settings=settings, progress=Silent())
    found = verify(load_graph(folder / "graph"), settings=VerificationSettings())
    save_graph(folder / "verified", found.graph)
    facts = refine(
        frames,
        folder / "odometry",
        load_graph(folder / "verified").nodes,
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
    assert len(graph.edges) == 0
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
    odometry = OdometryTrack(stroll.truth, np.ones(n, bool), np.zeros((n, 6, 6)), np.zeros(n, int))
    graph = search(
        stroll, odometry, settings=settings_of(), progress=Silent(), means=SearchMeans(tmp_path)
    )

    assert len(graph) == 1
    assert len(graph.edges) == 0
