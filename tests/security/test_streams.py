"""Streams under attack: one viewer opens as many as there are.

Held: a viewer gets 8 live streams, 16 event streams; an operator still gets one of each kind
when viewers have taken all they can get.
"""

from __future__ import annotations

import contextlib
from types import SimpleNamespace

import pytest
from websockets.exceptions import ConnectionClosed

from recon4_app.access.people import LOCAL, Person, Role
from recon4_app.errors import TooMany
from recon4_app.network.streams import StreamLimits, Streams
from tests.deadlines import HANG_S
from tests.served import served
from tests.service.secure import secure_server

LIMITS = StreamLimits(max_streams=10, max_per_person=3, max_per_address=5, reserved_for_capture=2)


def connection(name, *, role=Role.VIEWER, address="10.0.0.1", who=None):
    who = who or Person(name, role)
    return SimpleNamespace(scope={"state": {"person": who}}, client=SimpleNamespace(host=address))


@pytest.fixture
def opened():
    """Opens places that stay open until the test ends."""
    with contextlib.ExitStack() as stack:
        yield lambda streams, one: stack.enter_context(streams.place(one))


def test_streams_are_limited_per_person_and_per_address(opened):
    streams = Streams("live streams", LIMITS)
    for _ in range(3):
        opened(streams, connection("vera"))
    with pytest.raises(TooMany, match="you have 3 live streams open"):
        opened(streams, connection("vera"))
    for _ in range(2):
        opened(streams, connection("viktor"))
    with pytest.raises(TooMany, match="your address has 5"):
        opened(streams, connection("vlad"))
    opened(streams, connection("vlad", address="10.0.0.2"))
    assert (streams.open, streams.refused) == (6, 2)


def test_an_ipv6_household_is_one_address(opened):
    streams = Streams("live streams", LIMITS)
    for k in range(5):
        opened(streams, connection(f"v{k}", address=f"2001:db8::{k}"))
    with pytest.raises(TooMany, match="your address"):
        opened(streams, connection("v6", address="2001:db8::ffff"))


def test_whoever_runs_a_capture_finds_a_place_when_viewers_took_all(opened):
    streams = Streams("live streams", LIMITS)
    for k in range(8):
        opened(streams, connection(f"v{k}", address=f"10.0.0.{k}"))
    with pytest.raises(TooMany, match="the limit is 8"):
        opened(streams, connection("v9", address="10.0.0.9"))
    opened(streams, connection("otto", role=Role.OPERATOR, address="10.0.0.1"))
    opened(streams, connection("anna", role=Role.ADMIN, address="10.0.0.1"))
    with pytest.raises(TooMany, match="the limit is 10"):
        opened(streams, connection("olga", role=Role.OPERATOR))


def test_a_place_that_is_left_is_free_again():
    streams = Streams("live streams", LIMITS)
    for _ in range(50):
        with streams.place(connection("vera")):
            pass
    assert streams.open == 0
    assert not streams._people
    assert not streams._addresses


def test_without_login_only_the_total_counts(opened):
    streams = Streams("live streams", LIMITS)
    for _ in range(10):
        opened(streams, connection("local", who=LOCAL))
    with pytest.raises(TooMany):
        opened(streams, connection("local", who=LOCAL))


server = served(run=secure_server)


def test_a_viewer_with_live_streams_does_not_lock_the_operator_out(server):
    with (
        server.signed_in("vera") as vera,
        server.signed_in("otto") as otto,
        contextlib.ExitStack() as stack,
    ):
        for _ in range(8):
            live = stack.enter_context(server.websocket("/api/live/stream", vera))
            live.send('{"have": {}}')
            assert '"none"' in live.recv(timeout=HANG_S)
        ninth = stack.enter_context(server.websocket("/api/live/stream", vera))
        with pytest.raises(ConnectionClosed) as closed:
            ninth.recv(timeout=HANG_S)
        assert closed.value.rcvd.code == 4429
        assert closed.value.rcvd.reason == "you have 8 live streams open: close one and try again"
        operator = stack.enter_context(server.websocket("/api/live/stream", otto))
        operator.send('{"have": {}}')
        assert '"none"' in operator.recv(timeout=HANG_S)


def test_event_streams_of_a_person_are_bounded_and_come_free(server):
    with server.signed_in("vera") as vera, server.signed_in("otto") as otto:
        for _ in range(2):
            with contextlib.ExitStack() as stack:
                for _ in range(16):
                    answer = stack.enter_context(vera.stream("GET", "/api/events"))
                    assert answer.status_code == 200
                one_more = vera.get("/api/events")
                assert one_more.status_code == 429
                assert one_more.headers["Retry-After"] == "10"
                assert "you have 16 event streams open" in one_more.json()["detail"]
                with otto.stream("GET", "/api/events") as other:
                    assert other.status_code == 200
            parts = server.running.app.state.parts
            for _ in range(200):
                if not parts.event_streams.open:
                    break
                vera.get("/healthz")
            assert parts.event_streams.open == 0
