"""HTTP route of the server itself: version, disk space, notices."""

from __future__ import annotations

import shutil

from fastapi import APIRouter, Depends
from pydantic import BaseModel

from recon4 import __version__
from recon4_app.access.people import Permission, needs
from recon4_app.deps import Server
from recon4_app.projects.unlisted import unlisted_notices
from recon4_app.tuning import ROOM

router = APIRouter(prefix="/api", tags=["server"], dependencies=[Depends(needs(Permission.LOOK))])

READ_ONLY = (
    "The folder of the projects cannot be written: it is shown as it is. Jobs, uploads, reviews, "
    "rigs and live captures need a copy of it."
)


class ServerView(BaseModel):
    """The server and its disk."""

    version: str
    free_bytes: int
    """Free on the disk of the projects."""
    disk_bytes: int
    reserve_bytes: int
    """Uploads and jobs leave this much free."""
    notices: list[str]
    """Notices for users; mostly empty."""


@router.get("/server", summary="The server")
def read_server(server: Server) -> ServerView:
    """Version of the server, disk space, and notices for users."""
    disk = shutil.disk_usage(server.settings.root)
    notices = [*filter(None, [server.access.notice, server.jobs.notice]), *server.uploads.notices()]
    notices += [READ_ONLY] if server.settings.read_only else []
    notices += unlisted_notices(server.settings.root)
    if not server.settings.read_only and disk.free < max(
        ROOM.little_room * disk.total, server.settings.free_disk_reserve_bytes
    ):
        notices.append(
            f"The disk is nearly full: {disk.free / 1e9:.1f} GB of {disk.total / 1e9:.0f} GB are "
            "free. Delete projects or uploads that are not needed: the page Storage lists them."
        )
    return ServerView(
        version=__version__,
        free_bytes=disk.free,
        disk_bytes=disk.total,
        reserve_bytes=server.settings.free_disk_reserve_bytes,
        notices=notices,
    )
