"""Latency of one user's small image while another user runs six whole-map exports.

    python -m tests.benchmarks.fair_exports PROJECT

Prints the seconds alone and beside the six, then how long children run on after the six clients
left. The project is copied (hard links) and not changed.
"""

from __future__ import annotations

import json
import shutil
import socket
import ssl
import sys
import tempfile
import time
from pathlib import Path
from urllib.parse import quote

import httpx
import psutil

from tests.service.secure import Secure, secure_server

LIMIT_S = 150.0
WHOLE = {"plane": {"kind": "horizontal", "z_m": 0.0, "thickness_m": 5.0}}


def small(z_m: float) -> dict[str, object]:
    """A sheet of one meter of a cut; each request has another size, so that none is cached."""
    window = {"left": 5.0, "bottom": 0.0, "right": 6.0, "top": 1.0}
    return {"plane": {"kind": "horizontal", "z_m": z_m, "thickness_m": 0.1}, "window": window}


def export(client: httpx.Client, ending: str, ask: dict[str, object]) -> float:
    """Seconds until the whole file is received."""
    began_s = time.perf_counter()
    path = f"/api/projects/office/slices/export.{ending}"
    answer = client.get(path, params={"ask": json.dumps(ask)}, timeout=LIMIT_S)
    if answer.status_code not in (200, 422):
        raise SystemExit(f"{answer.status_code}: {answer.text[:200]}")
    return time.perf_counter() - began_s


def ask_for_all(server: Secure, client: httpx.Client, number: int) -> ssl.SSLSocket:
    """A connection that requests the whole map as CSV; closing it cancels the request."""
    ask = WHOLE | {"plane": WHOLE["plane"] | {"z_m": number / 1000.0}}
    cookies = "; ".join(f"{name}={value}" for name, value in client.cookies.items())
    host, port = server.host.split(":")
    line = server.trust().wrap_socket(
        socket.create_connection((host, int(port))), server_hostname=host
    )
    path = f"/api/projects/office/slices/export.csv?ask={quote(json.dumps(ask))}"
    head = f"GET {path} HTTP/1.1\r\nHost: {server.host}\r\nCookie: {cookies}\r\n\r\n"
    line.sendall(head.encode())
    return line


def children() -> int:
    """Running children of the compute pool."""
    count = 0
    for process in psutil.Process().children(recursive=True):
        try:
            count += process.cpu_percent(0.2) > 5.0
        except psutil.Error:
            continue
    return count


def main(project: Path) -> None:
    with tempfile.TemporaryDirectory(dir=project.parent) as folder:
        root = Path(folder)
        shutil.copytree(project, root / "office", copy_function=lambda a, b: Path(b).hardlink_to(a))
        with secure_server(root) as server, server.signed_in("vera") as vera:
            export(vera, "png", small(0.5))
            print(f"alone: {export(vera, 'png', small(0.51)):.1f} s", flush=True)
            with server.signed_in("otto") as otto:
                lines = [ask_for_all(server, otto, k) for k in range(6)]
                time.sleep(3.0)
                try:
                    print(f"beside six: {export(vera, 'png', small(0.52)):.1f} s", flush=True)
                except httpx.TimeoutException:
                    print(f"beside six: over {LIMIT_S:.0f} s", flush=True)
                for line in lines:
                    line.close()
            left_s = time.perf_counter()
            while children() and time.perf_counter() - left_s < 20.0:
                time.sleep(0.2)
            print(
                f"children at work after the six left: {children()}, "
                f"{time.perf_counter() - left_s:.1f} s later",
                flush=True,
            )


if __name__ == "__main__":
    main(Path(sys.argv[1]))
