"""HTTP routes of the slices."""

from __future__ import annotations

import base64
import binascii
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Literal

from fastapi import APIRouter, Depends, Query, Response
from fastapi.responses import FileResponse, HTMLResponse, PlainTextResponse
from starlette.concurrency import run_in_threadpool

from recon4.errors import ConfigError
from recon4.locales.coded import CodedText
from recon4.review.state import read_summary
from recon4.slices.compare import Comparison
from recon4.slices.control_points import ControlPreview
from recon4.slices.double_places import DoubleReport
from recon4.slices.residuals import ControlReport
from recon4_app.access.people import Permission, Who, needs
from recon4_app.deps import Server
from recon4_app.error_responses import problems
from recon4_app.errors import BadRequest, Refused
from recon4_app.network.request_caller import CalledBy, Caller
from recon4_app.pages import Language
from recon4_app.projects.routes import REPORT_POLICY
from recon4_app.slices import control_work, readers, slice_work
from recon4_app.slices.exports import ExportRequest
from recon4_app.slices.model import (
    CompareRequest,
    ControlFile,
    ControlState,
    ExportContext,
    PickRequest,
    PickView,
    SliceExportRequest,
    SliceFacts,
    SliceImageRequest,
    SliceImageView,
    SurfacePoint,
    WalkStretch,
    WindowSpec,
    Xyz,
)
from recon4_app.slices.store import Asking

Second = Annotated[float, Query(ge=0.0, le=1e9, allow_inf_nan=False)]
"""Time after the start of the walk [s]."""
LOOK = [Depends(needs(Permission.LOOK))]


def of_shared_map(who: Who, source: str = "", reference: str = "") -> None:
    """Check that a guest asks for the shared map: a source may be another project.

    Raises:
        Refused: If a guest asks for another source, or for a reference.
    """
    if who.project and (source or reference):
        raise Refused(CodedText("guest-one-project"))


SHARED = [Depends(needs(Permission.SHARED))]
SHARED_MAP = [*SHARED, Depends(of_shared_map)]
PROCESS = [Depends(needs(Permission.PROCESS))]
SURFACES = "surfaces.json"
"""Name of the file that a child process writes in its working folder."""

router = APIRouter(
    prefix="/api/projects/{project_id}/slices",
    tags=["slices"],
    responses=problems(404, 422),
)


@router.get("", dependencies=SHARED_MAP, summary="Facts about the map")
async def read_facts(
    project_id: str, server: Server, caller: CalledBy, *, who: Who, source: str = ""
) -> SliceFacts:
    """Bounds, frame, fields; for people who signed in references and other maps to compare with."""
    slices, guest, language = server.slices, bool(who.project), caller.language
    artifacts = await run_in_threadpool(slices.artifacts, project_id, source)
    references = [] if guest else await run_in_threadpool(slices.references, project_id, language)
    sources = [] if guest else await run_in_threadpool(slices.sources, project_id)
    approval = await run_in_threadpool(slices.approval, project_id, source, language)
    terms = slices.terms(project_id, caller.name, source)
    return await caller.wait(
        slices.run_interactive(
            terms, slice_work.facts, artifacts, references, sources, approval=approval
        )
    )


@router.post("/image", dependencies=SHARED, summary="An image of a slice")
async def slice_image(
    project_id: str, ask: SliceImageRequest, server: Server, *, caller: CalledBy, who: Who
) -> SliceImageView:
    """All points of the map in the window, at full resolution.

    Of the requests of one ``page`` only the latest gets an image; the others get 409.
    """
    of_shared_map(who, ask.source, ask.reference)
    slices = server.slices
    evidence = await run_in_threadpool(slices.evidence_to_show, project_id, ask.source)
    artifacts = await run_in_threadpool(slices.artifacts, project_id, ask.source)
    reference = slices.reference(project_id, ask.reference)
    ask.plane.slice_plane()  # an invalid plane is rejected before the request waits
    terms = slices.terms(project_id, caller.name, ask.source)
    asking = Asking(ask.page, ask.sequence)
    return await caller.wait(
        slices.run_latest(
            asking,
            terms,
            slice_work.slice_image,
            artifacts["map"],
            reference,
            ask,
            evidence=evidence,
        )
    )


