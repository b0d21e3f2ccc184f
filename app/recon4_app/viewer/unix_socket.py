"""Makes viser (pinned: 1.1.1) listen on a Unix socket only, and removes its tunnel.

viser supports TCP ports only, has no login and accepts every origin: on a port of loopback any page
open in a browser of this computer could read the scene. It starts its server by
``websockets.asyncio.server.serve(handler, host, port, ...)``; that call is redirected here.
"""

from __future__ import annotations

import contextlib
import os
import socket
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from unittest.mock import patch

import viser
import websockets.asyncio.server
from viser import _messages, _viser


@contextlib.contextmanager
def listening_on(path: Path) -> Iterator[None]:
    """The viser server made in the ``with`` block listens on a Unix socket (0600), on no port.

    Raises:
        OSError: If the path is in use or cannot be written.
        AssertionError: If viser did not use the socket.
    """
    listener = _bound(path)
    redirected: list[tuple[object, ...]] = []
    serve = websockets.asyncio.server.serve

    def serve_unix(handler: Any, *address: object, **options: Any) -> Any:
        redirected.append(address)
        return serve(handler, unix=True, sock=listener, **options)

    try:
        with patch.object(websockets.asyncio.server, "serve", serve_unix):
            yield
        assert len(redirected) == 1, f"viser starts servers in another way: {redirected}"
    except BaseException:
        listener.close()
        raise


def remove_share_tunnel(server: viser.ViserServer) -> None:
    """Unregister the message that requests a public tunnel, and make starting one an error."""
    server._websock_server.unregister_handler(_messages.ShareUrlRequest)
    server._websock_server.unregister_handler(_messages.ShareUrlDisconnect)
    _viser.ViserTunnel = _NoTunnel  # type: ignore[assignment,attr-defined]


class _NoTunnel:
    def __init__(self, *_: object, **__: object) -> None:
        raise RuntimeError("the viewer opens no tunnel")


def _bound(path: Path) -> socket.socket:
    listener = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    before = os.umask(0o177)  # private from its creation
    try:
        listener.bind(str(path))
    except OSError:
        listener.close()
        raise
    finally:
        os.umask(before)
    return listener
