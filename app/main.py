"""The server: every part put together once, and the call that runs it."""

from __future__ import annotations

import asyncio
import fcntl
import os
import socket
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import asynccontextmanager, contextmanager
from pathlib import Path

import uvicorn
from fastapi import FastAPI
from fastapi.responses import FileResponse
from fastapi.staticfiles import StaticFiles
from starlette.middleware.body_limit import RequestBodyLimitMiddleware

from app import errors
from app.access.guard import Guard
from app.deps import Parts, Server
from app.desk import Desk
from app.jobs import routes as job_routes
from app.jobs.store import JobStore
from app.jobs.supervisor import Supervisor
from app.projects import routes as project_routes
from app.projects.picture import Pictures
from app.projects.store import ProjectStore
from app.settings import ServerSettings, recordings_from_environment
from app.uploads import routes as upload_routes
from app.uploads.store import UploadStore
from app.viewer import page, proxy
from app.viewer.pool import ViewerPool
from recon4 import __version__
from recon4.errors import StoreError

WEB = Path(__file__).parents[1] / "web"
HOSTS = frozenset({"127.0.0.1", "localhost", "::1"})
"""Names the server answers to; a forwarded port (ssh -L) keeps them."""


def create_app(settings: ServerSettings) -> FastAPI:
    """The application for one folder of projects."""
    app = FastAPI(
        title="recon4",
        version=__version__,
        summary="Maps from LiDAR backpacks: projects, jobs, results, viewer",
        docs_url=None,
        redoc_url=None,
        lifespan=lambda app: _running(app, settings),
    )
    app.add_middleware(RequestBodyLimitMiddleware, max_body_size=settings.max_body_bytes)
    app.add_middleware(Guard, hosts=HOSTS)
    errors.install(app)
    for part in (project_routes, job_routes, page, proxy):
        app.include_router(part.router)
    for router in (upload_routes.files, upload_routes.router):
        app.include_router(router)
    app.mount("/web", StaticFiles(directory=WEB), name="web")
    _add_pages(app)
    return app


def serve(
    root: Path,
    *,
    host: str = "127.0.0.1",
    port: int = 8000,
    open_project: str | None = None,
    on_ready: Callable[[str], None] = lambda url: None,
    worker: str = "app.jobs.worker",
) -> None:
    """Run the server until it is interrupted.

    Args:
        root: Folder that holds the project folders.
        host: Address to listen on; loopback only.
        port: Port; 0 = any free one.
        open_project: The project whose page the URL leads to; None = the list.
        on_ready: Called once with the URL, as soon as the server listens.
        worker: Module run for a job.

    Raises:
        ConfigError: If it cannot listen there, or ``root`` does not hold projects.
        StoreError: If another server runs on the same folder.
    """
    settings = ServerSettings(
        root=root,
        host=host,
        port=port,
        recordings=recordings_from_environment(),
        worker=worker,
    )
    with _only_one(settings), _listening(settings) as listener:
        name, bound = listener.getsockname()[:2]
        shown = f"[{name}]" if ":" in name else name
        path = f"projects/{open_project}/" if open_project else ""
        server = AnnouncingServer(
            uvicorn_config(create_app(settings)), lambda: on_ready(f"http://{shown}:{bound}/{path}")
        )
        asyncio.run(server.serve([listener]))


class AnnouncingServer(uvicorn.Server):
    """Says when it listens."""

    def __init__(self, config: uvicorn.Config, ready: Callable[[], None]) -> None:
        super().__init__(config)
        self._ready = ready

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        """Start, then say so."""
        await super().startup(sockets)
        self._ready()


def uvicorn_config(app: FastAPI) -> uvicorn.Config:
    """How the application is run, in tests too."""
    return uvicorn.Config(
        app,
        log_level="warning",
        access_log=False,
        ws_per_message_deflate=False,  # costs 0.3 s of processor time a million points
        timeout_graceful_shutdown=2,  # event streams never end by themselves
        server_header=False,
    )


@asynccontextmanager
async def _running(app: FastAPI, settings: ServerSettings) -> AsyncIterator[None]:
    settings.state.mkdir(exist_ok=True)
    jobs = JobStore(settings.state / "jobs.sqlite")
    supervisor = Supervisor(jobs, settings)
    desk = Desk()
    viewers = ViewerPool(
        idle_s=settings.viewer_idle_s,
        points=settings.viewer_points,
        logs=settings.state / "viewers",
    )
    app.state.parts = Parts(
        settings=settings,
        projects=ProjectStore(settings.root, settings.import_roots),
        pictures=Pictures(settings.state / "pictures"),
        uploads=UploadStore(settings),
        jobs=jobs,
        supervisor=supervisor,
        viewers=viewers,
        desk=desk,
    )
    watching = asyncio.create_task(supervisor.run())
    try:
        yield
    finally:
        watching.cancel()
        await asyncio.gather(watching, return_exceptions=True)
        desk.close()
        supervisor.close()
        await viewers.close()
        jobs.close()


def _add_pages(app: FastAPI) -> None:
    @app.get("/healthz", tags=["server"])
    async def healthz() -> dict[str, str]:
        """Whether the server answers."""
        return {"status": "ok", "version": __version__}

    @app.get("/", include_in_schema=False)
    def index() -> FileResponse:
        return FileResponse(WEB / "index.html")

    @app.get("/api", include_in_schema=False)
    def api() -> FileResponse:
        return FileResponse(WEB / "api.html")

    @app.get("/projects/{project_id}/", include_in_schema=False)
    def project(project_id: str, server: Server) -> FileResponse:
        if not server.jobs.of_project(project_id):
            server.projects.folder(project_id)  # a waiting job's project has no folder yet
        return FileResponse(WEB / "project.html")


@contextmanager
def _only_one(settings: ServerSettings) -> Iterator[None]:
    """Hold the folder: two servers would start every job twice."""
    settings.state.mkdir(exist_ok=True)
    lock = os.open(settings.state / "server.lock", os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
    try:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError as error:
            raise StoreError(f"another server runs on {settings.root}; use that one") from error
        yield
    finally:
        os.close(lock)


@contextmanager
def _listening(settings: ServerSettings) -> Iterator[socket.socket]:
    family = socket.AF_INET6 if ":" in settings.host else socket.AF_INET
    with socket.socket(family) as listener:
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            listener.bind((settings.host, settings.port))
        except OSError as error:
            raise StoreError(
                f"port {settings.port} is in use ({error.strerror}); choose another with --port"
            ) from error
        yield listener
