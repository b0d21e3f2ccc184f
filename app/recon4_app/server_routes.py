"""HTTP route of the server itself: version, disk space, notices."""

from __future__ import annotations

import shutil

from fastapi import APIRouter, Depends
from pydantic import BaseModel

from recon4 import __version__
from recon4.locales.coded import CodedText, said
from recon4_app.access.people import Permission, needs
from recon4_app.deps import Server
from recon4_app.pages import Language
from recon4_app.projects.unlisted import unlisted_notices
from recon4_app.tuning import ROOM

router = APIRouter(prefix="/api", tags=["server"], dependencies=[Depends(needs(Permission.LOOK))])


class ServerView(BaseModel):
    """The server and its disk."""

    version: str
    free_bytes: int
    """Free on the disk of the projects."""
    disk_bytes: int
    reserve_bytes: int
    """Uploads and jobs leave this much free."""
    notices: list[str]
    """Notices for users, in their language; mostly empty."""


@router.get("/server", summary="The server")
def read_server(server: Server, language: Language) -> ServerView:
    """Version of the server, disk space, and notices for users."""
    settings, disk = server.settings, shutil.disk_usage(server.settings.root)
    notices = [*filter(None, [server.access.notice, server.jobs.notice]), *server.uploads.notices()]
    notices += [CodedText("notice-read-only")] if settings.read_only else []
    notices += unlisted_notices(settings.root)
    little = max(ROOM.little_room * disk.total, settings.free_disk_reserve_bytes)
    if not settings.read_only and disk.free < little:
        notices.append(CodedText("notice-disk", free_bytes=disk.free, disk_bytes=disk.total))
    return ServerView(
        version=__version__,
        free_bytes=disk.free,
        disk_bytes=disk.total,
        reserve_bytes=settings.free_disk_reserve_bytes,
        notices=[said(one, language) for one in notices],
    )
