"""The server: every part put together once, and the call that runs it."""

from __future__ import annotations

import asyncio
import logging
import time
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager, suppress
from functools import cache

from fastapi import APIRouter, Depends, FastAPI, Request
from fastapi.responses import JSONResponse
from starlette.middleware.body_limit import RequestBodyLimitMiddleware
from starlette.routing import BaseRoute

from recon4 import __version__
from recon4.archive.verify import open_state, seal_state
from recon4.errors import StoreError
from recon4.locales.coded import CodedText
from recon4.review.newest_approval import judging_folders
from recon4.review.trusted_keys import STATE, record_own_key
from recon4.store.atomic import make_folders
from recon4.system.stopping import StopSignals
from recon4_app import docs_pages, error_responses, metrics_routes, server_routes
from recon4_app.access import admin_routes, key_routes
from recon4_app.access.guests import routes as guest_routes
from recon4_app.access.login import routes as login_routes
from recon4_app.access.login import token_routes
from recon4_app.access.login.login_service import Access, open_access
from recon4_app.access.middleware.origin import OriginMiddleware
from recon4_app.access.pairing import routes as pairing_routes
from recon4_app.access.people import LOCAL, READER, Permission, allow_anonymous, needs
from recon4_app.access.restoring import access_copies, restore_access
from recon4_app.access.routes_check import check_declared
from recon4_app.access.startup_notice import startup_notice
from recon4_app.annotations import routes as annotation_routes
from recon4_app.assistant import routes as assistant_routes
from recon4_app.assistant.endpoint import AssistantEndpoint
from recon4_app.comparisons import routes as comparison_routes
from recon4_app.compute_pool.pool import ComputePool
from recon4_app.deps import ServerParts
from recon4_app.exports import map_routes
from recon4_app.exports import routes as export_routes
from recon4_app.exports.kept import KeptExports
from recon4_app.jobs import choices, worker_choice_routes
from recon4_app.jobs import routes as job_routes
from recon4_app.jobs.store import JobStore
from recon4_app.jobs.supervisor import Supervisor
from recon4_app.leftovers import child_register, sweep_leftovers
from recon4_app.live import routes as live_routes
from recon4_app.live.current_capture import CurrentCapture
from recon4_app.logs import Logs
from recon4_app.maintenance import maintain, rotate_logs
from recon4_app.map_view import routes as map_view_routes
from recon4_app.metrics import Metrics, MetricsMiddleware
from recon4_app.network.behind import ProxyMiddleware, prefix_of
from recon4_app.network.connections import (
    ConnectionLimits,
    ConnectionTable,
    open_file_limit,
    raise_file_limit,
)
from recon4_app.network.listen import (
    AnnouncingServer,
    certificate_of,
    hosts_of,
    listening,
    make_state,
    own_files,
    urls,
    uvicorn_config,
)
from recon4_app.network.streams import StreamLimits, Streams
from recon4_app.openapi import description
from recon4_app.page_routes import add_page, no_head
from recon4_app.pages import WEB, page_addresses
from recon4_app.projects import report_file
from recon4_app.projects import routes as project_routes
from recon4_app.projects.import_folders import ImportFolders
from recon4_app.projects.store import ProjectStore
from recon4_app.projects.thumbnail import Thumbnails
from recon4_app.projects.trash import Trash
from recon4_app.review import acknowledgment_routes, correction_routes, team_routes
from recon4_app.review import routes as review_routes
from recon4_app.review.hash_checks import ApprovalChecks
from recon4_app.review.newest_approvals import record_all
from recon4_app.review.presence import Presence
from recon4_app.review.store import Reviews
from recon4_app.rigs import routes as rig_routes
from recon4_app.rigs.calibrations import Calibrations
from recon4_app.rigs.store import RigStore
from recon4_app.rigs.uses import RigUses
from recon4_app.settings import ServerSettings
from recon4_app.slices import align_routes, reference_routes, site_routes, target_routes
from recon4_app.slices import routes as slice_routes
from recon4_app.slices.store import Slices
from recon4_app.storage import routes as storage_routes
from recon4_app.storage.project_space import ProjectSpaces
from recon4_app.storage.storage_work import free_expired
from recon4_app.uploads import routes as upload_routes
from recon4_app.uploads.store import UploadStore
from recon4_app.viewer import page, proxy
from recon4_app.viewer.pool import ViewerPool
from recon4_app.web_files import WebFiles
from recon4_app.webhooks import routes as webhook_routes
from recon4_app.webhooks.deliver import Webhooks
from recon4_app.webhooks.store import WebhookStore

log = logging.getLogger(__name__)

EVENT_STREAMS = StreamLimits(
    max_streams=128, max_per_person=16, max_per_address=48, reserved_for_capture=8
)
REQUIRES_LOOK = [Depends(needs(Permission.LOOK))]


