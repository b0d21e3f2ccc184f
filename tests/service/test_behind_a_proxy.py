"""A server behind a real nginx, with a host name of its own and below a path."""

import asyncio
import re

import httpx
import pytest
import viser
from websockets.asyncio.client import connect
from websockets.exceptions import InvalidStatus
from websockets.typing import Subprotocol

from recon4.errors import ConfigError
from recon4_app.network.behind import public_address
from recon4_app.settings import ServerSettings
from tests.deadlines import HANG_S
from tests.first_variants import all_but_first_are_studies
from tests.service.behind_nginx import behind_nginx, needs_nginx, sign_in
from tests.service.secure import PASSWORD


@pytest.fixture
def site(tmp_path):
    with behind_nginx(tmp_path, "") as (found,):
        yield found


def cookies_of(client):
    return "; ".join(f"{one.name}={one.value}" for one in client.cookies.jar)


def open_socket(site, path, *, cookies, origin="", **options):
    return connect(
        f"wss://{site.name}:{site.port}{site.prefix}{path}",
        host="127.0.0.1",
        port=site.port,
        ssl=site.trust(),
        server_hostname=site.name,
        origin=origin or site.origin,
        additional_headers={"Cookie": cookies},
        compression=None,
        max_size=None,
        proxy=None,
        open_timeout=HANG_S,  # the viewer starts before its socket is accepted
        **options,
    )


async def first_message(site, path, cookies, **options):
    async with open_socket(site, path, cookies=cookies, **options) as stream:
        if path.endswith("/stream"):
            await stream.send("{}")
        return await asyncio.wait_for(stream.recv(), HANG_S)


VISER = {"subprotocols": [Subprotocol(f"viser-v{viser.__version__}")]}
VIEWER = "/projects/office/viewer"


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
    with site.client() as client:
        sign_in(client)
        cookies = cookies_of(client)

    assert len(asyncio.run(first_message(site, VIEWER, cookies, **VISER))) > 0
    with pytest.raises(InvalidStatus, match="403"):
        asyncio.run(first_message(site, VIEWER, cookies, origin="https://evil.example", **VISER))


@needs_nginx
def test_other_hosts_are_refused_through_the_proxy_and_beside_it(site):
    with site.client(host="evil.example") as client:
        assert client.get("/healthz").status_code == 400
    with site.client() as client:
        assert client.get("/healthz").status_code == 200
    assert httpx.get(f"{site.direct}/healthz").status_code == 400


@needs_nginx
def test_tools_of_an_assistant_name_the_address_with_its_path(tmp_path):
    call = {"name": "project_summary", "arguments": {"project": "office"}}
    asked = {"jsonrpc": "2.0", "id": 1, "method": "tools/call", "params": call}
    with behind_nginx(tmp_path, "/maps/old") as (site,), site.client() as client:
        sign_in(client)
        token = client.post("/api/me/tokens", json={"label": "helper"}).json()["token"]
        bearer = {
            "Authorization": f"Bearer {token}",
            "Accept": "application/json, text/event-stream",
        }
        with site.client() as program:
            said = program.post("/mcp", json=asked, headers=bearer).text

    assert f"{site.url}/projects/office/" in said


