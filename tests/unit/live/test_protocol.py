"""Messages of a live capture: what is encoded is decoded again, and malformed lines are refused."""

import asyncio
import json

import numpy as np
import pytest

from recon4.live import protocol
from recon4.live.ipc.line_client import LineClient
from recon4.live.ipc.messages import gaps_message, plan_message, points_message
from recon4.live.newest_messages import Newest
from recon4.live.preview.cloud import PreviewCloud
from recon4.live.preview.coverage import Coverage
from recon4.model.finding_kinds import FindingKind
from recon4.recording.report import warning
from tests import live_messages


def coverage():
    seen = Coverage()
    for k in range(40):
        rays = np.array([[np.cos(a), np.sin(a), 0.0] for a in np.arange(0, 4, 0.01)])
        seen.add(np.array([0.1 * k, 0.0, 1.0]), 3.0 * rays)
    seen.refresh()
    return seen


def points():
    xyz = np.random.default_rng(0).normal(size=(50, 3))
    return points_message(PreviewCloud().add(xyz, np.arange(50, dtype=np.uint8)))


MESSAGES = [
    protocol.Written(9),
    live_messages.status(live_messages.sender(2368)),
    protocol.Stopped(why="stopped", **protocol.fields_of(live_messages.status())),
    protocol.Mark(1, "point", "crack", "Eva"),
    live_messages.pose(error_m=None),
    protocol.Path([[0.0, 0.0, 1.0]]),
    points(),
    plan_message(coverage()),
    gaps_message(coverage()),
    protocol.Loop(near=True, closed=False),
    live_messages.fix(sd_m=[0.1, 0.1, 0.2]),
    live_messages.notes(
        findings=[warning(FindingKind.CLOCK_FREE, sensor="a", ahead_s=1.5)], counts={"packets": 9}
    ),
    protocol.Done(frames=3, problem=""),
]
REQUESTS = [
    protocol.Stop(),
    protocol.Pause(),
    protocol.Resume(),
    protocol.AddMark("point", "crack", "Eva", 2.0),
]


@pytest.mark.parametrize("message", MESSAGES, ids=protocol.kind_of)
def test_a_message_is_one_json_line_with_its_kind(message):
    line = protocol.encode(message)

    assert line.endswith(b"\n") and line.count(b"\n") == 1
    assert json.loads(line)["kind"] == protocol.kind_of(message)
    assert protocol.encode(protocol.decode_message(line)) == line


@pytest.mark.parametrize("request_", REQUESTS, ids=lambda one: type(one).__name__)
def test_a_request_is_one_json_line(request_):
    assert protocol.decode_request(protocol.encode(request_)) == request_


@pytest.mark.parametrize(
    ("line", "text"),
    [
        (b"\xff\x00\n", "not a message of a live capture: "),
        (b"[1, 2]\n", "Expected `object`, got `array`"),
        (b'{"do": "dance"}\n', "Invalid value 'dance' - at `$.do`"),
        (b'{"do": "mark"}\n', "missing required field `what`"),
        (b'{"do": "mark", "what": "point", "ago_s": -1}\n', ">= 0.0 - at `$.ago_s`"),
        (b'{"do": "mark", "what": "point", "text": "%s"}\n' % (b"x" * 4001), "length <= 4000"),
        (b"[" * 50_000, "not a message of a live capture: "),
    ],
)
def test_a_malformed_request_is_refused_with_field_and_reason(line, text):
    with pytest.raises(protocol.ProtocolError) as refused:
        protocol.decode_request(line)

    assert text in str(refused.value)
    assert len(str(refused.value)) < 400


def test_fields_of_a_newer_version_are_ignored():
    line = b'{"kind": "written", "bytes": 3, "blocks": 1}'

    assert protocol.decode_message(line) == protocol.Written(3)


def test_a_client_skips_malformed_messages(caplog):
    async def read():
        reader = asyncio.StreamReader()
        done = protocol.Done(frames=3, problem="")
        reader.feed_data(b'{"kind": "dance"}\n' + protocol.encode(done))
        reader.feed_eof()
        return [message async for message in LineClient(reader, None).messages()]

    assert asyncio.run(read()) == [protocol.Done(frames=3, problem="")]
    assert "Invalid value 'dance'" in caplog.text


def test_newest_keeps_the_last_message_of_each_kind():
    newest = Newest()

    kept = [newest.take(message) for message in MESSAGES]

    assert kept.count(False) == 4
    assert newest.status is MESSAGES[1] and newest.done is MESSAGES[-1]
