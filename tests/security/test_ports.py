"""No page of another site and no other user gets anything from a port or socket of ours.

Figures to hold: of all sockets that the server, its viewers, the compute pool and a live capture
listen on, one is TCP (the front), UDP ports are those of the rig, the others are Unix sockets of
mode 0600 in folders of mode 0700. 0 bytes for a foreign origin, 0 bytes for another user.
"""

from __future__ import annotations

import asyncio
import functools
import http.server
import os
import stat
import subprocess
import sys
import threading
from contextlib import contextmanager
from pathlib import Path
from urllib.parse import urlsplit

import psutil
import pytest
import viser
from viser import _messages
from websockets.exceptions import ConnectionClosed, InvalidHandshake, InvalidMessage
from websockets.sync.client import connect

from recon4.errors import StoreError
from recon4.live.ipc.line_server import LineServer
from recon4.live.protocol import Done
from recon4.system import runtime_folder as places
from recon4_app.viewer import unix_socket
from tests.project_builder import build_project
from tests.service.running import ROOT, server_process
from tests.service.viser_client import PROTOCOL, camera, viewing

NOBODY = 65534
EVIL = "http://evil.example"
FOREIGN_PAGE = """<!doctype html><script>
async function steal(port) {
  return new Promise((resolve) => {
    const socket = new WebSocket(`ws://127.0.0.1:${port}/projects/office/viewer`, ["%s"]);
    let got = 0;
    socket.onmessage = (event) => { got += event.data.size || event.data.length; };
    socket.onclose = () => resolve(got);
    setTimeout(() => resolve(got), 3000);
  });
}
</script>"""
CONNECT_AS_NOBODY = """
import os, socket, sys
os.setgroups([]); os.setgid(65534); os.setuid(65534)
for path in sys.argv[1:]:
    client = socket.socket(socket.AF_UNIX)
    client.settimeout(5.0)
    try:
        client.connect(path)
        client.sendall(b"GET / HTTP/1.1\\r\\nHost: x\\r\\n\\r\\n")
        print(path, len(client.recv(1 << 16)))
    except OSError:
        print(path, 0)
"""


@pytest.fixture(scope="module")
def served(tmp_path_factory):
    """A server with an open viewer and a busy compute pool, below a path of 180 characters."""
    root = tmp_path_factory.mktemp("projects") / ("deep" * 20) / ("path" * 20)
    root.mkdir(parents=True)
    build_project(root / "office", points=2000)
    with server_process(root) as (server, process), viewing(server.url) as client:
        client.send(camera())
        client.until(lambda c: "/grid" in c.nodes)
        assert server.get("/api/projects/office/review/queue").status_code == 200
        yield server, psutil.Process(process.pid)


def tree(process: psutil.Process) -> list[psutil.Process]:
    return [process, *process.children(recursive=True)]


def tcp_ports(process: psutil.Process) -> list[int]:
    return [
        connection.laddr.port
        for one in tree(process)
        for connection in one.net_connections("tcp")
        if connection.status == psutil.CONN_LISTEN
    ]


def unix_sockets(process: psutil.Process) -> list[Path]:
    """Bound Unix sockets, also abstract ones (which have no permissions)."""
    return [
        Path(connection.laddr)
        for one in tree(process)
        for connection in one.net_connections("unix")
        if connection.laddr
    ]


def stolen(port: int, origin: str) -> int:
    """Bytes a WebSocket of a foreign origin receives."""
    got = 0
    for path in ("", "projects/office/viewer"):
        try:
            with connect(
                f"ws://127.0.0.1:{port}/{path}", origin=origin, subprotocols=[PROTOCOL], proxy=None
            ) as socket:
                while True:
                    got += len(socket.recv(timeout=2.0))
        except (InvalidHandshake, InvalidMessage, ConnectionClosed, TimeoutError, OSError):
            continue
    return got


def test_only_the_front_listens_on_tcp_and_nothing_on_udp(served):
    server, process = served

    assert tcp_ports(process) == [urlsplit(server.url).port]
    assert not [c for one in tree(process) for c in one.net_connections("udp")]


def test_unix_sockets_are_private_files_in_private_folders(served):
    _, process = served
    found = unix_sockets(process)

    assert found, "the viewer listens somewhere"
    for path in found:
        assert path.is_socket(), f"{path} is abstract: it has no permissions"
        assert stat.S_IMODE(path.stat().st_mode) == 0o600
        assert stat.S_IMODE(path.parent.stat().st_mode) == 0o700
        assert len(os.fsencode(path)) < 104