@needs_nginx
@pytest.mark.parametrize(
    "removed", all_but_first_are_studies([False, True]), ids=["kept", "removed"]
)
def test_everything_works_below_a_path_that_the_proxy_keeps_or_removes(tmp_path, removed):
    with behind_nginx(tmp_path, "/maps/old", removed=removed) as (site,), site.client() as client:
        page = {"Accept": "text/html"}
        asked = client.get("/projects/office/?a=1", headers=page)
        signed_in = sign_in(client)
        moved = client.get("/projects/office/viewer", headers=page)
        docs = client.get("/docs", headers=page)
        invited = client.post("/api/pairing/invitations", json={"role": "viewer"}).json()
        described = client.get("/openapi.json").json()
        lost = client.get("/nothing", headers=page)
        metrics = client.get("/metrics").text
        socket = asyncio.run(first_message(site, "/api/live/stream", cookies_of(client)))
        viewer = asyncio.run(first_message(site, VIEWER, cookies_of(client), **VISER))

    assert asked.headers["location"] == "/maps/old/login#next=/projects/office/"
    for line in signed_in.headers.get_list("set-cookie"):
        assert re.match(r"__Secure-(sid|browser)-maps~old=", line)
        assert all(part in line for part in ("Path=/maps/old/;", "Secure", "HttpOnly"))
    assert moved.headers["location"] == "/maps/old/projects/office/viewer/"
    assert docs.headers["location"] == f"{site.url}/docs/"
    assert invited["links"][0]["url"].startswith(f"{site.url}/pair#")
    assert described["servers"] == [{"url": "/maps/old"}]
    schemes = described["components"]["securitySchemes"]
    assert schemes["session"]["name"] == "__Secure-sid-maps~old"
    assert schemes["access_token"]["scheme"] == "bearer"
    style = r'href="/maps/old/web/[0-9a-f]{16}/shared/base\.css"'
    assert lost.status_code == 404 and re.search(style, lost.text)
    assert 'route="/api/login"' in metrics
    assert len(socket) > 0 and len(viewer) > 0


@needs_nginx
def test_an_upload_through_the_proxy_goes_to_addresses_below_the_path(tmp_path):
    tus = {"Tus-Resumable": "1.0.0", "Upload-Length": "4", "Upload-Metadata": "filename YS5iaW4="}
    with behind_nginx(tmp_path, "/recon4") as (site,), site.client() as client:
        sign_in(client)
        made = client.post("/api/uploads/files", headers=tus)
        upload = client.get("/api/uploads").json()[0]["id"]
        (file,) = client.get(f"/api/uploads/{upload}/files").json()
        there = made.url.join(made.headers["Location"])
        chunk = {"Upload-Offset": "0", "Content-Type": "application/offset+octet-stream"}
        sent = client.patch(there, headers={**tus, **chunk}, content=b"maps")
        finished = client.get(f"/api/uploads/{upload}").json()["finished"]

    assert made.headers["Location"] == file["url"] and file["url"].startswith("/recon4/api/")
    assert sent.status_code == 204 and finished


@needs_nginx
def test_servers_on_paths_of_one_host_keep_their_sessions_apart(tmp_path):
    prefixes = ("/maps", "/maps/old", "")
    who = {"name": "anna", "password": PASSWORD}
    with behind_nginx(tmp_path, *prefixes) as sites, sites[2].client() as browser:
        tokens = [browser.post(f"{one}/api/login", json=who).json()["token"] for one in prefixes]
        names = {cookie.name for cookie in browser.cookies.jar}
        all_in = [browser.get(f"{one}/api/me").status_code for one in prefixes]
        out = browser.post("/maps/api/logout", headers={"X-Recon4-Token": tokens[0]})
        left = [browser.get(f"{one}/api/me").status_code for one in prefixes]

    assert {"__Secure-sid-maps", "__Secure-sid-maps~old", "__Host-sid"} <= names
    assert all_in == [200, 200, 200]
    assert out.status_code == 204 and left == [401, 200, 200]
    assert "Clear-Site-Data" not in out.headers  # it would clear what the others keep


def scope(peer, forwarded=None, scheme="http"):
    headers = [(b"x-forwarded-for", one.encode()) for one in forwarded or ()]
    return {
        "type": "http",
        "path": "/",
        "scheme": scheme,
        "client": (peer, 5000),
        "headers": headers,
    }


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
        ("https://example.org/a%20b/", "letters A-Z, digits"),
        ("https://example.org/a//b/", "between single slashes"),
        ("https://example.org/a/../b/", "between single slashes"),
        ("https://example.org/a~b/", "letters A-Z, digits"),
        ("https://example.org/#maps", "as https://example.org/recon4/"),
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
