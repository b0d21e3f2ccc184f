"""Clients that send or read slowly or not at all: each ends at its deadline."""

import base64
import os
import socket
import time
from urllib.parse import urlsplit

import pytest
from msgspec import structs

from recon4_app.network import accept, http_timeouts, listen, slow_readers
from tests.deadlines import BUSY_S
from tests.project_builder import build_project
from tests.security.raw_clients import SOON_S, connect, counts_of, head, lasts_s
from tests.service.running import server_thread, wait_for


@pytest.fixture
def hurried(tmp_path, monkeypatch):
    """A server without TLS and with shorter deadlines."""
    monkeypatch.setattr(
        http_timeouts,
        "HTTP_TIMEOUTS",
        structs.replace(http_timeouts.HTTP_TIMEOUTS, body_window_s=SOON_S),
    )
    monkeypatch.setattr(
        slow_readers,
        "SLOW_READERS",
        structs.replace(slow_readers.SLOW_READERS, read_window_s=SOON_S),
    )
    monkeypatch.setattr(accept, "ACCEPT", structs.replace(accept.ACCEPT, sweep_s=0.1))
    monkeypatch.setattr(listen, "PINGS", structs.replace(listen.PINGS, ping_interval_s=SOON_S))
    monkeypatch.setattr(listen, "PINGS", structs.replace(listen.PINGS, ping_timeout_s=SOON_S))
    build_project(tmp_path / "office", points=1000)
    with server_thread(tmp_path) as running:
        yield running


@pytest.mark.parametrize("upgrade", ["websocket", "h2c"])
def test_an_upgrade_that_is_none_ends(hurried, upgrade):
    """uvicorn kept a WebSocket's handshake by POST forever."""
    lines = ["Connection: Upgrade", f"Upgrade: {upgrade}", "Content-Length: 5"]
    with connect(hurried.url) as connection:
        connection.sendall(head("POST", "/api/jobs", *lines))
        assert lasts_s(connection) < http_timeouts.HTTP_TIMEOUTS.keep_alive_s + BUSY_S


def test_a_body_nobody_wants_is_not_read_forever(hurried):
    """The answer came before the body; before, bytes at the least rate kept the connection."""
    with connect(hurried.url) as connection:
        connection.sendall(head("POST", "/nothing-here", "Content-Length: 1000000000000"))
        began_s = time.monotonic()
        with pytest.raises(OSError):  # noqa: PT011
            while time.monotonic() - began_s < 60.0:
                connection.sendall(bytes(1 << 16))
                time.sleep(0.002)  # 32 MB/s, more than the least rate
        assert time.monotonic() - began_s < SOON_S + BUSY_S


def test_an_idle_connection_ends_after_its_answer_and_after_a_late_body(hurried, monkeypatch):
    monkeypatch.setattr(
        http_timeouts,
        "HTTP_TIMEOUTS",
        structs.replace(http_timeouts.HTTP_TIMEOUTS, body_window_s=30.0),
    )
    with connect(hurried.url) as connection:
        connection.sendall(head("POST", "/nothing-here", "Content-Length: 2"))
        assert connection.recv(1 << 16).startswith(b"HTTP/1.1 404")
        connection.sendall(b"{}")
        assert 4.0 < lasts_s(connection) < http_timeouts.HTTP_TIMEOUTS.keep_alive_s + BUSY_S


def test_a_client_that_does_not_read_its_download_is_disconnected(hurried):
    big = hurried.root / "office" / "trajectory.tum"
    with big.open("r+b") as file:
        file.truncate(200 << 20)
    with slow_client(hurried.url) as connection:
        connection.sendall(head("GET", "/api/projects/office/files/trajectory.tum"))
        wait_for(
            lambda: counts_of(hurried).timeouts["response"] == 1,
            "it is given up",
            max_s=10.0 + BUSY_S,
        )
        wait_for(lambda: len(hurried.app.state.connections) == 0, "its socket is closed")


def slow_client(url):
    """A connection that buffers little, so that it stalls as soon as it does not read."""
    where = urlsplit(url)
    connection = socket.socket()
    connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    connection.settimeout(10.0)
    connection.connect((where.hostname, where.port))
    return connection


def test_a_client_that_reads_slowly_is_served(hurried, monkeypatch):
    """Twice the least rate, over several windows."""
    monkeypatch.setattr(
        slow_readers,
        "SLOW_READERS",
        structs.replace(slow_readers.SLOW_READERS, min_read_bytes=30_000),
    )
    big = hurried.root / "office" / "trajectory.tum"
    with big.open("r+b") as file:
        file.truncate(20 << 20)
    with slow_client(hurried.url) as connection:
        connection.sendall(head("GET", "/api/projects/office/files/trajectory.tum"))
        deadline_s = time.monotonic() + 5 * SOON_S
        while time.monotonic() < deadline_s:
            assert connection.recv(4096)
            time.sleep(0.03)

    assert counts_of(hurried).timeouts["response"] == 0


def websocket(url, path, *, buffered=slow_client):
    """A WebSocket whose client speaks no more after the handshake."""
    connection = buffered(url)
    key = base64.b64encode(os.urandom(16)).decode()
    lines = ["Connection: Upgrade", "Upgrade: websocket", f"Sec-WebSocket-Key: {key}"]
    origin = f"Host: {urlsplit(url).netloc}"
    request = head("GET", path, *lines, "Sec-WebSocket-Version: 13", f"Origin: {url}")
    connection.sendall(request.replace(b"Host: 127.0.0.1", origin.encode()))
    assert connection.recv(4096).startswith(b"HTTP/1.1 101")
    return connection


def test_a_websocket_that_answers_no_ping_ends(hurried):
    with websocket(hurried.url, "/api/live/stream") as connection:
        assert lasts_s(connection) < 2 * SOON_S + BUSY_S
    wait_for(lambda: len(hurried.app.state.connections) == 0, "it is forgotten")
