"""A server behind a real nginx that does TLS: the site of ``docs/server.md``."""

import asyncio
import re
import shutil
import socket
import ssl
import subprocess
from dataclasses import dataclass
from pathlib import Path
from unittest.mock import patch

import httpx
import pytest
import viser
from websockets.asyncio.client import connect
from websockets.exceptions import InvalidStatus
from websockets.typing import Subprotocol

from app.access.login import passwords
from app.access.login.login_service import open_access
from app.network.behind import public_address
from app.network.certificate import made_certificate
from app.settings import ServerSettings
from recon4.errors import ConfigError
from tests.project_builder import build_project
from tests.service.running import ROOT, server_thread, wait_for
from tests.service.secure import CHEAP, PASSWORD, ROLES

NAME = "maps.example.org"
NGINX = shutil.which("nginx") or "/usr/sbin/nginx"
needs_nginx = pytest.mark.skipif(not Path(NGINX).exists(), reason="needs nginx (.ci/apt run test)")


def free_port():
    with socket.create_server(("127.0.0.1", 0)) as found:
        return found.getsockname()[1]


@dataclass
class Site:
    port: int
    certificate: Path
    root: Path
    direct: str

    @property
    def origin(self):
        return f"https://{NAME}:{self.port}"

    def trust(self):
        context = ssl.create_default_context(cafile=self.certificate)
        context.check_hostname = False  # it is reached by address: nobody resolves the name
        return context

    def client(self, host=""):
        headers = {"Host": host or f"{NAME}:{self.port}", "Origin": self.origin}
        url = f"https://127.0.0.1:{self.port}"
        return httpx.Client(base_url=url, headers=headers, verify=self.trust(), timeout=30)


def site_of_the_documentation(port, upstream, certificate):
    text = (ROOT / "docs" / "server.md").read_text("utf-8")
    site = re.search(r"```nginx\n(.*?)```", text, re.DOTALL)[1]
    changes = {
        "443": f"127.0.0.1:{port}",
        "/etc/ssl/maps.example.org.pem": str(certificate.chain),
        "/etc/ssl/maps.example.org.key": str(certificate.key),
        "http://127.0.0.1:8000": upstream,
    }
    for written, here in changes.items():
        assert written in site
        site = site.replace(written, here)
    return site


@pytest.fixture
def site(tmp_path):
    root = tmp_path / "root"
    (root / ".recon4").mkdir(parents=True)
    build_project(root / "office", points=2_000)
    port = free_port()
    certificate = made_certificate(tmp_path / "tls", frozenset({NAME}))
    behind = public_address(f"https://{NAME}:{port}/")
    with patch.object(passwords, "HASHER", CHEAP):
        access = open_access(root / ".recon4", login=True)
        for name, role in ROLES.items():
            access.accounts.add(name, role, PASSWORD)
        access.close()
        with server_thread(root, behind=behind) as running:
            (tmp_path / "nginx.conf").write_text(
                f"daemon off; master_process off; pid {tmp_path}/pid; error_log stderr;\n"
                "events {}\nhttp {\naccess_log off;\n"
                + "".join(
                    f"{kind}_temp_path {tmp_path}/{kind};\n"
                    for kind in ("client_body", "proxy", "fastcgi", "uwsgi", "scgi")
                )
                + site_of_the_documentation(port, running.url, certificate)
                + "}\n"
            )
            nginx = subprocess.Popen([NGINX, "-p", tmp_path, "-c", tmp_path / "nginx.conf"])
            try:
                found = Site(port, certificate.chain, root, running.url)
                wait_for(lambda: answers(port) or nginx.poll() is not None, "nginx listens")
                yield found
            finally:
                nginx.terminate()
                nginx.wait(20)


def answers(port):
    with socket.socket() as caller:
        return caller.connect_ex(("127.0.0.1", port)) == 0


def sign_in(client, **headers):
    answer = client.post("/api/login", json={"name": "anna", "password": PASSWORD}, headers=headers)
    assert answer.status_code == 200, answer.text
    client.headers["X-Recon4-Token"] = answer.json()["token"]
    return answer


