"""HTTP routes of the page *Map*: index, points and picks of a map."""

from __future__ import annotations

from dataclasses import replace
from html import escape
from pathlib import Path
from typing import Annotated
from urllib.parse import quote

from fastapi import APIRouter, Depends, Query, Request, Response
from starlette.concurrency import run_in_threadpool

from recon4.first_view.cubes import CubeFile
from recon4.first_view.records import MapIndex
from recon4.first_view.tuning import MAP_CHUNKS
from recon4.live.session import CaptureSession
from recon4.locales.coded import CodedText
from recon4_app.access.people import Permission, Who, needs
from recon4_app.deps import Server, parts
from recon4_app.error_responses import problems
from recon4_app.errors import BadRequest, Conflict, NotFound
from recon4_app.map_view import map_work
from recon4_app.map_view.model import (
    ChunkQuery,
    MapVolume,
    MapWalk,
    PointsInCrs,
    PointsInMap,
    RayHit,
    RayRequest,
    SampleQuery,
    VolumeRequest,
)
from recon4_app.map_view.shown_map import ShownMap
from recon4_app.network.behind import prefix_of
from recon4_app.network.request_caller import CalledBy, Caller

SHARED = [Depends(needs(Permission.SHARED))]
_UNQUOTED = "!~*'()"
"""What `encodeURIComponent` leaves as it is, besides letters, digits and ``-_.``."""
BYTES = "application/octet-stream"
FOREVER = "private, max-age=31536000, immutable"
"""Chunks are named by the hash of their map: they never change."""

router = APIRouter(
    prefix="/api/projects/{project_id}/map",
    tags=["map"],
    dependencies=SHARED,
    responses=problems(404, 422),
)


def page_preloads(project_id: str, request: Request) -> str:
    """Links to what the page *Map* reads first: a browser requests it beside the scripts.

    Their addresses are those of `web/shared/api/map.js`, to the letter.
    """
    project = f"{prefix_of(request.scope)}/api/projects/{quote(project_id, safe=_UNQUOTED)}"
    first = [f"{prefix_of(request.scope)}/api/me", project]
    try:
        key = Path(parts(request).slices.artifacts(project_id)["map"]).name
    except NotFound:
        pass  # without a map the page leads to that of the project
    else:
        sample = f"{project}/map/{key}/sample?stored=xyz&version={MAP_CHUNKS.version}"
        first += [f"{project}/map?key=", sample]
    link = '<link rel="preload" as="fetch" crossorigin="anonymous" href="{}" />'
    return "".join(f"{link.format(escape(one))}\n    " for one in first)


@router.get("", summary="What is in the map", response_model=MapIndex)
async def read_index(
    project_id: str, server: Server, caller: CalledBy, *, key: str = ""
) -> Response:
    """Tiles with boxes and counts, columns, an extent without stray points, storeys, frame.

    With ``key`` those of an earlier map.
    """
    shown = await ShownMap.of(server.slices, project_id, person=caller.name, key=key)
    return Response(await caller.wait(shown.index()), media_type="application/json")


@router.get("/walk", summary="The walk and the nodes of the graph")
async def read_walk(project_id: str, server: Server, caller: CalledBy, *, who: Who) -> MapWalk:
    """Positions with times after the first pose, and marks of the operator of a live capture.

    A long walk is thinned out. Guests get no marks: they are notes for the team.
    """
    artifacts = await run_in_threadpool(server.slices.artifacts, project_id)
    terms = server.slices.terms(project_id, caller.name)
    marks = CaptureSession(project=server.projects.folder(project_id)).marks
    if who.project or not marks.is_file() or marks.is_symlink():
        return await caller.wait(server.slices.run_interactive(terms, map_work.walk, artifacts, ""))
    terms = replace(terms, access=replace(terms.access, read=(*terms.access.read, marks)))
    return await caller.wait(
        server.slices.run_interactive(terms, map_work.walk, artifacts, str(marks))
    )


@router.post(
    "/pick",
    summary="The point of the map that a ray hits",
    responses=problems(409),
)
async def pick(project_id: str, ask: RayRequest, *, server: Server, caller: CalledBy) -> RayHit:
    """Of all points of the map that the clip planes leave, not only of those on screen."""
    artifacts = await run_in_threadpool(server.slices.artifacts, project_id)
    _check_key(artifacts, ask.key)
    terms = server.slices.terms(project_id, caller.name)
    return await caller.wait(server.slices.run_interactive(terms, map_work.hit, artifacts, ask))


@router.get("/{key}/sample", response_class=Response, summary="A sample of the whole map")
async def read_sample(
    project_id: str, key: str, *, part: Annotated[SampleQuery, Query()], caller: CalledBy
) -> Response:
    """The first points of every cube, as many as the index says, each as a part of `cubes`."""
    coarse = await _coarse(caller, project_id, key, query=part)
    if coarse is None:
        return Response(status_code=304, headers=_kept_headers(key, part))
    data = await run_in_threadpool(coarse.sample)
    return Response(data, media_type=BYTES, headers=_kept_headers(key, part))


