"""Messages from a browser to viser: which pass, how large and how many."""

from dataclasses import fields

import msgspec.msgpack
import numpy as np
import pytest
from viser import _messages

from recon4_app.viewer.browser_messages import KINDS, RefusedMessage, checked
from recon4_app.viewer.proxy import Rate
from tests.served import office, served
from tests.service.viser_client import camera, viewing

POINTS = 60_000


server = served(office(points=POINTS))


def test_a_request_for_a_public_tunnel_is_dropped_and_the_session_goes_on(server, caplog):
    with viewing(server.url) as client:
        client.send({"type": "ShareUrlRequest"})
        client.socket.send(b"\xc1 not a message")
        client.send(camera())
        client.until(lambda c: c.shown)

    assert "dropped a message from a browser: \"Invalid value 'ShareUrlRequest'" in caplog.text


def test_of_all_messages_viser_knows_only_looking_and_operating_pass():
    kinds = {kind.__name__ for kind in _messages.Message.get_subclasses()}

    passed = {kind.__struct_config__.tag for kind in KINDS}

    assert len(kinds) > 100
    assert passed < kinds
    assert not [kind for kind in passed if "Share" in kind or "Upload" in kind or "File" in kind]
    for kind in kinds - passed:
        with pytest.raises(RefusedMessage, match="Invalid value"):
            checked(msgspec.msgpack.encode({"type": kind}))


@pytest.mark.parametrize("kind", KINDS)
def test_what_passes_has_the_fields_that_viser_knows(kind):
    tag = kind.__struct_config__.tag
    theirs = next(one for one in _messages.Message.get_subclasses() if one.__name__ == tag)

    assert {field.name for field in fields(theirs)} == set(kind.__struct_fields__)


def test_what_passes_reaches_viser_as_it_was():
    for message in (
        camera((8.0, 3.0, 1.5)),
        {"type": "CommandTriggerMessage", "uuid": "a"},
        {"type": "GuiUpdateMessage", "uuid": "a", "updates": {"value": 5}},
    ):
        passed = msgspec.msgpack.decode(checked(msgspec.msgpack.encode(message)))

        assert passed == msgspec.msgpack.decode(msgspec.msgpack.encode(message))


def test_a_message_passes_up_to_64_kibibytes():
    def message(size):
        update = {"type": "GuiUpdateMessage", "uuid": "x", "updates": {"value": "x" * size}}
        return msgspec.msgpack.encode(update)

    assert checked(message(65_000))
    with pytest.raises(RefusedMessage, match="expected at most 65536 bytes, got"):
        checked(message(65_536))


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