@needs_nginx
def test_people_sign_in_and_work_through_the_proxy(site):
    with site.client() as client:
        assert client.get("/api/projects").status_code == 401
        signed_in = sign_in(client, **{"X-Forwarded-For": "203.0.113.9"})
        cards = client.get("/api/projects").json()
        changed = client.post("/api/rigs", json={"id": "field", "copy_of": "4recon"})
        invited = client.post("/api/pairing/invitations", json={"role": "viewer"})
        entries = client.get("/api/audit").json()["entries"]
        foreign = client.post("/api/rigs", headers={"Origin": "https://evil.example"}, json={})

    cookie = signed_in.headers["set-cookie"]
    assert "__Host-" in cookie and "Secure" in cookie
    assert [card["id"] for card in cards] == ["office"]
    assert changed.status_code == 201
    (link,) = invited.json()["links"]
    assert link["url"].startswith(f"{site.origin}/pair#")
    addresses = {entry["address"] for entry in entries}
    assert addresses == {"127.0.0.1"}  # what nginx saw, not what the client claimed
    assert foreign.status_code == 403


@needs_nginx
def test_the_viewer_is_relayed_through_the_proxy_to_its_own_origin_only(site):
    async def first_message(origin, cookies):
        connection = connect(
            f"wss://{NAME}:{site.port}/projects/office/viewer",
            host="127.0.0.1",
            port=site.port,
            ssl=site.trust(),
            server_hostname=NAME,
            origin=origin,
            additional_headers={"Cookie": cookies},
            subprotocols=[Subprotocol(f"viser-v{viser.__version__}")],
            compression=None,
            max_size=None,
            proxy=None,
        )
        async with connection as viewer:
            return await asyncio.wait_for(viewer.recv(), 60)

    with site.client() as client:
        sign_in(client)
        cookies = "; ".join(f"{name}={value}" for name, value in client.cookies.items())

    assert len(asyncio.run(first_message(site.origin, cookies))) > 0
    with pytest.raises(InvalidStatus, match="403"):
        asyncio.run(first_message("https://evil.example", cookies))


@needs_nginx
def test_other_hosts_are_refused_through_the_proxy_and_beside_it(site):
    with site.client(host="evil.example") as client:
        assert client.get("/healthz").status_code == 400
    with site.client() as client:
        assert client.get("/healthz").status_code == 200
    assert httpx.get(f"{site.direct}/healthz").status_code == 400


def scope(peer, forwarded=None, scheme="http"):
    headers = [(b"x-forwarded-for", one.encode()) for one in forwarded or ()]
    return {"type": "http", "scheme": scheme, "client": (peer, 5000), "headers": headers}


@pytest.mark.parametrize(
    ("peer", "forwarded", "seen"),
    [
        ("127.0.0.1", ["203.0.113.7"], ("https", "203.0.113.7")),
        ("127.0.0.1", ["10.0.0.1, 203.0.113.7"], ("https", "203.0.113.7")),
        ("127.0.0.1", ["10.0.0.1", "203.0.113.7"], ("https", "203.0.113.7")),
        ("::1", ["2001:db8::7"], ("https", "2001:db8::7")),
        ("127.0.0.1", ["<script>"], ("https", "127.0.0.1")),
        ("127.0.0.1", None, ("https", "127.0.0.1")),
        ("192.0.2.1", ["203.0.113.7"], ("http", "192.0.2.1")),
    ],
)
def test_forwarded_addresses_count_from_the_proxy_only(peer, forwarded, seen):
    found = public_address("https://maps.example.org").seen_through(scope(peer, forwarded))

    assert (found["scheme"], found["client"][0]) == seen


@pytest.mark.parametrize(
    ("url", "said"),
    [
        ("http://maps.example.org/", "as https://maps.example.org/"),
        ("maps.example.org", "as https://maps.example.org/"),
        ("https://", "as https://maps.example.org/"),
        ("https://a:b@maps.example.org/", "as https://maps.example.org/"),
        ("https://maps.example.org:x/", "is no address"),
        ("https://example.org/recon4/", "a host name of their own, not the path '/recon4/'"),
    ],
)
def test_other_addresses_are_refused_with_what_to_do(url, said):
    with pytest.raises(ConfigError, match=re.escape(said)):
        public_address(url)


def test_a_server_behind_a_proxy_listens_on_loopback_without_tls_of_its_own(tmp_path):
    behind = public_address("https://maps.example.org")

    assert ServerSettings(root=tmp_path, behind=behind).login
    with pytest.raises(ConfigError, match="exclude each other"):
        ServerSettings(root=tmp_path, behind=behind, lan=True, host="0.0.0.0")
    with pytest.raises(ConfigError, match="will not listen on"):
        ServerSettings(root=tmp_path, behind=behind, host="0.0.0.0")