def test_a_foreign_origin_gets_nothing_from_any_port(served):
    _, process = served

    assert {port: stolen(port, EVIL) for port in tcp_ports(process)} == dict.fromkeys(
        tcp_ports(process), 0
    )


@pytest.mark.e2e
def test_a_foreign_page_in_a_browser_gets_nothing_from_any_port(served, browser, tmp_path):
    _, process = served
    (tmp_path / "index.html").write_text(FOREIGN_PAGE % PROTOCOL)
    with page_server(tmp_path) as url, browser.new_page() as page:
        page.goto(url)
        got = {port: page.evaluate("port => steal(port)", port) for port in tcp_ports(process)}

    assert got == dict.fromkeys(tcp_ports(process), 0)


@pytest.mark.skipif(os.getuid() != 0, reason="only root can become another user")
def test_another_user_reaches_no_socket(served):
    _, process = served
    paths = [str(path) for path in unix_sockets(process)]

    answers = subprocess.run(
        [sys.executable, "-c", CONNECT_AS_NOBODY, *paths],
        capture_output=True,
        text=True,
        check=True,
    )

    assert answers.stdout.split("\n")[:-1] == [f"{path} 0" for path in paths]


@pytest.mark.skipif(os.getuid() != 0, reason="only root can become another user")
def test_live_messages_are_for_their_user_alone_even_where_permissions_fail(tmp_path):
    """Folder and socket are open to all on purpose: the kernel still reports the peer's user."""
    requests = []

    async def attack() -> str:
        lines = LineServer(
            initial_messages=lambda: [Done(frames=0, problem="secret")], on_request=requests.append
        )
        path = Path("/tmp") / f"recon4-test-{os.getpid()}"
        await lines.listen(path)
        mode = stat.S_IMODE(path.stat().st_mode)
        path.chmod(0o777)
        attacker = await asyncio.create_subprocess_exec(
            *(sys.executable, "-c", CONNECT_AS_NOBODY, str(path)),
            stdout=asyncio.subprocess.PIPE,
        )
        said, _ = await attacker.communicate()
        reader, writer = await asyncio.open_unix_connection(path)
        assert b"secret" in await reader.readline(), "its own user is answered"
        writer.close()
        await lines.close()
        assert mode == 0o600
        return said.decode().split()[1]

    assert asyncio.run(attack()) == "0"
    assert requests == []


@pytest.mark.parametrize("how", ["mode", "link", "file"])
def test_a_socket_folder_others_can_enter_is_not_used(tmp_path, monkeypatch, how):
    taken = tmp_path / f"recon4-{os.getuid()}"
    if how == "mode":
        taken.mkdir()
        taken.chmod(0o755)
    elif how == "link":
        (tmp_path / "elsewhere").mkdir(mode=0o700)
        taken.symlink_to(tmp_path / "elsewhere")
    else:
        taken.touch()
    monkeypatch.setattr(places, "_places", lambda: [taken, tmp_path / "second"])

    with pytest.raises(StoreError, match="expected a folder of user"):
        places.private_folder(taken)
    if len(os.fsencode(tmp_path)) < 40:
        assert places.runtime_folder() == tmp_path / "second"


def test_the_code_of_the_public_tunnel_cannot_be_reached(tmp_path):
    """In a process of its own: what is taken away is not given back."""
    code = f"""
import viser, pytest
from pathlib import Path
from viser import _messages
from recon4_app.viewer.client.show import Viewer
viewer = Viewer(Path({str(tmp_path)!r}) / "s", on_client=print, on_leave=print)
handlers = viewer._server._websock_server._incoming_handlers
assert not handlers.get(_messages.ShareUrlRequest)
assert not handlers.get(_messages.ShareUrlDisconnect)
with pytest.raises(RuntimeError, match="no tunnel"):
    viewer._server.request_share_url()
viewer.stop()
"""
    subprocess.run([sys.executable, "-c", code], check=True, cwd=ROOT)


@pytest.mark.study
def test_a_viser_that_starts_its_server_in_another_way_is_noticed(tmp_path):
    with (
        pytest.raises(AssertionError, match="another way"),
        unix_socket.listening_on(tmp_path / "s"),
    ):
        pass
    assert viser.__version__ == "1.1.1"
    assert _messages.ShareUrlRequest


@contextmanager
def page_server(folder: Path):
    """Another site, on another port."""
    handler = functools.partial(_Quiet, directory=str(folder))
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as site:
        thread = threading.Thread(target=site.serve_forever)
        thread.start()
        try:
            yield f"http://127.0.0.1:{site.server_address[1]}/"
        finally:
            site.shutdown()
            thread.join()


class _Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_: object) -> None:
        pass
