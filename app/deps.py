"""Dependencies of the routes: the parts of the running server."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from fastapi import Depends
from starlette.requests import HTTPConnection

from app.access.login.login_service import Access
from app.compute_pool.pool import ComputePool
from app.jobs.store import JobStore
from app.jobs.supervisor import Supervisor
from app.live.current_capture import CurrentCapture
from app.network.streams import Streams
from app.projects.store import ProjectStore
from app.projects.thumbnail import Thumbnails
from app.projects.trash import Trash
from app.review.checks import ApprovalChecks
from app.review.store import Reviews
from app.rigs.calibrations import Calibrations
from app.rigs.store import RigStore
from app.rigs.uses import RigUses
from app.settings import ServerSettings
from app.slices.store import Slices
from app.uploads.store import UploadStore
from app.viewer.pool import ViewerPool


@dataclass(frozen=True, slots=True, kw_only=True)
class ServerParts:
    """The parts of a server, one of each."""

    settings: ServerSettings
    access: Access
    projects: ProjectStore
    thumbnails: Thumbnails
    trash: Trash
    uploads: UploadStore
    jobs: JobStore
    supervisor: Supervisor
    viewers: ViewerPool
    compute_pool: ComputePool
    event_streams: Streams
    current_capture: CurrentCapture
    checks: ApprovalChecks
    reviews: Reviews
    slices: Slices
    rigs: RigStore
    rig_uses: RigUses
    calibrations: Calibrations


def parts(connection: HTTPConnection) -> ServerParts:
    """The parts of the server a request or WebSocket came to."""
    found: ServerParts = connection.app.state.parts
    return found


Server = Annotated[ServerParts, Depends(parts)]
