"""Tools for files and images: exports, downloads, slices."""

from __future__ import annotations

import base64
from pathlib import Path
from typing import Annotated

from mcp.server.mcpserver import Image
from mcp.server.mcpserver.exceptions import ToolError
from pydantic import Field

from recon4_app.assistant.arguments import Color, Crs, FileName, Meters, ProjectId, Xy
from recon4_app.assistant.http_client import ServerClient
from recon4_app.assistant.job_tools import ended_job
from recon4_app.assistant.records import (
    Downloaded,
    ExportList,
    FileAddress,
    MapExtent,
    OrderedExport,
    ProjectFacts,
    ShownSlice,
)
from recon4_app.assistant.tuning import ASSISTANT

WRITTEN = (
    *("map.copc.laz", "map.laz", "map.e57", "map.ply", "map.pcd", "map.xyz"),
    "map.ptx",
    *("findings.csv", "findings.geojson", "report.pdf"),
)
"""What the server writes of a map when it is asked to."""


class FileTools:
    """Tools that change no project; downloads go to one folder of this computer."""

    def __init__(self, server: ServerClient, downloads: Path | None) -> None:
        self._server, self._downloads = server, downloads

    async def list_exports(self, project: ProjectId) -> ExportList:
        """List the files of a project, and those that the server writes of its map."""
        facts = await self._server.get(f"api/projects/{project}", ProjectFacts)
        written = list(WRITTEN) if facts.has_map else []
        return ExportList(files=facts.files, written_on_request=written)

    async def download_export(
        self, project: ProjectId, file: FileName, crs: Crs = ""
    ) -> Downloaded:
        """Download a file to the folder for downloads of this computer; nothing is overwritten.

        A file of the map is made first, and stands in the list of exports.
        """
        assert self._downloads is not None  # else this is no tool
        path = await self._path(project, file, crs)
        target = _free_name(self._downloads / f"{project}-{file}")
        return await self._server.download(path, target)

    async def export_address(
        self, project: ProjectId, file: FileName, crs: Crs = ""
    ) -> FileAddress:
        """Say where a file is downloaded: GET with the same `Authorization` as this session.

        A file of the map is made first, and stands in the list of exports.
        """
        return FileAddress(url=self._server.url + await self._path(project, file, crs))

    async def _path(self, project: str, file: str, crs: str) -> str:
        """Path of a file on the server; one of the map is made first."""
        facts = await self._server.get(f"api/projects/{project}", ProjectFacts)
        results = {one.name for one in facts.files}
        if file.startswith("map.") and file in WRITTEN and (crs or file not in results):
            return await self._exported(project, file, crs)
        return _address(project, file, crs, results=results)

    async def _exported(self, project: str, file: str, crs: str) -> str:
        """Path of a file of the map, ordered if nobody did before."""
        base = f"api/projects/{project}/exports"
        order = {"file": file, "options": {"crs": crs}}
        made = await self._server.post(base, OrderedExport, order)
        ended = await ended_job(self._server, made.id, wait_s=ASSISTANT.longest_wait_s)
        if not ended.over:
            raise ToolError(f"{file} is still being made: ask for it again later")
        if ended.job.state != "succeeded":
            raise ToolError(f"{file} was not made: {ended.job.note or ended.job.state}")
        return f"{base}/{made.id}/file"

    async def slice_image(
        self,
        project: ProjectId,
        *,
        z_m: Annotated[
            Meters | None,
            Field(description="Height of a horizontal slice; none = 1.2 m over the first floor."),
        ] = None,
        ends_m: Annotated[
            tuple[Xy, Xy] | None, Field(description="Ends of a vertical slice, seen from above.")
        ] = None,
        thickness_m: Annotated[float, Field(gt=0.0, le=5.0)] = 0.1,
        color: Color = "height",
    ) -> list[Image | str]:
        """Show a horizontal or vertical slice of the map: double walls and drift are visible."""
        plane: dict[str, object] = {"thickness_m": thickness_m}
        if ends_m is not None:
            plane |= {"kind": "vertical", "a_m": ends_m[0], "b_m": ends_m[1]}
        else:
            height_m = await self._height(project) if z_m is None else z_m
            plane |= {"kind": "horizontal", "z_m": height_m}
        side = ASSISTANT.image_px
        asked = {"plane": plane, "width": side, "height": side, "color": color}
        path = f"api/projects/{project}/slices/image"
        found = await self._server.post(path, ShownSlice, asked)
        about = (
            f"{found.name}: {found.points} points, {found.pixel_m * 100.0:.1f} cm a pixel, "
            f"{color} from {found.low:.3g} to {found.high:.3g}"
        )
        return [Image(data=base64.b64decode(found.png), format="png"), about]

    async def _height(self, project: str) -> float:
        """Where a horizontal slice shows walls: over the lowest floor that was walked on."""
        extent = await self._server.get(f"api/projects/{project}/map", MapExtent)
        if extent.storeys:
            return min(storey.floor_m for storey in extent.storeys) + ASSISTANT.eye_m
        return (extent.low_m[2] + extent.high_m[2]) / 2.0


def _address(project: str, file: str, crs: str, *, results: set[str]) -> str:
    """Path of a file on the server that is no export of the map."""
    base = f"api/projects/{project}"
    if file in results and not crs:
        return f"{base}/files/{file}"
    if file not in WRITTEN:
        names = ", ".join(sorted({*results, *WRITTEN}))
        raise ToolError(f"{project} has no {file}; expected one of {names}")
    if crs:
        raise ToolError(f"{file} is written in the CRS of the map: leave crs out")
    return f"{base}/{file}"


def _free_name(path: Path) -> Path:
    """The path, or one with a number if there is such a file."""
    stem, _, endings = path.name.partition(".")
    number, free = 1, path
    while free.exists():
        number += 1
        free = path.with_name(f"{stem}-{number}.{endings}")
    return free
