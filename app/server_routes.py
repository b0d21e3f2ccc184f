"""HTTP face of the server itself: what people should know of it."""

from __future__ import annotations

import shutil

from fastapi import APIRouter, Depends
from pydantic import BaseModel

from app.access.people import Permission, needs
from app.deps import Server
from recon4 import __version__

router = APIRouter(prefix="/api", tags=["server"], dependencies=[Depends(needs(Permission.LOOK))])

LITTLE_ROOM = 0.1
"""Less than this share of the disk free is worth a word."""


class ServerView(BaseModel):
    """The server and its disk."""

    version: str
    free_bytes: int
    """Free on the disk of the projects."""
    disk_bytes: int
    reserve_bytes: int
    """Uploads and jobs leave this much free."""
    notices: list[str]
    """What people should know, in words; mostly empty."""


@router.get("/server", summary="The server")
def read_server(server: Server) -> ServerView:
    """Version, room on the disk, and what people should know."""
    disk = shutil.disk_usage(server.settings.root)
    notices = [server.jobs.notice] if server.jobs.notice else []
    if disk.free < max(LITTLE_ROOM * disk.total, server.settings.reserve_bytes):
        notices.append(
            f"The disk is nearly full: {disk.free / 1e9:.1f} GB of {disk.total / 1e9:.0f} GB are "
            "free. Delete projects or uploads that are not needed."
        )
    return ServerView(
        version=__version__,
        free_bytes=disk.free,
        disk_bytes=disk.total,
        reserve_bytes=server.settings.reserve_bytes,
        notices=notices,
    )
