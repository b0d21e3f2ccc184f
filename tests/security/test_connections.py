"""Connections that cost the attacker nothing: silent, slow, endless. All other clients are served.

Held: with 2 000 mute connections, from one address or from 2 000, a new connection is answered
within 0.5 s (99th percentile), and as many connections are open as the limits say. Each kind of
slow client ends at its deadline. Repeated attempts grow the log by a bounded number of lines.
"""

import base64
import contextlib
import os
import re
import resource
import select
import socket
import ssl
import subprocess
import sys
import time
from pathlib import Path
from urllib.parse import urlsplit

import httpx
import numpy as np
import pytest
from prometheus_client.parser import text_string_to_metric_families

from app.network import accept, http_timeouts, listen, slow_readers
from app.network.connections import open_file_limit, raise_file_limit
from tests.deadlines import BUSY_S
from tests.project_builder import build_project
from tests.service.running import ROOT, server_thread, wait_for
from tests.service.secure import secure_server

MUTE = 2000
P99_S = 0.5
SOON_S = 0.8
LOG_GROWTH_BYTES = 100_000
TRUSTING = ssl._create_unverified_context()


@pytest.fixture(scope="module", autouse=True)
def many_files():
    """This process holds the attacker's ends of the connections, too."""
    before = resource.getrlimit(resource.RLIMIT_NOFILE)
    raise_file_limit()
    assert open_file_limit() > 2 * MUTE, "the hard limit of open files is too low for this test"
    yield
    resource.setrlimit(resource.RLIMIT_NOFILE, before)


@pytest.fixture(params=["http", "https"])
def server(request, tmp_path):
    opened = server_thread(tmp_path, lan=request.param == "https")
    with opened as running:
        yield running


def connect(url, *, source="127.0.0.1", tls=None):
    """A TCP connection, or one with TLS."""
    where = urlsplit(url)
    connection = socket.create_connection(
        (where.hostname, where.port), timeout=10.0, source_address=(source, 0)
    )
    tls = where.scheme == "https" if tls is None else tls
    return TRUSTING.wrap_socket(connection) if tls else connection


@contextlib.contextmanager
def mute(url, count, source_of):
    """A number of connections that send nothing."""
    with contextlib.ExitStack() as held:
        for number in range(count):
            held.enter_context(connect(url, source=source_of(number), tls=False))
        yield


def one_address(number):
    return "127.0.0.1"


def an_address_each(number):
    return f"127.1.{number // 250}.{number % 250 + 1}"


def head(method, path, *lines):
    return "\r\n".join([f"{method} {path} HTTP/1.1", "Host: 127.0.0.1", *lines, "", ""]).encode()


def ask(url, source="127.0.0.1"):
    """How long a request on a new connection takes [s]."""
    began_s = time.perf_counter()
    with connect(url, source=source) as connection:
        connection.sendall(head("GET", "/healthz", "Connection: close"))
        assert rest_of(connection).startswith(b"HTTP/1.1 200")
    return time.perf_counter() - began_s


def rest_of(connection):
    """What the server sends until it closes the connection."""
    received = b""
    with contextlib.suppress(ConnectionResetError, ssl.SSLEOFError, BrokenPipeError):
        while piece := connection.recv(1 << 16):
            received += piece
    return received


def counts_of(server):
    return server.app.state.connections.counts


@pytest.mark.parametrize("source_of", [one_address, an_address_each])
def test_2000_mute_connections_hold_up_nobody(server, source_of):
    table = server.app.state.connections
    with mute(server.url, MUTE, source_of):
        wait_for(lambda: table.counts.accepted >= MUTE, "the server has taken them all")
        times_s = [
            ask(server.url, source) for _ in range(60) for source in ("127.0.0.1", "127.0.0.2")
        ]
        held = len(table)

    assert np.percentile(times_s, 99) < P99_S
    most = table.limits.per_address if source_of is one_address else table.limits.total
    assert most - 5 <= held <= most + 5, "the limit holds, and room is used up to it"
    assert table.counts.evicted["waiting"] >= MUTE - most
    wait_for(lambda: len(table) == 0, "connections the clients closed are forgotten", max_s=20.0)


def test_many_mute_connections_to_a_process_with_few_files_grow_no_log(tmp_path):
    """256 file descriptors: 300 connections once locked all clients out for 63 s, log +204 MB."""
    log = tmp_path / "stderr.txt"
    (tmp_path / "root").mkdir()
    code = (
        "import resource; resource.setrlimit(resource.RLIMIT_NOFILE, (256, 256));"
        "from recon4.cli.main import main; main()"
    )
    with log.open("wb") as stderr, socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
        free.close()
        started = subprocess.Popen(
            [sys.executable, "-c", code, "serve", str(tmp_path / "root"),
             "--lan", "--host", "127.0.0.1", "--port", str(port)],
            cwd=ROOT, stdout=subprocess.DEVNULL, stderr=stderr,
        )  # fmt: skip
    url = f"https://127.0.0.1:{port}"
    try:
        wait_for(lambda: answers(url), "the server starts")
        before = log.stat().st_size
        with mute(url, 300, one_address):
            times_s = [ask(url) for _ in range(50)]
    finally:
        started.terminate()
        started.wait()

    assert np.percentile(times_s, 99) < P99_S
    assert log.stat().st_size - before < LOG_GROWTH_BYTES


