"""A small tus client for tests, which may break off anywhere."""

from __future__ import annotations

import base64
import contextlib
import hashlib
import socket
from urllib.parse import urlsplit

import httpx

from tests.deadlines import HANG_S

HTTP = httpx.Client(limits=httpx.Limits(max_keepalive_connections=0), timeout=HANG_S)
TUS = {"Tus-Resumable": "1.0.0"}
CHUNK = TUS | {"Content-Type": "application/offset+octet-stream"}


def metadata(**texts: str) -> str:
    return ",".join(f"{k} {base64.b64encode(v.encode()).decode()}" for k, v in texts.items())


def create(url: str, length: int, **texts: str) -> httpx.Response:
    headers = TUS | {"Upload-Length": str(length), "Upload-Metadata": metadata(**texts)}
    return HTTP.post(f"{url}/api/uploads/files", headers=headers)


def offset(url: str, location: str) -> int:
    answer = HTTP.head(url + location, headers=TUS)
    assert answer.status_code == 200, answer.text
    return int(answer.headers["Upload-Offset"])


def patch(url: str, location: str, at: int, data: bytes, *, check: bool = False) -> httpx.Response:
    headers = CHUNK | {"Upload-Offset": str(at)}
    if check:
        digest = base64.b64encode(hashlib.sha256(data).digest()).decode()
        headers["Upload-Checksum"] = f"sha256 {digest}"
    return HTTP.patch(url + location, headers=headers, content=data)


def patch_and_break_off(url: str, location: str, at: int, data: bytes, *, sent: int) -> None:
    """Announce all of ``data``, send only its beginning, and hang up."""
    there = urlsplit(url)
    head = (
        f"PATCH {location} HTTP/1.1\r\nHost: {there.netloc}\r\nTus-Resumable: 1.0.0\r\n"
        f"Content-Type: application/offset+octet-stream\r\nUpload-Offset: {at}\r\n"
        f"Content-Length: {len(data)}\r\n\r\n"
    )
    with socket.create_connection((there.hostname, there.port)) as connection:
        connection.sendall(head.encode() + data[:sent])
        connection.shutdown(socket.SHUT_WR)
        with contextlib.suppress(OSError):
            while connection.recv(4096):  # the server has taken notice once it hangs up too
                pass