@router.get("/{key}/cubes", response_class=Response, summary="Coarse points of several tiles")
async def read_cubes(
    project_id: str, key: str, *, wanted: Annotated[ChunkQuery, Query()], caller: CalledBy
) -> Response:
    """Binary, part by part, each as `recon4.first_view.cubes` says; may be kept for ever."""
    _check_parts(wanted.rows)
    coarse = await _coarse(caller, project_id, key, query=wanted)
    if coarse is None:
        return Response(status_code=304, headers=_kept_headers(key, wanted))
    data = await run_in_threadpool(coarse.read, wanted.rows)
    return Response(data, media_type=BYTES, headers=_kept_headers(key, wanted))


@router.get("/{key}/points", response_class=Response, summary="Points of some tiles")
async def read_points(
    request: Request,
    project_id: str,
    key: str,
    *,
    wanted: Annotated[ChunkQuery, Query()],
    caller: CalledBy,
) -> Response:
    """Binary, part by part, each as `recon4.first_view.points` says; may be kept for ever."""
    _check_version(wanted.version)
    rows = wanted.rows
    _check_parts(rows)
    slices, source = parts(request).slices, f"map:{key}"
    artifacts = await run_in_threadpool(slices.artifacts, project_id, source)
    headers = _kept_headers(key, wanted)
    if request.headers.get("if-none-match") == headers["ETag"]:
        return Response(status_code=304, headers=headers)
    evidence = await run_in_threadpool(slices.evidence_to_show, project_id, source)
    terms = slices.terms(project_id, caller.name, source)
    data = await caller.wait(
        slices.run_interactive(
            terms, map_work.chunk, artifacts, wanted.stored, rows, evidence=evidence
        )
    )
    return Response(data, media_type=BYTES, headers=headers)


@router.post("/crs", summary="Points of the map in its CRS", responses=problems(409))
async def put_into_crs(
    project_id: str, ask: PointsInMap, *, server: Server, caller: CalledBy
) -> PointsInCrs:
    """East, north and height of points of measurements, in the CRS of the map."""
    artifacts = await run_in_threadpool(server.slices.artifacts, project_id)
    _check_key(artifacts, ask.key)
    terms = server.slices.terms(project_id, caller.name)
    return await caller.wait(server.slices.run_interactive(terms, map_work.in_crs, artifacts, ask))


@router.post(
    "/volume",
    summary="A volume over a plane",
    responses=problems(409),
)
async def read_volume(
    project_id: str, ask: VolumeRequest, *, server: Server, caller: CalledBy
) -> MapVolume:
    """What lies above and below a plane inside of a polygon, of the heights that are shown."""
    artifacts = await run_in_threadpool(server.slices.artifacts, project_id)
    _check_key(artifacts, ask.key)
    terms = server.slices.terms(project_id, caller.name)
    return await caller.wait(
        server.slices.run_interactive(terms, map_work.map_volume, artifacts, ask)
    )


def _check_key(artifacts: dict[str, str], key: str) -> None:
    """Refuse what was asked of an earlier map: its place in the CRS may be another."""
    if Path(artifacts["map"]).name != key:
        raise Conflict(CodedText("map-remade-measure"))


async def _coarse(
    caller: Caller, project_id: str, key: str, *, query: SampleQuery
) -> CubeFile | None:
    """The coarse points of a map; None = the browser has what it asks for."""
    _check_version(query.version)
    slices = parts(caller.request).slices
    shown = await ShownMap.of(slices, project_id, person=caller.name, key=key)
    if caller.request.headers.get("if-none-match") == _kept_headers(key, query)["ETag"]:
        return None
    return await caller.wait(shown.coarse(query.stored))


def _kept_headers(key: str, query: SampleQuery) -> dict[str, str]:
    """Of points that browsers keep; a tag is only compared with those of the same address."""
    which = query.parts.replace(",", "-") if isinstance(query, ChunkQuery) else "sample"
    tag = f'"{MAP_CHUNKS.version}-{key}-{query.stored}-{which}"'
    return {"ETag": tag, "Cache-Control": FOREVER}


def _check_version(version: int) -> None:
    """Refuse a page that an earlier recon4 sent: it would take the bytes for something else."""
    if version != MAP_CHUNKS.version:
        raise Conflict(CodedText("map-layout", version=MAP_CHUNKS.version, got=version))


def _check_parts(rows: tuple[tuple[int, int, int], ...]) -> None:
    """Refuse a part without points, and more than a response may have."""
    counts = [stop - start for _, start, stop in rows]
    if min(counts) <= 0 or sum(counts) > MAP_CHUNKS.max_chunk_points:
        got = ", ".join(f"{start} to {stop}" for _, start, stop in rows[:3])
        raise BadRequest(CodedText("chunk-invalid", limit=MAP_CHUNKS.max_chunk_points, got=got))
    if len(rows) > MAP_CHUNKS.max_parts:
        raise BadRequest(CodedText("chunks-too-many", limit=MAP_CHUNKS.max_parts, got=len(rows)))
