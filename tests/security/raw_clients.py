"""Connections byte by byte, for clients that do not keep to a protocol."""

import contextlib
import socket
import ssl
import time
from urllib.parse import urlsplit

SOON_S = 0.8
TRUSTING = ssl._create_unverified_context()


def connect(url, *, source="127.0.0.1", tls=None):
    """A TCP connection, or one with TLS."""
    where = urlsplit(url)
    connection = socket.create_connection(
        (where.hostname, where.port), timeout=10.0, source_address=(source, 0)
    )
    tls = where.scheme == "https" if tls is None else tls
    return TRUSTING.wrap_socket(connection) if tls else connection


def head(method, path, *lines):
    return "\r\n".join([f"{method} {path} HTTP/1.1", "Host: 127.0.0.1", *lines, "", ""]).encode()


def rest_of(connection):
    """What the server sends until it closes the connection."""
    received = b""
    with contextlib.suppress(ConnectionResetError, ssl.SSLEOFError, BrokenPipeError):
        while piece := connection.recv(1 << 16):
            received += piece
    return received


def counts_of(server):
    return server.app.state.connections.counts


def lasts_s(connection):
    """How long the server keeps a connection [s]."""
    began_s = time.monotonic()
    rest_of(connection)
    return time.monotonic() - began_s
