"""HTTP routes of comparisons: two maps as a job, its figures and its points."""

from __future__ import annotations

from pathlib import Path

import msgspec
from fastapi import APIRouter, Depends, Request
from fastapi.responses import FileResponse

from recon4.comparison.files import FIGURES_FILE, POINTS_FILE
from recon4.comparison.records import MapDifferences
from recon4.comparison.tuning import PAGE_POINTS
from recon4.errors import StoreError
from recon4.locales.coded import CodedText
from recon4.store.json_files import read_object
from recon4.untrusted.limits import LIMITS
from recon4.untrusted.typed import as_type
from recon4_app.access.audit import audit
from recon4_app.access.people import Permission, needs
from recon4_app.comparisons.model import Comparisons, ComparisonView, NewComparison
from recon4_app.deps import Server, ServerParts
from recon4_app.error_responses import problems
from recon4_app.errors import NotFound
from recon4_app.exports.tuning import KEPT_EXPORTS
from recon4_app.jobs.model import CompareOrder, Inputs, Job, JobKind
from recon4_app.jobs.orders import add_order, find_order, latest_map_key, refuse_others
from recon4_app.jobs.routes import refuse_too_many
from recon4_app.network.rate_limit import at_most
from recon4_app.pages import Language, language_of

router = APIRouter(
    prefix="/api/projects/{project_id}/comparisons",
    tags=["comparisons"],
    dependencies=[Depends(needs(Permission.LOOK))],
    responses=problems(404, 422),
)
ORDER = [Depends(at_most(60, within_s=3600.0, what="comparisons"))]
REFUSALS = problems(403, 429)
FOREVER = "private, max-age=31536000, immutable"
"""Results are named by the id of their job: they never change."""


@router.get("", summary="Comparisons of a map")
def list_comparisons(project_id: str, server: Server, *, language: Language) -> Comparisons:
    """List what the map was compared with, the newest first, and what it can be compared with."""
    server.projects.folder(project_id)
    jobs = server.jobs.of_project(project_id, JobKind.COMPARE)[: KEPT_EXPORTS.listed]
    map_key = latest_map_key(server, project_id)
    return Comparisons(
        others=server.slices.sources(project_id) if map_key else [],
        comparisons=[_view(server, job, map_key, language=language) for job in jobs],
        step_m=PAGE_POINTS.step_m,
    )


@router.post(
    "", status_code=201, dependencies=ORDER, responses=REFUSALS, summary="Compare with another map"
)
def order(
    project_id: str, new: NewComparison, *, server: Server, request: Request
) -> ComparisonView:
    """Add a comparison to the queue; it runs beside jobs that process."""
    refuse_too_many(server)
    server.slices.artifacts(project_id)  # raises if there is no map
    if not new.against:
        raise NotFound(CodedText("comparison-no-map"))
    server.slices.artifacts(project_id, new.against)
    server.slices.evidence(project_id)  # an approval that does not count
    server.slices.evidence(project_id, new.against)
    asked = CompareOrder(against=new.against, align=new.align, core_spacing_m=new.core_spacing_m)
    job = add_order(server, project_id, Inputs(recordings=(), compare=asked), request=request)
    audit(request, "compare", f"{project_id}: {new.against}")
    return _view(server, job, latest_map_key(server, project_id), language=language_of(request))


@router.get("/{comparison_id}", summary="A comparison")
def read_comparison(
    project_id: str, comparison_id: str, server: Server, *, language: Language
) -> ComparisonView:
    """Its progress, and its figures when it is finished."""
    job = _comparison(server, project_id, comparison_id)
    return _view(server, job, latest_map_key(server, project_id), language=language)


@router.post("/{comparison_id}/cancel", responses=REFUSALS, summary="Cancel a comparison")
def cancel(project_id: str, comparison_id: str, *, server: Server, request: Request) -> None:
    """Stop a comparison; nothing of it is left."""
    job = _comparison(server, project_id, comparison_id)
    refuse_others(request, job)
    server.supervisor.cancel(job)
    audit(request, "cancel comparison", project_id)


@router.get(
    "/{comparison_id}/points", response_class=FileResponse, summary="Core points with differences"
)
def read_points(project_id: str, comparison_id: str, server: Server) -> FileResponse:
    """20 bytes each, little-endian: x, y, z in the map [m], float32; distance, int16, and level of
    detection, uint16, in steps of `step_m`; the state, uint8; the normal, int8 x 3, of 127.

    States: 0 below the level of detection, 1 significant, 2 without a partner, 3 without a normal,
    4 too few points.
    """
    path = _made(server, _comparison(server, project_id, comparison_id), POINTS_FILE)
    return FileResponse(
        path, media_type="application/octet-stream", headers={"Cache-Control": FOREVER}
    )


@router.get(
    "/{comparison_id}/file", response_class=FileResponse, summary="Core points as a LAZ file"
)
def download(project_id: str, comparison_id: str, server: Server) -> FileResponse:
    """All core points with distance, level of detection, numbers of points and state."""
    job = _comparison(server, project_id, comparison_id)
    path = server.exports.path(job)
    if path is None:
        raise NotFound(CodedText("comparison-gone"))
    return FileResponse(path, filename=path.name, media_type="application/octet-stream")


def _comparison(server: ServerParts, project_id: str, comparison_id: str) -> Job:
    return find_order(server, project_id, comparison_id, kind=JobKind.COMPARE)


def _made(server: ServerParts, job: Job, name: str) -> Path:
    """A file beside the LAZ file of a comparison.

    Raises:
        NotFound: If it was removed, or is not made yet.
    """
    laz = server.exports.path(job)
    path = laz.with_name(name) if laz else None
    if path is None or not path.is_file() or path.is_symlink():
        raise NotFound(CodedText("comparison-gone"))
    return path


def _view(server: ServerParts, job: Job, map_key: str, *, language: str) -> ComparisonView:
    asked = job.inputs.compare or CompareOrder(against="")
    kept = server.exports.path(job) is not None
    return ComparisonView(
        id=job.id,
        against=asked.against,
        align=asked.align,
        core_spacing_m=asked.core_spacing_m,
        state=job.state,
        person=job.person,
        created=job.created,
        note=job.said(language).note,
        fraction=server.supervisor.status(job).fraction,
        kept=kept,
        of_this_map=job.made is not None and job.made.map_key == map_key,
        found=_figures(_made(server, job, FIGURES_FILE)) if kept else None,
    )


def _figures(path: Path) -> MapDifferences | None:
    """What the worker wrote; None = it is damaged: a hostile map may have taken the worker over."""
    try:
        record = read_object(path, max_bytes=LIMITS.findings_bytes)
        return as_type(record, MapDifferences)
    except (StoreError, msgspec.ValidationError):
        return None
