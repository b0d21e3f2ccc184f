"""A real viser behind the proxy."""

import json
import os
import signal
import time
from pathlib import Path
from urllib.parse import urlsplit

import numpy as np
import pytest
from websockets.exceptions import ConnectionClosed

from recon4.model.events import EdgeTried, NodesPlaced, StageChanged, VerdictsChanged
from recon4.model.pose_graph import EdgeKind, Reason, Verdict
from recon4_app.jobs.events import EventWriter
from recon4_app.viewer.page import SHIMS
from tests.deadlines import HANG_S
from tests.processes import viewer_process
from tests.project_builder import add_multiframes, build_project, loop_walk, verified_graph
from tests.service.running import server_thread
from tests.service.viser_client import camera, viewing

POINTS = 60_000


@pytest.fixture(scope="module")
def root(tmp_path_factory):
    root = tmp_path_factory.mktemp("projects")
    build_project(root / "office", points=POINTS)
    add_multiframes(root / "office")
    return root


@pytest.fixture(scope="module")
def server(root):
    with server_thread(root) as running:
        yield running


@pytest.fixture
def looking(server):
    """A client that has everything."""
    with viewing(server.url) as client:
        client.send(camera((8.0, 3.0, 1.5)))
        client.until(lambda c: c.shown == POINTS and "60\u202f000 of" in c.html())
        yield client


def test_a_browser_gets_the_map_the_trajectory_and_the_edges_by_verdict(looking):
    assert {
        "/trajectory/0",
        "/edges/accepted/loop/0",
        "/edges/unverified/loop/0",
        "/edges/rejected/verification-median-limit/0",
        "/grid",
    } <= looking.nodes.keys()
    assert "Points by normalized intensity" in looking.html()
    assert "60\u202f000 of 60\u202f000 points" in looking.html()


def test_the_key_for_raw_intensity_sends_colors_only(looking):
    before = looking.bytes
    looking.press("Raw or normalized")
    looking.until(lambda c: "Points by raw intensity" in c.html())
    looking.rest()

    assert looking.colored == POINTS
    assert looking.bytes - before < POINTS * 3 + 10_000
    assert looking.widget("Color by")["value"] == "raw intensity"


def test_the_viewer_speaks_the_language_that_the_page_left(server):
    with viewing(server.url, storage={"recon4.language": "de"}) as client:
        client.send(camera((8.0, 3.0, 1.5)))
        client.until(lambda c: "Farbe: normierte Intensität" in c.html())
        client.set("Färben nach", "Höhe")
        client.until(lambda c: "m über dem Ursprung" in c.html())
        client.until(lambda c: '"height"' in c.storage.get("recon4.view.office", ""))

        assert client.widget("Kanten nach")["value"] == "Urteil"


def test_a_range_set_by_a_person_is_in_the_legend_until_it_is_taken_back(looking):
    looking.set("Color by", "height")
    looking.until(lambda c: "Points by height" in c.html())
    looking.set("Range to", 2.25)
    looking.until(lambda c: "<span>2.25</span>" in c.html())

    looking.set("Range of the map", True)

    looking.until(lambda c: "<span>2.25</span>" not in c.html())


def test_a_layer_switched_off_is_hidden_and_nothing_is_sent_again(looking):
    before = looking.bytes
    looking.set("Accepted, loop", False)

    looking.until(lambda c: not c.visible["/edges/accepted/loop/0"])

    assert looking.bytes - before < 5000


def test_a_click_on_an_edge_says_what_it_is_and_where_to_review_it(looking):
    start, end = rejected_edge()
    away = np.array([0.2, 0.3, 5.0])

    looking.click((start + end) / 2.0 + away, -away)
    looking.until(lambda c: "verification median" in c.html() and "Open in review" in c.html())

    assert 'href="../../office/review/?edge=' in looking.html()
    looking.until(lambda c: "/picked/edge" in c.nodes)


def test_on_a_phone_the_tapped_object_is_shown_over_the_map(server):
    start, end = rejected_edge()
    away = np.array([0.2, 0.3, 5.0])
    with viewing(server.url) as client:
        client.send(camera(width=390, height=844))
        client.until(lambda c: c.shown)

        client.click((start + end) / 2.0 + away, -away)

        client.until(lambda c: "verification median" in str(c.notes))


