"""Trajectory and graph of a running job, from the events of its stages."""

import json
import os
import time

import numpy as np
import pytest

from recon4.model.plain import to_plain
from recon4.model.pose_graph import EdgeKind, Reason, Verdict
from recon4.pose_graph.files import load_graph
from recon4.pose_graph.search import SearchMeans, build_graph
from recon4.pose_graph.verification import verify
from recon4.progress import Silent
from recon4.registration.stage import run_odometry
from recon4.registration.tracked_walk import WalkInputs
from recon4.settings import Settings, VerificationSettings, override
from recon4_app.jobs.events import EventWriter, event_of
from recon4_app.viewer.scene.live import JobWatch, LiveGraph
from recon4_app.viewer.scene.source import ProjectSource
from tests.project_builder import build_project
from tests.scanned_room import strolling, walk

POSES = {
    "kind": "poses",
    "t_ns": [100, 200],
    "t_m": [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]],
    "quat_xyzw": [[0.0, 0.0, 0.0, 1.0]] * 2,
}
NODES = {"kind": "nodes", "t_ns": [1, 2, 3], "t_m": [[0, 0, 0], [1, 0, 0], [2, 0, 0]]}


def edge(i=0, j=2, verdict="accepted", reason=""):
    return {
        "kind": "edge", "i": i, "j": j, "edge_kind": "loop", "verdict": verdict,
        "reason": reason, "overlap": 0.5, "error_m": None, "limit_m": 0.03,
    }  # fmt: skip


def running(stage):
    return {"kind": "stage", "stage": stage, "state": "running"}


def fed(*events):
    live = LiveGraph()
    for fields in events:
        if (event := event_of(fields)) is not None:
            live.take(event)
    return live


def loops(live):
    return [e for e in live.graph.edges if e.kind is EdgeKind.LOOP]


def test_an_odometry_that_runs_again_replaces_the_walk():
    before, again = {**POSES, "t_ns": [300, 400]}, {**POSES, "t_ns": [150, 250]}

    live = fed(running("odometry"), POSES, before, again)

    assert live.trajectory.t_ns.tolist() == [150, 250]


def test_the_walk_grows_with_the_poses_reported():
    later = {**POSES, "t_ns": [300, 400]}

    live = fed(running("odometry"), POSES, later)

    np.testing.assert_array_equal(live.trajectory.t_ns, [100, 200, 300, 400])


def test_edges_lie_between_the_nodes_where_they_are_by_now():
    moved = {"kind": "nodes", "t_m": [[0, 0, 0], [1, 0, 0], [2, 5, 0]]}

    live = fed(running("graph"), NODES, edge(), moved)

    assert [(e.i, e.j) for e in loops(live)] == [(0, 2)]
    np.testing.assert_array_equal(live.graph.T_map_body.t[2], [2, 5, 0])
    assert sum(e.kind is EdgeKind.ODOMETRY for e in live.graph.edges) == 2


def test_a_loop_is_rejected_with_its_reason_when_verification_says_so():
    verdicts = {"kind": "verdicts", "edges": [[0, 2, "loop", "rejected", Reason.ROBUST.value]]}

    live = fed(running("graph"), NODES, edge(), running("verification"), verdicts)

    assert [(e.verdict, e.reason) for e in loops(live)] == [(Verdict.REJECTED, Reason.ROBUST)]


def test_a_pair_tried_again_is_one_edge_with_its_last_verdict():
    live = fed(running("graph"), NODES, edge(verdict="rejected", reason="not converged"), edge())

    assert [e.verdict for e in loops(live)] == [Verdict.ACCEPTED]


def test_a_new_run_forgets_the_one_before():
    live = fed(running("graph"), NODES, edge(), {"kind": "run"})

    assert live.graph is None and live.trajectory is None and live.stage == ""


@pytest.mark.parametrize(
    "event",
    [{}, {"kind": "edge"}, {**edge(), "verdict": "?"}, {**POSES, "t_ns": [1]}, {"kind": "new"}],
)
def test_a_malformed_event_changes_nothing(event):
    live = fed(running("graph"), NODES, event)

    assert loops(live) == []


