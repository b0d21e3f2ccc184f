"""A real viser behind the proxy."""

import json
import os
import signal
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from urllib.parse import urlsplit

import msgspec.msgpack
import numpy as np
import psutil
import pytest
from viser import _messages
from websockets.exceptions import ConnectionClosed

from app.jobs.events import EventWriter
from app.viewer import proxy
from app.viewer.client.legend_html import count
from app.viewer.page import SHIMS
from app.viewer.proxy import Rate, allowed, passes
from recon4.model.events import EdgeTried, NodesPlaced, StageChanged, VerdictsChanged
from recon4.model.pose_graph import EdgeKind, Reason, Verdict
from tests.benchmarks.viewer_figures import PEOPLE, own_server
from tests.processes import command_of
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

    assert 'href="/projects/office/review/?edge=' in looking.html()
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


def test_a_request_for_a_public_tunnel_is_dropped_and_the_session_goes_on(server, caplog):
    with viewing(server.url) as client:
        client.send({"type": "ShareUrlRequest"})
        client.socket.send(b"\xc1 not a message")
        client.send(camera())
        client.until(lambda c: c.shown)

    assert "dropped a message of kind 'ShareUrlRequest'" in caplog.text


@pytest.mark.parametrize("may_review", [False, True])
def test_of_all_messages_viser_knows_only_looking_and_operating_pass(may_review):
    kinds = {kind.__name__ for kind in _messages.Message.get_subclasses()}

    passed = {kind for kind in kinds if allowed(kind, may_review)}

    assert len(kinds) > 100
    assert {"ViewerCameraMessage", "GuiUpdateMessage", "SceneNodeClickMessage"} <= passed
    assert ("TransformControlsUpdateMessage" in passed) == may_review
    assert not [kind for kind in passed if "Share" in kind or "Upload" in kind or "File" in kind]
    assert not [kind for kind in passed if "Javascript" in kind or "SetItem" in kind]
    assert not passed - kinds


@pytest.mark.parametrize(
    "data",
    [b"", b"\x00", b"\x90", msgspec.msgpack.encode({"type": ["ViewerCameraMessage"]})],
)
def test_what_is_no_message_does_not_pass(data):
    assert not passes(data, may_review=True)


def test_a_message_passes_up_to_64_kibibytes():
    def message(size):
        update = {"type": "GuiUpdateMessage", "uuid": "x", "updates": {"value": "x" * size}}
        return msgspec.msgpack.encode(update)

    assert passes(message(65_000), may_review=False)
    assert not passes(message(65_536), may_review=True)


def test_messages_are_read_no_faster_than_allowed():
    rate = Rate(100.0, 50)
    waits = [rate.wait_s(now_s=10.0) for _ in range(150)]

    assert waits[:50] == [0.0] * 50
    np.testing.assert_allclose(np.diff(waits[50:]), 0.01)
    assert rate.wait_s(now_s=12.0) == 0.0


def test_a_flood_of_messages_arrives_late_but_whole(server):
    with viewing(server.url) as client:
        client.send(camera())
        client.until(lambda c: c.shown == POINTS)
        for k in range(500):
            client.set("Point size", 0.005 + 0.005 * (k % 2))
        client.set("Point size", 0.2)

        waited_s = client.until(lambda c: '"point_size_m": 0.2' in str(c.storage))

    assert waited_s > 1.0


def test_a_viewer_above_the_limit_is_rejected_and_the_others_stay(root):
    with (
        server_thread(root, viewer_sockets=2) as server,
        viewing(server.url) as first,
        viewing(server.url) as second,
    ):
        with viewing(server.url) as third, pytest.raises(ConnectionClosed) as closed:
            third.socket.recv(timeout=10.0)
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


@pytest.fixture(scope="module")
def million(tmp_path_factory):
    """A folder of projects with one of a million points."""
    root = tmp_path_factory.mktemp("million")
    build_project(root / "office", points=1_000_000)
    return root


def test_the_last_of_twenty_people_has_a_map_of_a_million_points_within_8_s(million):
    busy = max(1.0, os.getloadavg()[0] / (os.cpu_count() or 1))  # others may use this computer

    def ask_for_all(client):
        client.send(camera((8.0, 3.0, 1.5)))
        client.until(lambda c: "Fewer when" in str(c.widgets), limit_s=60.0)
        client.set("Fewer when this browser is slow", False)

    def look(url):
        with viewing(url) as client:
            ask_for_all(client)
            client.until(
                lambda c: c.shown == whole and f"{count(whole)} of" in c.html(), limit_s=60.0
            )

    with own_server(million) as (server, _), ThreadPoolExecutor(PEOPLE) as people:
        with viewing(server.url) as first:  # the viewer process is there
            ask_for_all(first)
            first.rest(quiet_s=2.0)
            whole = first.shown
        began_s = time.monotonic()
        list(people.map(look, [server.url] * PEOPLE))
        took_s = time.monotonic() - began_s

    assert whole > 800_000
    assert took_s < 8.0 * busy


def test_a_browser_that_reads_nothing_is_disconnected_without_effect_on_others(
    million, monkeypatch, caplog
):
    monkeypatch.setattr(proxy, "STALLED_S", 1.0)
    with (
        server_thread(million) as server,
        viewing(server.url, buffer_bytes=1 << 16) as stalled,
        viewing(server.url) as other,
    ):
        for client in (stalled, other):
            client.send(camera((8.0, 3.0, 1.5)))
            client.until(lambda c: c.shown > 150_000 and "Palette" in str(c.widgets))
        stalled.set("Fewer when this browser is slow", False)  # a million points at once
        before = viewer_process(million).memory_info().rss
        for k in range(40):  # the first of them takes none of this
            stalled.set("Palette", ("turbo", "gray")[k % 2])
            other.press("Raw or normalized")
            words = f"Points by {('raw', 'normalized')[k % 2]} intensity"
            other.until(lambda c, words=words: words in c.html())
        grown = viewer_process(million).memory_info().rss - before
        deadline_s = time.monotonic() + 20.0
        while "read nothing" not in caplog.text and time.monotonic() < deadline_s:
            other.rest()

    assert "read nothing" in caplog.text
    assert grown < 64 << 20


def test_the_page_is_viser_with_our_repairs_and_a_policy(server):
    answer = server.get("/projects/office/viewer/")

    policy = answer.headers["content-security-policy"]
    assert SHIMS in answer.text
    assert "map frame · z up · meters" in answer.text
    assert f"connect-src 'self' ws://{urlsplit(server.url).netloc} " in policy
    assert "frame-ancestors 'self'" in policy


@pytest.mark.parametrize("query", ["websocket=ws://evil.example", "playbackPath=http://evil", "x"])
def test_the_page_obeys_no_query(server, query):
    answer = server.get(f"/projects/office/viewer/?{query}")

    assert answer.status_code == 307
    assert answer.headers["location"] == "/projects/office/viewer/"


def viewer_process(root):
    """The viewer of the project below a folder; there must be one only."""
    mine = [
        process
        for process in psutil.Process().children(recursive=True)
        if "app.viewer.process" in command_of(process)
        and str(root / "office") in command_of(process)
    ]
    assert len(mine) == 1
    return mine[0]


def rejected_edge():
    """Ends of an edge of the project that verification rejected [m]."""
    graph = verified_graph(loop_walk())
    edge = next(e for e in graph.edges if e.reason is Reason.VERIFICATION)
    return graph.T_map_body.t[edge.i], graph.T_map_body.t[edge.j]