def test_two_clicks_measure_the_room_and_the_browser_keeps_it(looking):
    looking.press("Measure")
    looking.until(lambda c: "Stop measuring" in str(c.widgets))
    looking.click((9.8, 3.0, 1.5), (0.0, -1.0, 0.02))
    looking.until(lambda c: "/picked/first" in c.nodes)
    looking.click((9.8, 3.0, 1.5), (0.0, 1.0, 0.02))
    looking.until(lambda c: "Horizontal" in c.html() and "/measured/1" in c.nodes)
    looking.until(lambda c: "measurements" in c.storage.get("recon4.view.office", ""))
    looking.rest()

    (points,) = json.loads(looking.storage["recon4.view.office"])["measurements"]
    assert abs(points[0][1]) < 1e-6 and abs(points[1][1] - 10.0) < 1e-5


def test_a_point_picked_comes_with_time_sensor_and_intensities(looking):
    looking.click((9.8, 3.0, 1.5), (0.0, 1.0, 0.05))

    looking.until(lambda c: "Normalized" in c.html() and "Multiframe" in c.html())


def test_a_single_multiframe_is_shown_with_all_its_points_and_a_window_with_more(looking):
    looking.set("Show", "multiframe")
    looking.set("Multiframe", 120)
    looking.until(lambda c: "Multiframe 120 of 599, at 12.0 s" in c.html())
    looking.until(lambda c: c.points.get("/multiframe") == 400 and not c.visible["/map"])

    looking.set("Window", 1.0)
    looking.until(lambda c: c.points.get("/multiframe") == 11 * 400)

    looking.set("Show", "map")
    looking.until(lambda c: "/multiframe" not in c.points and c.visible["/map"])


def test_playing_goes_on_from_multiframe_to_multiframe(looking):
    looking.press("Play")
    looking.until(lambda c: "Multiframe 2 of 599" in c.html())
    looking.press("Play")
    looking.rest()

    assert "/multiframe" in looking.points and looking.visible["/map"]


def test_after_a_reconnect_the_view_is_as_it_was_and_the_camera_is_left_alone(server):
    storage = {}
    with viewing(server.url, storage=storage) as client:
        client.send(camera((8.0, 3.0, 1.5)))
        client.until(lambda c: c.shown == POINTS)
        client.set("Color by", "height")
        client.set("Trajectory", False)
        client.until(lambda c: '"trajectory": false' in c.storage.get("recon4.view.office", ""))

    with viewing(server.url, storage=storage) as client:
        client.send(camera((8.0, 3.0, 1.5)))
        client.until(lambda c: c.shown == POINTS and "Points by height" in c.html())
        client.rest()

        assert not client.nodes["/trajectory/0"].get("visible", client.visible["/trajectory/0"])
        assert client.widget("Color by")["value"] == "height"
        assert [m for m in client.cameras if not m["initial"]] == []


def test_a_browser_that_answers_nothing_still_gets_the_map(server):
    with viewing(server.url) as client:
        client.answers = False
        client.send(camera())
        client.until(lambda c: c.shown == POINTS)


def test_a_viewer_above_the_limit_is_rejected_and_the_others_stay(root):
    with (
        server_thread(root, viewer_sockets=2) as server,
        viewing(server.url) as first,
        viewing(server.url) as second,
    ):
        with viewing(server.url) as third, pytest.raises(ConnectionClosed) as closed:
            third.socket.recv(timeout=HANG_S)
        assert closed.value.rcvd.code == 4429

        for client in (first, second):
            client.send(camera())
            client.until(lambda c: c.shown == POINTS)


def test_a_killed_viewer_is_there_again_soon(server, root):
    with viewing(server.url) as client:
        client.send(camera())
        client.until(lambda c: c.shown == POINTS)
        os.kill(viewer_process(root).pid, signal.SIGKILL)
        with pytest.raises(ConnectionClosed):
            client.until(lambda c: False)

    began_s = time.monotonic()
    with viewing(server.url) as client:
        client.send(camera())
        client.until(lambda c: c.shown == POINTS and "/edges/accepted/loop/0" in c.nodes)
    assert time.monotonic() - began_s < 20.0  # 2 s on a quiet machine


