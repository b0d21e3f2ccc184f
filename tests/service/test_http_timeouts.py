"""Slow and endless senders: they are disconnected, and no other client waits for them."""

import contextlib
import socket
import time
from urllib.parse import urlsplit

import httpx
import pytest
from msgspec import structs

from recon4_app.network import http_timeouts
from tests.deadlines import BUSY_S
from tests.service.running import server_thread

SOON_S = 0.6


@pytest.fixture
def server(tmp_path, monkeypatch):
    """A server that is less patient, so that the test is short."""
    monkeypatch.setattr(
        http_timeouts,
        "HTTP_TIMEOUTS",
        structs.replace(http_timeouts.HTTP_TIMEOUTS, head_timeout_s=SOON_S),
    )
    monkeypatch.setattr(
        http_timeouts,
        "HTTP_TIMEOUTS",
        structs.replace(http_timeouts.HTTP_TIMEOUTS, body_window_s=SOON_S),
    )
    monkeypatch.setattr(
        http_timeouts,
        "HTTP_TIMEOUTS",
        structs.replace(http_timeouts.HTTP_TIMEOUTS, min_body_bytes=60_000),
    )
    with server_thread(tmp_path) as running:
        yield running


def opened(server):
    where = urlsplit(server.url)
    return socket.create_connection((where.hostname, where.port), timeout=10.0)


def rest_of(connection):
    """The response until the server disconnects."""
    received = b""
    with contextlib.suppress(ConnectionResetError):
        while piece := connection.recv(65536):
            received += piece
    return received


def head(method, path, *lines):
    return "\r\n".join([f"{method} {path} HTTP/1.1", "Host: 127.0.0.1", *lines, "", ""]).encode()


@pytest.mark.parametrize("begun", [b"", b"G", b"GET /healthz HTTP/1.1\r\nHost: 127.0.0.1\r\nX: "])
def test_a_head_that_does_not_end_is_not_waited_for(server, begun):
    with opened(server) as connection:
        connection.sendall(begun)
        began_s = time.monotonic()
        answer = rest_of(connection)

    assert answer.startswith(b"HTTP/1.1 408")
    assert SOON_S * 0.8 < time.monotonic() - began_s < SOON_S + BUSY_S


def test_a_byte_now_and_then_does_not_help(server):
    with opened(server) as connection, pytest.raises(OSError):  # noqa: PT011
        connection.sendall(b"GET /healthz HTTP/1.1\r\nX: ")
        for _ in range(100):
            time.sleep(0.1)  # that is how slow the sender is
            connection.sendall(b"x")


def test_the_second_request_of_a_connection_has_its_own_time(server):
    with opened(server) as connection:
        connection.sendall(head("GET", "/healthz"))
        first = b""
        while not first.endswith(b"}"):
            first += connection.recv(65536)
        connection.sendall(b"GET /healthz HTTP/1.1\r\n")
        answer = rest_of(connection)

    assert answer.startswith(b"HTTP/1.1 408")


def test_a_slow_body_is_hung_up_on(server):
    with opened(server) as connection:
        connection.sendall(head("POST", "/api/jobs", "Content-Length: 1000"))
        connection.sendall(b"{")
        began_s = time.monotonic()
        rest_of(connection)

    assert time.monotonic() - began_s < SOON_S + BUSY_S


def test_a_body_of_modest_speed_is_waited_for(server):
    body = b'{"project": "x"}' + b" " * 400_000
    with opened(server) as connection:
        connection.sendall(head("POST", "/api/jobs", f"Content-Length: {len(body)}"))
        for piece in range(0, len(body), 20_000):
            time.sleep(0.1)  # 200 kB/s, twice what is asked for
            connection.sendall(body[piece : piece + 20_000])
        answer = connection.recv(65536)

    assert answer.startswith(b"HTTP/1.1 422")


@pytest.mark.parametrize(
    "sent",
    [
        b"GET / HTTP/1.1\r\nX: " + b"x" * 200_000,
        b"GET /" + b"x" * 200_000,
        head("GET", "/", *(f"X-{k}: {'x' * 1000}" for k in range(100))),
    ],
)
def test_a_long_head_is_refused(server, sent):
    with opened(server) as connection:
        with contextlib.suppress(OSError):
            connection.sendall(sent)
        answer = rest_of(connection)

    assert answer == b"" or answer.split()[1] in (b"400", b"431")


@pytest.mark.parametrize("size", [60_000, 65_000, 66_000, 69_000, 75_000, 89_000, 120_000])
@pytest.mark.parametrize("in_one", [True, False])
def test_a_head_of_any_length_above_the_limit_gets_the_same_answer(server, size, in_one):
    sent = head("GET", "/healthz", f"X: {'x' * (size - 100)}")
    parts = [sent] if in_one else [sent[k : k + 1000] for k in range(0, len(sent), 1000)]
    with opened(server) as connection:
        with contextlib.suppress(OSError):
            for part in parts:
                connection.sendall(part)
        answer = connection.recv(100)

    assert answer.split()[1] == (b"200" if size < 1 << 16 else b"431")


def test_an_event_stream_may_be_quiet_for_longer(server):
    with httpx.stream("GET", f"{server.url}/api/events", timeout=2.0) as stream:
        with contextlib.suppress(httpx.ReadTimeout):
            for _ in stream.iter_raw():
                pass
        assert stream.status_code == 200


def test_200_slow_senders_do_not_hold_up_a_normal_request(tmp_path):
    with server_thread(tmp_path) as server, contextlib.ExitStack() as slow:
        for _ in range(200):
            connection = slow.enter_context(opened(server))
            connection.sendall(b"POST /api/jobs HTTP/1.1\r\nHost: 127.0.0.1\r\nX: ")
        with httpx.Client(base_url=server.url, timeout=BUSY_S) as client:
            answers = [client.get("/healthz").status_code for _ in range(100)]

    assert set(answers) == {200}
