"""Connections that cost the attacker nothing: mute or malformed. All other clients are served.

Held: with 2 000 mute connections, from one address or from 2 000, a new connection is answered
within 0.5 s (99th percentile), and as many connections are open as the limits say. Repeated
attempts grow the log by a bounded number of lines. Slow clients: `test_slow_clients.py`.
"""

import contextlib
import os
import re
import resource
import select
import socket
import subprocess
import sys
import time
from pathlib import Path

import httpx
import pytest
from prometheus_client.parser import text_string_to_metric_families

from recon4_app.network import accept
from recon4_app.network.connections import open_file_limit, raise_file_limit
from tests.deadlines import BUSY_S
from tests.security.raw_clients import connect, head, rest_of
from tests.service.running import ROOT, server_thread, wait_for

MUTE = 2000
LOG_GROWTH_BYTES = 100_000


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


def ask(url, source="127.0.0.1"):
    """How long a request on a new connection takes [s]."""
    began_s = time.perf_counter()
    with connect(url, source=source) as connection:
        connection.sendall(head("GET", "/healthz", "Connection: close"))
        assert rest_of(connection).startswith(b"HTTP/1.1 200")
    return time.perf_counter() - began_s


@pytest.mark.parametrize("source_of", [one_address, an_address_each])
def test_2000_mute_connections_hold_up_nobody(server, source_of):
    table = server.app.state.connections
    with mute(server.url, MUTE, source_of):
        wait_for(lambda: table.counts.accepted >= MUTE, "the server has taken them all")
        times_s = [
            ask(server.url, source) for _ in range(60) for source in ("127.0.0.1", "127.0.0.2")
        ]
        held = len(table)

    assert max(times_s) < BUSY_S, "nobody waits until mute clients are given up"
    most = table.limits.per_address if source_of is one_address else table.limits.total
    assert most - 5 <= held <= most + 5, "the limit holds, and room is used up to it"
    assert table.counts.evicted["waiting"] >= MUTE - most
    wait_for(
        lambda: len(table) == 0, "connections the clients closed are forgotten", max_s=20.0 + BUSY_S
    )


@pytest.mark.study
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

    assert max(times_s) < BUSY_S, "nobody waits until mute clients are given up"
    assert log.stat().st_size - before < LOG_GROWTH_BYTES


def answers(url):
    try:
        return ask(url)
    except OSError:
        return None


EXHAUSTED = """
import asyncio, os, resource, socket, sys
from recon4_app.network.accept import Acceptor
from recon4_app.network.connections import ConnectionLimits, ConnectionTable, Phase

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

    assert 1 <= errors <= 2 + elapsed_s / accept.ACCEPT.accept_pause_s
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


@pytest.mark.study
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