def test_a_viewer_compiles_into_a_folder_of_its_own(server, root):
    with viewing(server.url):
        environment = viewer_process(root).environ()

    folder = root / ".recon4" / "viewers" / "office.tmp"
    assert Path(environment["NUMBA_CACHE_DIR"]).is_relative_to(folder)


def test_a_viewer_ends_with_its_server(tmp_path):
    build_project(tmp_path / "office", points=100)
    with server_thread(tmp_path) as server:
        with viewing(server.url) as client:
            client.send(camera())
            client.until(lambda c: c.shown)
        viewer = viewer_process(tmp_path)

    assert not viewer.is_running()


def test_a_viewer_without_clients_ends_by_itself(tmp_path):
    build_project(tmp_path / "office", points=100)
    with server_thread(tmp_path, viewer_idle_s=0.5) as server:
        with viewing(server.url) as client:
            client.send(camera())
            client.until(lambda c: c.shown)
            viewer = viewer_process(tmp_path)

        viewer.wait(timeout=20.0)


def test_new_artifacts_appear_while_one_looks(tmp_path):
    build_project(tmp_path / "office", with_map=False)
    with server_thread(tmp_path) as server, viewing(server.url) as client:
        client.send(camera())
        client.until(lambda c: "/trajectory/0" in c.nodes)
        assert not client.points

        build_project(tmp_path / "office", points=100)
        client.until(lambda c: c.shown == 100 and "/edges/accepted/loop/0" in c.nodes)


def test_what_a_running_job_finds_appears_while_it_runs(tmp_path):
    build_project(tmp_path / "office", with_map=False)
    folder = tmp_path / ".recon4" / "jobs" / "j1"
    folder.mkdir(parents=True)
    (folder / "request.json").write_text(json.dumps({"project": str(tmp_path / "office")}))
    (folder / "heartbeat").touch()
    job = EventWriter(folder)
    with server_thread(tmp_path) as server, viewing(server.url) as client:
        client.send(camera())
        job.event(StageChanged(stage="graph", state="running"))
        corner = ((0.0, 0.0, 0.0), (4.0, 0.0, 0.0), (4.0, 4.0, 0.0))
        job.event(NodesPlaced(t_ns=(1, 2, 3), t_m=corner))
        loop, accepted = EdgeKind.LOOP, Verdict.ACCEPTED
        job.event(
            EdgeTried(i=0, j=2, edge_kind=loop, verdict=accepted, reason=Reason.NONE, overlap=0.4)
        )
        client.until(lambda c: "/edges/accepted/loop/0" in c.nodes)

        judged = (0, 2, loop, Verdict.REJECTED, Reason.VERIFICATION)
        job.event(VerdictsChanged(edges=(judged,)))
        client.until(lambda c: "/edges/rejected/verification-median-limit/0" in c.nodes)

        assert "/edges/accepted/loop/0" not in client.nodes
    job.close()


def test_the_page_is_viser_with_our_repairs_and_a_policy(server):
    answer = server.get("/projects/office/viewer/")

    policy = answer.headers["content-security-policy"]
    assert SHIMS in answer.text
    assert 0 < answer.text.find("drawLessAtRest();") < answer.text.find(SHIMS)
    assert "map frame · z up · meters" in answer.text
    assert f"connect-src 'self' ws://{urlsplit(server.url).netloc} " in policy
    assert "frame-ancestors 'self'" in policy


@pytest.mark.parametrize("query", ["websocket=ws://evil.example", "playbackPath=http://evil", "x"])
def test_the_page_obeys_no_query(server, query):
    answer = server.get(f"/projects/office/viewer/?{query}")

    assert answer.status_code == 307
    assert answer.headers["location"] == "/projects/office/viewer/"


def rejected_edge():
    """Ends of an edge of the project that verification rejected [m]."""
    graph = verified_graph(loop_walk())
    edge = next(e for e in graph.edges if e.reason is Reason.VERIFICATION)
    return graph.T_map_body.t[edge.i], graph.T_map_body.t[edge.j]
