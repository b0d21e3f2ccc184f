"""A real viser behind the proxy."""

import os
import signal
from urllib.parse import urlsplit

import msgspec.msgpack
import psutil
import pytest
import viser
import zstandard
from viser import _messages
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect
from websockets.typing import Subprotocol

from app.viewer.page import SHIMS
from app.viewer.proxy import allowed
from tests.project_builder import build_project
from tests.service.running import server_thread

PROTOCOL = Subprotocol(f"viser-v{viser.__version__}")


@pytest.fixture(scope="module")
def root(tmp_path_factory):
    root = tmp_path_factory.mktemp("projects")
    build_project(root / "office", points=5000)
    return root


@pytest.fixture(scope="module")
def server(root):
    with server_thread(root) as running:
        yield running


def open_viewer(server):
    return connect(
        f"ws://{urlsplit(server.url).netloc}/projects/office/viewer",
        origin=server.url,
        subprotocols=[PROTOCOL],
        compression=None,
        max_size=None,
        proxy=None,
    )


def camera():
    return msgspec.msgpack.encode(
        {
            "type": "ViewerCameraMessage",
            "wxyz": (1.0, 0.0, 0.0, 0.0),
            "position": (1.0, 1.0, 1.0),
            "fov": 1.0,
            "near": 0.01,
            "far": 1000.0,
            "image_height": 900,
            "image_width": 1440,
            "look_at": (0.0, 0.0, 0.0),
            "up_direction": (0.0, 0.0, 1.0),
        }
    )


def until(socket, *texts):
    """What viser sent, unpacked, up to the message after which all the texts have been seen."""
    received = b""
    while not all(text in received for text in texts):
        message = socket.recv(timeout=30.0)
        packed = int.from_bytes(message[8:16], "little")
        received += zstandard.ZstdDecompressor().decompress(message[16 : 16 + packed])
    return received


def test_a_browser_gets_the_map_the_trajectory_and_the_edges_by_verdict(server):
    with open_viewer(server) as socket:
        socket.send(camera())
        seen = until(socket, b"PointCloudMessage", b"/grid", b"Points by normalized intensity")

    assert b"/map/0_0_0" in seen
    assert b"/trajectory" in seen
    assert b"/edges/accepted/loop" in seen
    assert b"/edges/unverified/loop" in seen
    assert b"/edges/rejected/verification-median-limit" in seen
    assert b"5\xe2\x80\xaf000 of 5\xe2\x80\xaf000 points" in seen


def test_asking_for_a_public_tunnel_reaches_nobody_and_the_session_goes_on(server, caplog):
    with open_viewer(server) as socket:
        socket.send(msgspec.msgpack.encode({"type": "ShareUrlRequest"}))
        socket.send(b"\xc1 not a message")
        socket.send(camera())
        seen = until(socket, b"PointCloudMessage")

    assert b"ShareUrlUpdated" not in seen
    assert "dropped a message of kind 'ShareUrlRequest'" in caplog.text


def test_of_all_messages_viser_knows_only_looking_and_operating_pass():
    kinds = {kind.__name__ for kind in _messages.Message.get_subclasses()}

    passed = {kind for kind in kinds if allowed(msgspec.msgpack.encode({"type": kind}))}

    assert len(kinds) > 100
    assert {"ViewerCameraMessage", "GuiUpdateMessage", "SceneNodeClickMessage"} <= passed
    assert not [kind for kind in passed if "Share" in kind or "Upload" in kind or "File" in kind]
    assert not [kind for kind in passed if "Javascript" in kind or "LocalStorage" in kind]


@pytest.mark.parametrize(
    "data",
    [b"", b"\x00", b"\x90", msgspec.msgpack.encode({"type": ["ViewerCameraMessage"]})],
)
def test_what_is_no_message_does_not_pass(data):
    assert not allowed(data)


def test_a_long_message_does_not_pass():
    message = {"type": "GuiUpdateMessage", "uuid": "x", "updates": {"value": "x" * 100_000}}

    assert not allowed(msgspec.msgpack.encode(message))


def test_the_viewer_listens_on_loopback_only(server, root):
    with open_viewer(server) as socket:
        socket.send(camera())
        until(socket, b"PointCloudMessage")
        listening = [
            connection.laddr.ip
            for connection in viewer_process(root).net_connections("inet")
            if connection.status == psutil.CONN_LISTEN
        ]

    assert listening == ["127.0.0.1"]


def test_a_killed_viewer_is_started_again_for_the_next_connection(server, root):
    with open_viewer(server) as socket:
        socket.send(camera())
        until(socket, b"PointCloudMessage")
        os.kill(viewer_process(root).pid, signal.SIGKILL)
        with pytest.raises(ConnectionClosed):
            until(socket, b"never sent")

    with open_viewer(server) as socket:
        socket.send(camera())
        assert b"/map/0_0_0" in until(socket, b"PointCloudMessage")


def test_a_viewer_ends_with_its_server(tmp_path):
    build_project(tmp_path / "office", points=100)
    with server_thread(tmp_path) as server:
        with open_viewer(server) as socket:
            socket.send(camera())
            until(socket, b"PointCloudMessage")
        viewer = viewer_process(tmp_path)

    assert not viewer.is_running()


def test_a_viewer_nobody_looks_at_ends_by_itself(tmp_path):
    build_project(tmp_path / "office", points=100)
    with server_thread(tmp_path, viewer_idle_s=0.5) as server:
        with open_viewer(server) as socket:
            socket.send(camera())
            until(socket, b"PointCloudMessage")
            viewer = viewer_process(tmp_path)

        viewer.wait(timeout=20.0)


def test_new_artifacts_appear_while_one_looks(tmp_path):
    build_project(tmp_path / "office", with_map=False)
    with server_thread(tmp_path) as server, open_viewer(server) as socket:
        socket.send(camera())
        before = until(socket, b"/trajectory", b"/grid")

        build_project(tmp_path / "office", points=100)
        after = until(socket, b"/map/0_0_0", b"/edges/accepted/loop")

    assert b"/map" not in before
    assert b"PointCloudMessage" in after


def test_the_page_is_viser_with_our_repairs_and_a_policy(server):
    answer = server.get("/projects/office/viewer/")

    policy = answer.headers["content-security-policy"]
    assert SHIMS in answer.text
    assert "map frame · z up · metres" in answer.text
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
        if "app.viewer.process" in process.cmdline() and str(root / "office") in process.cmdline()
    ]
    assert len(mine) == 1
    return mine[0]
