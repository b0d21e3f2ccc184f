"""Servers behind a real nginx that does TLS: the site of ``docs/how-to/server.md``."""

from __future__ import annotations

import random
import re
import shutil
import socket
import ssl
import subprocess
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from unittest.mock import patch

import httpx
import pytest

from recon4_app.access.login import passwords
from recon4_app.access.login.login_service import open_access
from recon4_app.network.behind import public_address
from recon4_app.network.certificate import Certificate, made_certificate
from tests.deadlines import HANG_S
from tests.project_builder import build_project
from tests.service.running import ROOT, server_thread, wait_for
from tests.service.secure import CHEAP, PASSWORD, ROLES

NAME = "maps.example.org"
NGINX = shutil.which("nginx") or "/usr/sbin/nginx"
needs_nginx = pytest.mark.skipif(not Path(NGINX).exists(), reason="needs nginx (.ci/apt run test)")
LOCATION = re.compile(r"    location / \{\n.*?\n    \}\n", re.DOTALL)


@dataclass(frozen=True)
class Site:
    """A server as it is reached through the proxy."""

    name: str
    port: int
    prefix: str
    certificate: Path
    root: Path
    direct: str
    """Its own address, beside the proxy."""

    @property
    def origin(self) -> str:
        return f"https://{self.name}:{self.port}"

    @property
    def url(self) -> str:
        return self.origin + self.prefix

    def trust(self) -> ssl.SSLContext:
        context = ssl.create_default_context(cafile=self.certificate)
        context.check_hostname = False  # it is reached by address: nobody resolves the name
        return context

    def client(self, host: str = "") -> httpx.Client:
        headers = {"Host": host or f"{self.name}:{self.port}", "Origin": self.origin}
        url = f"https://127.0.0.1:{self.port}{self.prefix}"
        return httpx.Client(base_url=url, headers=headers, verify=self.trust(), timeout=HANG_S)


@contextmanager
def behind_nginx(
    folder: Path, *prefixes: str, name: str = NAME, removed: bool = False
) -> Iterator[list[Site]]:
    """One nginx and a server with the project ``office`` for each prefix; "" = the whole host.

    Args:
        folder: For everything.
        prefixes: As ``/recon4``.
        name: Host name of all.
        removed: Whether nginx removes the prefix.
    """
    port = _free_port()
    certificate = made_certificate(folder / "tls", frozenset({name}))
    with ExitStack() as stack:
        stack.enter_context(patch.object(passwords, "HASHER", CHEAP))
        sites = []
        for number, prefix in enumerate(prefixes):
            root = folder / f"root{number}"
            _prepare(root)
            behind = public_address(f"https://{name}:{port}{prefix}/")
            running = stack.enter_context(server_thread(root, behind=behind))
            sites.append(Site(name, port, prefix, certificate.chain, root, running.url))
        _write_configuration(folder, sites, certificate, removed=removed)
        nginx = subprocess.Popen([NGINX, "-p", folder, "-c", folder / "nginx.conf"])
        try:
            wait_for(lambda: _answers(port) or nginx.poll() is not None, "nginx listens")
            assert nginx.poll() is None, "nginx ended: its reason is in the output of the test"
            yield sites
        finally:
            nginx.terminate()
            nginx.wait(20)


def sign_in(client: httpx.Client, **headers: str) -> httpx.Response:
    answer = client.post("/api/login", json={"name": "anna", "password": PASSWORD}, headers=headers)
    assert answer.status_code == 200, answer.text
    client.headers["X-Recon4-Token"] = answer.json()["token"]
    return answer


def _prepare(root: Path) -> None:
    (root / ".recon4").mkdir(parents=True)
    build_project(root / "office", points=2_000)
    access = open_access(root / ".recon4", login=True)
    for name, role in ROLES.items():
        access.accounts.add(name, role, PASSWORD)
    access.close()


def _write_configuration(
    folder: Path, sites: Sequence[Site], certificate: Certificate, *, removed: bool
) -> None:
    folders = "".join(
        f"{kind}_temp_path {folder}/{kind};\n"
        for kind in ("client_body", "proxy", "fastcgi", "uwsgi", "scgi")
    )
    (folder / "nginx.conf").write_text(
        f"daemon off; master_process off; pid {folder}/pid; error_log stderr;\n"
        f"events {{}}\nhttp {{\naccess_log off;\n{folders}"
        f"{_documented_site(sites, certificate, removed=removed)}}}\n"
    )


def _documented_site(sites: Sequence[Site], certificate: Certificate, *, removed: bool) -> str:
    text = (ROOT / "docs" / "how-to" / "server.md").read_text("utf-8")
    found = re.search(r"```nginx\n(.*?)```", text, re.DOTALL)
    assert found is not None
    site = found[1]
    location = LOCATION.search(site)
    assert location is not None
    own = [_location(location[0], one, removed=removed) for one in sites]
    site = site.replace(location[0], "".join(own))
    changes = {
        "443": f"127.0.0.1:{sites[0].port}",
        "/etc/ssl/maps.example.org.pem": str(certificate.chain),
        "/etc/ssl/maps.example.org.key": str(certificate.key),
    }
    for written, here in changes.items():
        whole = rf"(?<!\d){re.escape(written)}(?!\d)"  # 443 may be part of another port
        site, replaced = re.subn(whole, here, site)
        assert replaced, written
    return site


def _location(documented: str, site: Site, *, removed: bool) -> str:
    upstream = "http://127.0.0.1:8000"
    assert f"{upstream};" in documented
    below = documented.replace("location / {", f"location {site.prefix}/ {{")
    return below.replace(upstream, site.direct + "/" * removed)


def _free_port() -> int:
    """A port that the system gives nobody by itself: it stays free until nginx has it."""
    for port in random.sample(range(20_000, 30_000), 100):
        with suppress(OSError), socket.create_server(("127.0.0.1", port)):
            return port
    raise AssertionError("no port is free")


def _answers(port: int) -> bool:
    with socket.socket() as caller:
        return caller.connect_ex(("127.0.0.1", port)) == 0
