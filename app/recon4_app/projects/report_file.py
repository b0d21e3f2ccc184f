"""Routes of the report for the client: as PDF, signed if the map is approved, or as a page."""

from __future__ import annotations

from pathlib import Path

from fastapi import APIRouter, Depends
from fastapi.responses import FileResponse
from starlette.concurrency import run_in_threadpool

from recon4.review.newest_approval import judging_folders
from recon4.review.trusted_keys import SIGNING_KEY, ensure_own_key
from recon4_app.access.people import Permission, needs
from recon4_app.compute_pool.model import FileAccess, Lane, Terms
from recon4_app.deps import Server
from recon4_app.error_responses import problems
from recon4_app.network.request_caller import CalledBy
from recon4_app.pages import Language
from recon4_app.projects.routes import REPORT_POLICY
from recon4_app.review.tuning import SIGNING

router = APIRouter(
    prefix="/api/projects/{project_id}",
    tags=["projects"],
    dependencies=[Depends(needs(Permission.LOOK))],
    responses=problems(404, 422),
)
_NAME = "report"


@router.get("/report.pdf", response_class=FileResponse, summary="Report for the client")
async def report_pdf(
    project_id: str, *, server: Server, caller: CalledBy, language: Language
) -> FileResponse:
    """Write the report for the client as PDF/A; that of an approved map is signed (PAdES).

    It is in the language of the request.

    422 says how to install the packages that it needs, if they are missing.
    """
    place = await _written(project_id, ".pdf", server=server, caller=caller, language=language)
    return FileResponse(place, filename=f"{project_id}-report.pdf", media_type="application/pdf")


@router.get("/client.html", response_class=FileResponse, summary="Report for the client, a page")
async def report_page(
    project_id: str, *, server: Server, caller: CalledBy, language: Language
) -> FileResponse:
    """Show the report for the client: what the PDF says, without a signature.

    It is in the language of the request.
    """
    place = await _written(project_id, ".html", server=server, caller=caller, language=language)
    headers = {"Content-Security-Policy": REPORT_POLICY}
    return FileResponse(place, media_type="text/html; charset=utf-8", headers=headers)


async def _written(
    project_id: str, ending: str, *, server: Server, caller: CalledBy, language: Language
) -> Path:
    """The file, in a place for exports that are asked for."""
    root = server.projects.folder(project_id)
    server.projects.result(project_id, "report.html")  # 404 before there is a map
    key = server.settings.state / SIGNING_KEY
    await run_in_threadpool(ensure_own_key, key.parent)
    place = await run_in_threadpool(server.slices.exports.free_place, ending.lstrip("."))
    terms = Terms(
        person=caller.name,
        access=FileAccess(read=(key, *judging_folders(key.parent)), write=(root,)),
        limit_s=SIGNING.signing_limit_s,
        outputs={_NAME + ending: place},
        large=True,  # approvals go first
    )
    run = server.compute_pool.run_background
    name = _NAME + ending
    await caller.wait(run(Lane.SIGN, terms, write_report_file, str(root), language, out=name))
    return place


def write_report_file(root: str, language: str, *, out: str) -> str:
    """Write the report as its ending says; a PDF of an approved map is signed, in the lane that may
    read the key.

    Raises:
        Altered: If the map is not what was approved.
        ConfigError: If the extra ``pdf`` is not installed, which a PDF needs.
    """
    from recon4.delivery.report_files import ReportWish, server_key, write_client_html, write_pdf

    project, path = Path(root), Path(out)
    write = write_client_html if path.suffix == ".html" else write_pdf
    write(project, path, ReportWish(language=language, key=server_key(project)))
    return out