@pytest.fixture
def job(tmp_path):
    folder = tmp_path / "jobs" / "j1"
    folder.mkdir(parents=True)
    request = {"project": str(tmp_path / "office"), "inputs": {}}
    (folder / "request.json").write_text(json.dumps(request))
    (folder / "heartbeat").touch()
    writer = EventWriter(folder)
    yield folder, writer
    writer.close()


def append(writer, event):
    writer.event(event_of(event))


def test_the_events_of_the_projects_own_job_are_followed(tmp_path, job):
    _, writer = job
    watch = JobWatch(tmp_path / "office", tmp_path / "jobs")
    other = JobWatch(tmp_path / "street", tmp_path / "jobs")

    append(writer, running("odometry"))
    append(writer, POSES)

    assert watch.changed() and not watch.changed()
    assert len(watch.live.trajectory) == 2
    assert not other.changed() and other.live.trajectory is None


@pytest.mark.parametrize("how", ["outcome", "silence"])
def test_a_job_that_is_over_is_followed_no_more(tmp_path, job, how):
    folder, writer = job
    watch = JobWatch(tmp_path / "office", tmp_path / "jobs")
    append(writer, running("odometry"))
    watch.changed()

    if how == "outcome":
        (folder / "outcome.json").write_text("{}")
    else:
        long_ago = time.time() - 100.0
        os.utime(folder / "heartbeat", (long_ago, long_ago))

    assert watch.changed() and watch.live.stage == ""


def test_while_odometry_runs_again_the_results_of_before_are_not_shown(tmp_path, job):
    build_project(tmp_path / "office", points=100)
    source = ProjectSource(tmp_path / "office", tmp_path / "jobs")
    assert source.content.cloud is not None

    append(job[1], running("odometry"))
    append(job[1], POSES)

    assert source.changed()
    assert source.content.cloud is None and source.content.edges is None
    assert len(source.content.trajectory) == 2


def test_edges_of_a_running_search_are_shown(tmp_path, job):
    build_project(tmp_path / "office", with_map=False)
    source = ProjectSource(tmp_path / "office", tmp_path / "jobs")

    for event in (running("graph"), NODES, edge(verdict="rejected", reason="error > limit")):
        append(job[1], event)

    assert source.changed()
    assert "rejected/error-limit" in {layer.key for layer in source.content.edges.layers}


def test_events_of_real_stages_make_the_graph_they_leave(tmp_path):
    frames, events = walk(strolling, 24), Silent()
    settings = override(Settings(), ["graph.workers=1", "graph.node_stride=3"])
    for name in ("odometry", "graph"):
        (tmp_path / name).mkdir()
    run_odometry(WalkInputs(frames, settings, events), tmp_path / "odometry")
    means = SearchMeans(tmp_path / "graph")
    build_graph(frames, tmp_path / "odometry", means, settings=settings, progress=events)
    searched = load_graph(tmp_path / "graph")
    verify(searched, settings=VerificationSettings(limit_m=1e-4), progress=events)
    verified = verify(searched, settings=VerificationSettings(limit_m=1e-4)).graph

    reported = [{"kind": event.kind, **to_plain(event)} for event in events.events]
    live = fed(running("graph"), *reported)

    read = {"nodes", "poses", "edge", "verdicts"}
    assert all(event_of(fields) for fields in reported if fields["kind"] in read)
    assert len(live.trajectory) == 4  # every fifth pose of the first twenty
    np.testing.assert_allclose(live.graph.T_map_body.t, searched.T_map_body.t, atol=1e-3)
    verdicts = {(e.i, e.j, e.kind): (e.verdict, e.reason) for e in verified.edges}
    assert {(e.i, e.j, e.kind): (e.verdict, e.reason) for e in live.graph.edges} == verdicts
    assert Reason.VERIFICATION in {reason for _, reason in verdicts.values()}