def create_app(settings: ServerSettings) -> FastAPI:
    """The application for one folder of projects."""
    app = FastAPI(
        title="recon4",
        version=__version__,
        summary="Maps from LiDAR backpacks: projects, jobs, results, viewer",
        docs_url=None,
        redoc_url=None,
        openapi_url=None,
        lifespan=lambda app: _running(app, settings),
        routes=_routes(),
    )
    app.state.connections = ConnectionTable(
        ConnectionLimits.within(
            settings.max_connections,
            per_address=settings.max_connections_of_an_address,
            files=open_file_limit(),
        )
    )
    app.state.logs = Logs(settings.state / "logs" / "server.log")
    app.add_middleware(RequestBodyLimitMiddleware, max_body_size=settings.max_body_bytes)
    pinned = settings.tls_certificate is not None
    app.add_middleware(
        OriginMiddleware,
        hosts=hosts_of(settings),
        local=None if settings.login else READER if settings.read_only else LOCAL,
        pinned=pinned,
    )
    metrics = app.state.metrics = Metrics(app.state.connections, app.state.logs)
    app.add_middleware(MetricsMiddleware, metrics=metrics.http)
    if settings.behind is not None:
        app.add_middleware(ProxyMiddleware, address=settings.behind)
    error_responses.install(app)
    app.mount("/web", WebFiles(directory=WEB), name="web")
    _add_health_and_openapi(app)
    check_declared(app)
    return app


@cache
def _routes() -> list[BaseRoute]:
    """The routes of all parts; what FastAPI works out for them is kept from one server to the next.

    A process that starts many servers (the tests) would spend a fifth of a second on each.
    """
    router = APIRouter()
    for part in (
        login_routes,
        token_routes,
        admin_routes,
        key_routes,
        webhook_routes,
        pairing_routes,
        guest_routes,
        project_routes,
        map_routes,
        export_routes,
        comparison_routes,
        report_file,
        job_routes,
        worker_choice_routes,
    ):
        router.include_router(part.router)
    more = (choices, server_routes, metrics_routes, docs_pages)
    for part in (*more, reference_routes, align_routes, site_routes, target_routes):
        router.include_router(part.router)
    for part in (acknowledgment_routes, annotation_routes, correction_routes, team_routes):
        router.include_router(part.router)
    router.include_router(assistant_routes.router)
    for part in (page, proxy):
        router.include_router(part.router, dependencies=REQUIRES_LOOK)
    for part in (review_routes, slice_routes, map_view_routes, rig_routes):
        router.include_router(part.router)
    router.include_router(rig_routes.page)
    for part in (live_routes, storage_routes):
        router.include_router(part.router)
    for one in (upload_routes.files, upload_routes.router):
        router.include_router(one)
    heads = {"map/map.html": map_view_routes.page_preloads}
    for address in page_addresses():
        add_page(router, address, heads.get(address.file, no_head))
    return router.routes


def serve(
    settings: ServerSettings,
    stop: StopSignals,
    *,
    open_project: str | None = None,
    on_ready: Callable[[str, list[str]], None] = lambda url, notes: None,
) -> None:
    """Run the server until a signal requests its end.

    Args:
        settings: Where and how.
        stop: Catches the signals.
        open_project: The project whose page the URL leads to; None = the list.
        on_ready: Called once, as soon as the server listens, with the URL and the startup notice:
            other URLs, the certificate's fingerprint, how to create the first admin.

    Raises:
        ConfigError: If ``root`` is not a folder of projects, or the certificate is not valid.
        StoreError: If it cannot listen there, or another server runs on the same folder.
    """
    raise_file_limit()
    with own_files(settings) as settings, listening(settings) as listener:
        sweep_leftovers(settings)
        certificate = certificate_of(settings)
        app = create_app(settings)
        best, *others = urls(settings, listener)
        path = f"projects/{open_project}/" if open_project else ""

        def ready() -> None:
            access: Access = app.state.parts.access
            notice = startup_notice(access, best, others=others, certificate=certificate)
            read_only = [CodedText("notice-read-only")] if settings.read_only else []
            on_ready(best + path, [*read_only, *notice])
            app.state.parts.compute_pool.prepare_spare()

        server = AnnouncingServer(uvicorn_config(app, certificate), ready)
        stop.request(server.end)
        logs: Logs = app.state.logs
        with logs.installed():
            asyncio.run(server.serve([listener]))


