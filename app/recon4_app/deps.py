"""Dependencies of the routes: the parts of the running server."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from fastapi import Depends
from starlette.requests import HTTPConnection

from recon4_app.access.login.login_service import Access
from recon4_app.assistant.endpoint import AssistantEndpoint
from recon4_app.compute_pool.pool import ComputePool
from recon4_app.exports.kept import KeptExports
from recon4_app.jobs.store import JobStore
from recon4_app.jobs.supervisor import Supervisor
from recon4_app.live.current_capture import CurrentCapture
from recon4_app.network.streams import Streams
from recon4_app.projects.store import ProjectStore
from recon4_app.projects.thumbnail import Thumbnails
from recon4_app.projects.trash import Trash
from recon4_app.review.hash_checks import ApprovalChecks
from recon4_app.review.presence import Presence
from recon4_app.review.store import Reviews
from recon4_app.rigs.calibrations import Calibrations
from recon4_app.rigs.store import RigStore
from recon4_app.rigs.uses import RigUses
from recon4_app.settings import ServerSettings
from recon4_app.slices.store import Slices
from recon4_app.storage.project_space import ProjectSpaces
from recon4_app.uploads.store import UploadStore
from recon4_app.viewer.pool import ViewerPool
from recon4_app.webhooks.deliver import Webhooks


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
    presence: Presence
    slices: Slices
    exports: KeptExports
    rigs: RigStore
    rig_uses: RigUses
    calibrations: Calibrations
    project_spaces: ProjectSpaces
    webhooks: Webhooks
    assistants: AssistantEndpoint


def parts(connection: HTTPConnection) -> ServerParts:
    """The parts of the server a request or WebSocket came to."""
    found: ServerParts = connection.app.state.parts
    return found


Server = Annotated[ServerParts, Depends(parts)]