@router.get(
    "/overview", response_class=FileResponse, dependencies=SHARED_MAP, summary="The map from above"
)
async def overview(
    project_id: str, server: Server, caller: CalledBy, *, source: str = ""
) -> FileResponse:
    """A transparent PNG; its window is at ``/overview/window``."""
    image = await _overview(project_id, server, caller, source=source)
    return FileResponse(image, media_type="image/png")


@router.get("/overview/window", dependencies=SHARED_MAP, summary="Window of the image from above")
async def overview_window(
    project_id: str, server: Server, caller: CalledBy, *, source: str = ""
) -> WindowSpec:
    """Left, bottom, right and top in the map [m]."""
    image = await _overview(project_id, server, caller, source=source)
    return await run_in_threadpool(readers.read_window, image.with_suffix(".json"))


@router.get("/walk", dependencies=SHARED, summary="Where the walk was during a stretch")
async def walk(
    project_id: str, server: Server, caller: CalledBy, *, start_s: Second, end_s: Second
) -> WalkStretch:
    """Positions in the latest map, to mark the stretch of a finding."""
    artifacts = await run_in_threadpool(server.slices.artifacts, project_id)
    terms = server.slices.terms(project_id, caller.name)
    span_s = (start_s, end_s)
    return await caller.wait(
        server.slices.run_interactive(terms, slice_work.walk_stretch, artifacts, span_s)
    )


@router.post("/pick", dependencies=SHARED, summary="The point of the map at a position on a slice")
async def pick(
    project_id: str, ask: PickRequest, server: Server, *, caller: CalledBy, who: Who
) -> PickView:
    """Coordinates of the nearest full-resolution point, in the map and in its CRS."""
    of_shared_map(who, ask.source)
    artifacts = await run_in_threadpool(server.slices.artifacts, project_id, ask.source)
    terms = server.slices.terms(project_id, caller.name, ask.source)
    ask.plane.slice_plane()  # an invalid plane is rejected before the request waits
    return await caller.wait(
        server.slices.run_interactive(terms, slice_work.pick_point, artifacts, ask)
    )


@router.get("/doubles", dependencies=LOOK, summary="Double walls")
async def doubles(
    project_id: str, server: Server, caller: CalledBy, *, source: str = ""
) -> DoubleReport:
    """Surfaces visited twice: double walls, then the others by ratio of separation and limit."""
    artifacts = await run_in_threadpool(server.slices.artifacts, project_id, source)
    folder = artifacts["map"]
    terms = server.slices.terms(project_id, caller.name, source)
    path = await caller.wait(
        server.slices.kept(
            f"{Path(folder).name}-surfaces.json",
            lambda out: server.slices.run_background(
                replace(terms, outputs={SURFACES: out}), slice_work.double_walls, folder, SURFACES
            ),
        )
    )
    return await run_in_threadpool(readers.read_double_walls, path)


@router.post("/compare", dependencies=LOOK, summary="Compare slices with a reference")
async def compare(
    project_id: str, ask: CompareRequest, server: Server, *, caller: CalledBy
) -> Comparison:
    """Mean distance and ratios within 2 and 5 cm of every slice (V Table 3.2)."""
    artifacts = await run_in_threadpool(server.slices.artifacts, project_id, ask.source)
    reference = server.slices.reference(project_id, ask.reference)
    terms = server.slices.terms(project_id, caller.name, ask.source)
    return await caller.wait(
        server.slices.run_background(
            terms, slice_work.comparison, artifacts["map"], reference, ask, language=caller.language
        )
    )