@asynccontextmanager
async def _running(app: FastAPI, settings: ServerSettings) -> AsyncIterator[None]:
    """Open the parts of the server, keep its background tasks running, and close all in order."""
    make_state(settings)
    for problem in open_state(settings.state):
        log.error("%s: %s; recon4 verify %s lists all", STATE, problem, settings.root)
    for folder in judging_folders(settings.state):  # before children that may read them
        make_folders(folder, 0o700)
    record_own_key(settings.state)
    try:
        parts = app.state.parts = _open_parts(settings)
    except StoreError as error:
        app.state.refusal = error  # `AnnouncingServer` raises it; uvicorn logs a traceback instead
        yield
        return
    app.state.metrics.follow(parts)
    watching = [
        asyncio.create_task(parts.supervisor.run()),
        asyncio.create_task(_maintain(parts)),
        asyncio.create_task(parts.webhooks.run()),
        asyncio.create_task(rotate_logs(settings.state, parts.jobs, parts.current_capture)),
        asyncio.create_task(parts.current_capture.adopt()),
    ]
    try:
        yield
    finally:
        for task in watching:
            task.cancel()
        await asyncio.gather(*watching, return_exceptions=True)
        await _close_parts(parts)
        seal_state(settings.state)


def _open_parts(settings: ServerSettings) -> ServerParts:
    notice = restore_access(settings.state)
    jobs = JobStore(settings.state / "jobs.sqlite")
    pool = ComputePool(settings.state / "compute", children=child_register(settings))
    checks = ApprovalChecks()
    projects = ProjectStore(
        settings.root, _import_folders(settings), index=settings.state / "index" / "projects.json"
    )
    rigs = RigStore(settings.root)
    uses = RigUses(rigs, projects, jobs)
    trash = Trash(settings.root, settings.state / "trash", kept_s=settings.trash_retention_s)
    trash.recover()
    viewers = ViewerPool(
        idle_s=settings.viewer_idle_s,
        points=settings.viewer_points,
        state=settings.state,
        sockets=Streams("viewers", _viewer_limits(settings)),
        children=child_register(settings),
    )
    slices = Slices(pool, projects, checks, settings=settings)
    access = open_access(settings.state, login=settings.login, notice=notice)
    return ServerParts(
        settings=settings,
        access=access,
        webhooks=Webhooks(WebhookStore(access.engine), jobs, access.log, settings=settings),
        projects=projects,
        thumbnails=Thumbnails(pool, settings.state / "thumbnails"),
        trash=trash,
        uploads=UploadStore(settings),
        jobs=jobs,
        supervisor=Supervisor(jobs, settings),
        viewers=viewers,
        compute_pool=pool,
        event_streams=Streams("event streams", EVENT_STREAMS),
        current_capture=CurrentCapture(settings.root),
        checks=checks,
        reviews=Reviews(pool),
        presence=Presence(),
        slices=slices,
        exports=KeptExports(jobs, settings.state),
        rigs=rigs,
        rig_uses=uses,
        calibrations=Calibrations(projects, uses),
        project_spaces=ProjectSpaces(projects, jobs),
        assistants=AssistantEndpoint(),
    )


async def _maintain(parts: ServerParts) -> None:
    copies, settings = access_copies(parts.settings.state), parts.settings
    await maintain(
        (
            lambda: record_all(settings.root, settings.state),
            parts.jobs.back_up,
            lambda: copies.make(renew=True),
            lambda: parts.uploads.sweep(time.time()),
            lambda: parts.trash.sweep(time.time()),
            lambda: free_expired(parts, time.time()),
            parts.project_spaces.sweep_kept,
            lambda: parts.slices.exports.sweep(time.time()),
            lambda: parts.exports.sweep(time.time()),
            parts.webhooks.store.sweep,
            parts.projects.cards.save,
            parts.webhooks.wake,
        )
    )


async def _close_parts(parts: ServerParts) -> None:
    await parts.assistants.close()
    await parts.current_capture.leave()
    await parts.compute_pool.close()
    parts.checks.close()
    parts.supervisor.close()
    await parts.viewers.close()
    with suppress(StoreError):  # it is made again
        parts.projects.cards.save()
    parts.jobs.close()
    parts.access.close()


def _viewer_limits(settings: ServerSettings) -> StreamLimits:
    max_streams = settings.viewer_sockets
    return StreamLimits(
        max_streams=max_streams,
        max_per_person=settings.viewer_sockets_a_person,
        max_per_address=max(max_streams // 2, settings.viewer_sockets_a_person),
        reserved_for_capture=max_streams // 8,
    )


def _import_folders(settings: ServerSettings) -> ImportFolders:
    """Folders of recordings that requests may name, without the server's own files."""
    private = [settings.state, *([settings.tls_key] if settings.tls_key else [])]
    return ImportFolders(settings.import_roots, private=private)


def _add_health_and_openapi(app: FastAPI) -> None:

    @app.get("/healthz", tags=["server"], dependencies=[Depends(allow_anonymous)])
    async def healthz() -> dict[str, str]:
        """Health check: whether the server answers."""
        return {"status": "ok", "version": __version__}

    @app.get("/openapi.json", include_in_schema=False, dependencies=REQUIRES_LOOK)
    def openapi(request: Request) -> JSONResponse:
        return JSONResponse(description(app, prefix_of(request.scope)))
