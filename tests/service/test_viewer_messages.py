"""Messages from a browser to viser: which pass, how large and how many."""

import msgspec.msgpack
import numpy as np
import pytest
from viser import _messages

from app.viewer.proxy import Rate, allowed, passes
from tests.project_builder import build_project
from tests.service.running import server_thread
from tests.service.viser_client import camera, viewing

POINTS = 60_000


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    root = tmp_path_factory.mktemp("projects")
    build_project(root / "office", points=POINTS)
    with server_thread(root) as running:
        yield running


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