def answers(url):
    try:
        return ask(url)
    except OSError:
        return None


EXHAUSTED = """
import asyncio, os, resource, socket, sys
from app.network.accept import Acceptor
from app.network.connections import ConnectionLimits, ConnectionTable, Phase

class Greeting(asyncio.Protocol):
    def __init__(self, connection):
        self.connection = connection

    def connection_made(self, transport):
        table.move(self.connection, Phase.ACTIVE)
        transport.write(b"hello")

table = ConnectionTable(ConnectionLimits(total=1000, per_address=1000))

async def main():
    listener = socket.create_server(("127.0.0.1", 0))
    acceptor = Acceptor(listener, table, protocol=Greeting, context=None)
    acceptor.start()
    spare = [os.open("/dev/null", os.O_RDONLY)]
    most = max(map(int, os.listdir("/proc/self/fd"))) + 1
    resource.setrlimit(resource.RLIMIT_NOFILE, (most, most))
    print(listener.getsockname()[1], flush=True)
    reader = asyncio.get_running_loop()
    await reader.run_in_executor(None, sys.stdin.readline)
    used_s = sum(os.times()[:2])
    print(table.counts.accept_errors["EMFILE"], used_s, flush=True)
    for one in spare:
        os.close(one)
    await reader.run_in_executor(None, sys.stdin.readline)

asyncio.run(main())
"""


def test_without_file_descriptors_accept_pauses_and_goes_on_when_there_are_some():
    with subprocess.Popen(
        [sys.executable, "-c", EXHAUSTED], cwd=ROOT, text=True,
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
    ) as process, contextlib.ExitStack() as held:  # fmt: skip
        port = int(process.stdout.readline())
        before_s = processor_s(process.pid)
        clients = [
            held.enter_context(socket.create_connection(("127.0.0.1", port), timeout=10.0))
            for _ in range(20)
        ]
        began_s = time.monotonic()
        time.sleep(2.0)  # as long as a busy loop would have to show itself
        elapsed_s = time.monotonic() - began_s
        used_s = processor_s(process.pid) - before_s
        served = greeted(clients)
        process.stdin.write("\n")
        process.stdin.flush()
        errors = int(process.stdout.readline().split()[0])
        wait_for(lambda: greeted(clients) == served + 1, "served as soon as there is a descriptor")
        _, said = process.communicate("\n", timeout=10.0)

    assert 1 <= errors <= 2 + elapsed_s / accept.ACCEPT_PAUSE_S
    assert used_s < 0.5
    assert "Traceback" not in said
    assert "out of system resource" not in said


def greeted(clients):
    """How many clients were served."""
    return len(select.select(clients, [], [], 0.0)[0])


def processor_s(pid):
    """Processor time a process has used [s]."""
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


@pytest.fixture
def secure(tmp_path, monkeypatch):
    """A server with TLS and shorter deadlines."""
    monkeypatch.setattr(accept, "HANDSHAKE_TIMEOUT_S", SOON_S)
    monkeypatch.setattr(http_timeouts, "HEAD_TIMEOUT_S", SOON_S)
    with secure_server(tmp_path) as running:
        yield running


def lasts_s(connection):
    """How long the server keeps a connection [s]."""
    began_s = time.monotonic()
    rest_of(connection)
    return time.monotonic() - began_s


def client_hello():
    """The first bytes a TLS client sends."""
    outgoing = ssl.MemoryBIO()
    client = TRUSTING.wrap_bio(ssl.MemoryBIO(), outgoing)
    with contextlib.suppress(ssl.SSLWantReadError):
        client.do_handshake()
    return outgoing.read()


@pytest.mark.parametrize("sent", [b"", b"\x16", client_hello()[:-1], client_hello()])
def test_a_tls_handshake_that_does_not_go_on_ends(secure, sent):
    with connect(secure.url, tls=False) as connection:
        connection.sendall(sent)
        assert SOON_S * 0.8 < lasts_s(connection) < SOON_S + BUSY_S
    wait_for(lambda: counts_of(secure.running).timeouts["handshake"] == 1, "it is counted")
    wait_for(lambda: len(secure.running.app.state.connections) == 0, "it is forgotten")