@router.delete(
    "/references/{reference_id}", status_code=204, dependencies=PROCESS, summary="Remove it"
)
def remove_reference(project_id: str, reference_id: str, server: Server) -> Response:
    """Remove a reference; the imported source file stays."""
    server.slices.remove_reference(project_id, reference_id)
    return Response(status_code=204)  # without a content type: there is no JSON in it


@router.get(
    "/export.{ending}", response_class=FileResponse, dependencies=LOOK, summary="Export slices"
)
async def export(
    project_id: str,
    ending: Literal["png", "svg", "pdf", "tif", "dxf", "laz", "csv"],
    ask: str,
    *,
    server: Server,
    caller: CalledBy,
) -> FileResponse:
    """PNG, SVG and PDF are sheets at a true scale; ``ask`` is a SliceExportRequest as JSON.

    The work is canceled when the client disconnects. A finished file is kept for a day: the same
    request with ``Range`` continues an interrupted download.
    """
    asked = _parsed(ask)
    slices = server.slices
    evidence = await run_in_threadpool(slices.evidence, project_id, asked.source, draft=asked.draft)
    artifacts = await run_in_threadpool(
        slices.approved_artifacts, project_id, asked.source, evidence
    )
    project = await run_in_threadpool(server.projects.get, project_id)
    context = ExportContext(project.name, Path(artifacts["map"]).name, evidence)
    request = ExportRequest(
        ending=ending,
        ask=asked,
        artifacts=artifacts,
        reference=slices.reference(project_id, asked.reference),
        context=context,
    )
    terms = slices.terms(project_id, caller.name, asked.source)
    return FileResponse(
        await caller.wait(slices.exports.make(request, terms)),
        filename=f"{project_id}-slice.{ending}",
        media_type="application/octet-stream",
    )


@router.post("/control/preview", dependencies=PROCESS, summary="Preview a survey file")
async def preview_control(
    project_id: str, file: ControlFile, server: Server, *, caller: CalledBy
) -> ControlPreview:
    """Points found in a table or DXF, and the question to answer before they are stored."""
    folder = server.projects.folder(project_id)
    try:
        data = base64.b64decode(file.base64, validate=True)
    except (binascii.Error, ValueError) as error:
        raise BadRequest(CodedText("file-not-base64")) from error
    crs = str(((await run_in_threadpool(read_summary, folder)) or {}).get("crs") or "")
    artifacts = await run_in_threadpool(server.slices.artifacts, project_id)
    return await caller.wait(
        server.slices.run_background(
            server.slices.terms(project_id, caller.name),
            control_work.preview_control,
            control_work.SurveyFile(data, file.name, crs),
            file.choice,
            artifacts,
        )
    )


@router.get("/control", dependencies=LOOK, summary="Control and check points")
def read_control(project_id: str, server: Server) -> ControlState:
    """The stored points, with their positions in the map."""
    return server.slices.survey.read(project_id)


@router.put("/control", dependencies=PROCESS, summary="Store control and check points")
def keep_control(project_id: str, state: ControlState, server: Server) -> ControlState:
    """The points are on disk before the response is sent."""
    return server.slices.survey.keep(project_id, state)


@router.get("/control/report", dependencies=LOOK, summary="Residuals")
async def control_report(
    project_id: str, server: Server, caller: CalledBy, *, language: Language
) -> ControlReport:
    """Map minus survey, separate for control and check points, with every limit."""
    artifacts = await run_in_threadpool(server.slices.artifacts, project_id)
    state = await run_in_threadpool(server.slices.survey.read, project_id)
    terms = server.slices.terms(project_id, caller.name)
    return await caller.wait(
        server.slices.run_interactive(
            terms, control_work.control_report, artifacts, state, language
        )
    )


