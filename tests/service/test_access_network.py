"""The network of a server with login: TLS, names it answers to, forwarded headers."""

import socket
import ssl
from urllib.parse import urlsplit

import httpx
import pytest

from recon4.errors import ConfigError
from recon4_app.settings import ServerSettings
from tests.served import served
from tests.service.secure import PASSWORD, secure_server

server = served(run=secure_server)


def test_plain_http_is_not_spoken(server):
    with pytest.raises(httpx.HTTPError):
        httpx.get(server.url.replace("https", "http") + "/healthz", timeout=5.0)


@pytest.mark.parametrize("version", [ssl.TLSVersion.TLSv1, ssl.TLSVersion.TLSv1_1])
@pytest.mark.filterwarnings("ignore:ssl.TLSVersion:DeprecationWarning")
def test_old_tls_is_not_spoken(server, version):
    context = ssl._create_unverified_context()
    context.set_ciphers("ALL:@SECLEVEL=0")
    context.minimum_version = context.maximum_version = version
    port = urlsplit(server.url).port

    with socket.create_connection(("127.0.0.1", port)) as plain, pytest.raises(ssl.SSLError):
        context.wrap_socket(plain)


def test_the_very_address_a_connection_came_to_is_answered_and_no_other_name(server):
    names = ["localhost", socket.gethostname(), "127.0.0.1", "evil.example", "127.0.0.2", "[::2]"]
    with server.signed_in("vera") as client:
        statuses = [client.get("/api/me", headers={"Host": name}).status_code for name in names]

    assert statuses == [200, 200, 200, 400, 400, 400]


def test_names_of_the_setting_are_answered(tmp_path):
    with (
        secure_server(tmp_path, allowed_hosts=("Maps.Example.org",)) as server,
        server.client() as client,
    ):
        assert client.get("/healthz", headers={"Host": "maps.example.org"}).status_code == 200


def test_forwarded_headers_change_nothing(server):
    with server.signed_in("vera") as client:
        spoofed = {"X-Forwarded-For": "203.0.113.9", "X-Forwarded-Proto": "http"}
        answer = client.get("/api/me/sessions", headers=spoofed)
        with server.client(headers=spoofed) as stranger:
            stranger.post("/api/login", json={"name": "otto", "password": PASSWORD})

    assert {one["session"]["address"] for one in answer.json()} == {"127.0.0.1"}


def test_the_servers_own_files_are_for_its_user_alone(server):
    state = server.root / ".recon4"

    modes = {
        path.name: path.stat().st_mode & 0o777
        for path in (state, state / "access.sqlite", state / "tls" / "key.pem", state / "tls")
    }

    assert modes == {".recon4": 0o700, "access.sqlite": 0o600, "key.pem": 0o600, "tls": 0o700}


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"host": "0.0.0.0"}, "only loopback"),
        ({"host": "::"}, "only loopback"),
        ({"tls_certificate": "x", "tls_key": "y"}, "goes with --lan"),
        ({"lan": True, "tls_key": "y"}, "together, or neither"),
    ],
)
def test_there_is_no_network_without_login(tmp_path, settings, words):
    with pytest.raises(ConfigError, match=words):
        ServerSettings(root=tmp_path, **settings)