def test_a_tls_handshake_of_single_bytes_ends(secure):
    with connect(secure.url, tls=False) as connection, pytest.raises(OSError):  # noqa: PT011
        for byte in client_hello():
            connection.sendall(bytes([byte]))
            time.sleep(0.05)  # that is how slow the sender is


@pytest.mark.parametrize("sent", [b"GET / HTTP/1.1\r\n\r\n", b"\x00" * 100, b"SSH-2.0-x\r\n"])
def test_what_is_not_tls_is_closed_at_once(secure, sent):
    with connect(secure.url, tls=False) as connection:
        connection.sendall(sent)
        assert lasts_s(connection) < SOON_S * 0.8
    assert counts_of(secure.running).rejected["not_tls"] == 1


def test_a_mute_client_after_the_handshake_ends(secure):
    with connect(secure.url) as connection:
        assert lasts_s(connection) < SOON_S + BUSY_S
    wait_for(lambda: counts_of(secure.running).timeouts["head"] == 1, "it is counted")


@pytest.fixture
def hurried(tmp_path, monkeypatch):
    """A server without TLS and with shorter deadlines."""
    monkeypatch.setattr(http_timeouts, "BODY_WINDOW_S", SOON_S)
    monkeypatch.setattr(slow_readers, "READ_WINDOW_S", SOON_S)
    monkeypatch.setattr(accept, "SWEEP_S", 0.1)
    monkeypatch.setattr(listen, "PING_INTERVAL_S", SOON_S)
    monkeypatch.setattr(listen, "PING_TIMEOUT_S", SOON_S)
    build_project(tmp_path / "office", points=1000)
    with server_thread(tmp_path) as running:
        yield running


@pytest.mark.parametrize("upgrade", ["websocket", "h2c"])
def test_an_upgrade_that_is_none_ends(hurried, upgrade):
    """uvicorn kept a WebSocket's handshake by POST forever."""
    lines = ["Connection: Upgrade", f"Upgrade: {upgrade}", "Content-Length: 5"]
    with connect(hurried.url) as connection:
        connection.sendall(head("POST", "/api/jobs", *lines))
        assert lasts_s(connection) < http_timeouts.KEEP_ALIVE_S + BUSY_S


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
    monkeypatch.setattr(http_timeouts, "BODY_WINDOW_S", 30.0)
    with connect(hurried.url) as connection:
        connection.sendall(head("POST", "/nothing-here", "Content-Length: 2"))
        assert connection.recv(1 << 16).startswith(b"HTTP/1.1 404")
        connection.sendall(b"{}")
        assert 4.0 < lasts_s(connection) < http_timeouts.KEEP_ALIVE_S + BUSY_S


def test_a_client_that_does_not_read_its_download_is_disconnected(hurried):
    big = hurried.root / "office" / "trajectory.tum"
    with big.open("r+b") as file:
        file.truncate(200 << 20)
    with slow_client(hurried.url) as connection:
        connection.sendall(head("GET", "/api/projects/office/files/trajectory.tum"))
        wait_for(lambda: counts_of(hurried).timeouts["response"] == 1, "it is given up", max_s=10.0)
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
    monkeypatch.setattr(slow_readers, "MIN_READ_BYTES", 30_000)
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


def test_malformed_requests_grow_the_log_by_a_bounded_number_of_lines(tmp_path):
    root = tmp_path / "root"
    root.mkdir()
    stderr = tmp_path / "stderr.txt"
    with stderr.open("wb") as output, serving(root, output) as url:
        for number in range(300):
            with connect(url) as connection:
                connection.sendall(b"\x1b[2J \xe2\x80\xae nonsense %d\r\n\r\n" % number)
                rest_of(connection)
        rejected = metric(url, 'recon4_connections_rejected_total{reason="malformed"}')
        dropped = metric(url, "recon4_log_records_suppressed_total")
    log = root / ".recon4" / "logs" / "server.log"

    assert rejected == 300
    assert dropped >= 250, "counted instead of written"
    for file in (stderr, log):
        assert len(file.read_bytes().splitlines()) < 50
        assert b"\x1b" not in file.read_bytes()


@contextlib.contextmanager
def serving(root, stderr):
    """A server in a process of its own, as the command starts it."""
    with subprocess.Popen(
        [sys.executable, "-m", "recon4", "serve", str(root), "--port", "0"],
        cwd=ROOT, stdout=subprocess.PIPE, stderr=stderr, text=True,
    ) as process:  # fmt: skip
        try:
            yield re.search(r"http://\S+", process.stdout.readline())[0].rstrip("/")
        finally:
            process.terminate()
            process.wait()


def metric(url, name):
    text = httpx.get(f"{url}/metrics").text
    assert list(text_string_to_metric_families(text))
    found = re.search(rf"^{re.escape(name)} (\S+)$", text, re.MULTILINE)
    return float(found[1]) if found else 0.0