@router.get("/control/report.{ending}", dependencies=LOOK, summary="Residuals as a file")
async def control_file(
    project_id: str,
    ending: Literal["csv", "html"],
    server: Server,
    *,
    caller: CalledBy,
    draft: bool = False,
) -> Response:
    """CSV, or a sheet to print and sign; both name the map and, except a draft, its approval."""
    slices = server.slices
    artifacts = await run_in_threadpool(slices.artifacts, project_id)
    state = await run_in_threadpool(slices.survey.read, project_id)
    project = await run_in_threadpool(server.projects.get, project_id)
    evidence = await run_in_threadpool(slices.evidence, project_id, draft=draft)
    context = ExportContext(project.name, Path(artifacts["map"]).name, evidence)
    terms = slices.terms(project_id, caller.name)
    text = await caller.wait(
        slices.run_interactive(
            terms, control_work.control_file, artifacts, state, ending, context=context
        )
    )
    if ending == "csv":
        head = {"Content-Disposition": f'attachment; filename="{project_id}-control.csv"'}
        return PlainTextResponse(text, media_type="text/csv; charset=utf-8", headers=head)
    return HTMLResponse(text, headers={"Content-Security-Policy": REPORT_POLICY})


@router.get("/control/surface", dependencies=LOOK, summary="The map's surface at a surveyed point")
async def surface(project_id: str, point: str, server: Server, *, caller: CalledBy) -> SurfacePoint:
    """Position of a surveyed point in the map, and its foot on the nearest surface."""
    artifacts = await run_in_threadpool(server.slices.artifacts, project_id)
    state = await run_in_threadpool(server.slices.survey.read, project_id)
    found: list[Xyz] = [one.xyz_m for one in state.points if one.id == point]
    if not found:
        raise ConfigError(CodedText("control-point-unknown", name=point[:64]))
    terms = server.slices.terms(project_id, caller.name)
    return await caller.wait(
        server.slices.run_interactive(
            terms, slice_work.surface_at, artifacts, found[0], state.frame
        )
    )


@router.get(
    "/compare.csv", response_class=PlainTextResponse, dependencies=LOOK, summary="The table as CSV"
)
async def compare_csv(
    project_id: str, ask: str, server: Server, *, caller: CalledBy
) -> PlainTextResponse:
    """``ask`` is a CompareRequest as JSON."""
    asked = _parsed_compare(ask)
    artifacts = await run_in_threadpool(server.slices.artifacts, project_id, asked.source)
    reference = server.slices.reference(project_id, asked.reference)
    terms = server.slices.terms(project_id, caller.name, asked.source)
    text = await caller.wait(
        server.slices.run_background(
            terms, slice_work.comparison_csv, artifacts["map"], reference, asked
        )
    )
    head = {"Content-Disposition": f'attachment; filename="{project_id}-comparison.csv"'}
    return PlainTextResponse(text, media_type="text/csv; charset=utf-8", headers=head)


async def _overview(project_id: str, server: Server, caller: Caller, *, source: str) -> Path:
    artifacts = await run_in_threadpool(server.slices.artifacts, project_id, source)
    folder = artifacts["map"]
    terms = server.slices.terms(project_id, caller.name, source)
    image, about = "above.png", "above.json"

    async def make(out: Path) -> None:
        # The image is written last: if it exists, its window exists too.
        made = replace(terms, outputs={about: out.with_suffix(".json"), image: out})
        await server.slices.run_interactive(made, slice_work.overview, folder, image, about)

    return await caller.wait(server.slices.kept(f"{Path(folder).name}-above.png", make))


def _parsed(text: str) -> SliceExportRequest:
    try:
        return SliceExportRequest.model_validate_json(text)
    except ValueError as error:
        raise ConfigError(CodedText("export-malformed", detail=str(error))) from error


def _parsed_compare(text: str) -> CompareRequest:
    try:
        return CompareRequest.model_validate_json(text)
    except ValueError as error:
        raise ConfigError(CodedText("compare-malformed", detail=str(error))) from error
