"""TLS handshakes that are none, stop or go on byte by byte: each ends at its deadline."""

import contextlib
import ssl
import time

import pytest
from msgspec import structs

from recon4_app.network import accept, http_timeouts
from tests.deadlines import BUSY_S
from tests.security.raw_clients import SOON_S, TRUSTING, connect, counts_of, lasts_s
from tests.service.running import wait_for
from tests.service.secure import secure_server


@pytest.fixture
def secure(tmp_path, monkeypatch):
    """A server with TLS and shorter deadlines."""
    monkeypatch.setattr(
        accept, "ACCEPT", structs.replace(accept.ACCEPT, handshake_timeout_s=SOON_S)
    )
    monkeypatch.setattr(
        http_timeouts,
        "HTTP_TIMEOUTS",
        structs.replace(http_timeouts.HTTP_TIMEOUTS, head_timeout_s=SOON_S),
    )
    with secure_server(tmp_path) as running:
        yield running


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
