"""The command ``recon4 slice``: slices of a map as files, and the check for double walls."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from recon4.cli.confinement import confine_command
from recon4.cli.references import (
    ColumnsOption,
    FrameOption,
    ReferenceOption,
    UnitOption,
    open_reference,
)
from recon4.cli.terminal import say, say_approval
from recon4.errors import ConfigError
from recon4.locales.coded import CodedText

if TYPE_CHECKING:
    from recon4.slices.slice_plane import SlicePlane

slices = typer.Typer()


ProjectArgument = Annotated[Path, typer.Argument(help="Folder that `recon4 process --out` made.")]


@slices.command("slice")
def cut_map(  # noqa: PLR0913 - options of a command
    project: ProjectArgument,
    file: Annotated[Path, typer.Argument(help="File to write: .png .svg .pdf .tif .dxf .laz .csv")],
    *,
    z: Annotated[float | None, typer.Option(help="Horizontal, at this height in m.")] = None,
    line: Annotated[str, typer.Option(help="Vertical, through two points: X1,Y1,X2,Y2 in m.")] = "",
    plane: Annotated[str, typer.Option(help="Free: X,Y,Z,NX,NY,NZ (point and normal).")] = "",
    thickness: Annotated[float, typer.Option(help="Thickness in m.")] = 0.10,
    count: Annotated[int, typer.Option(help="Number of slices, one behind the other.")] = 1,
    spacing: Annotated[float, typer.Option(help="Distance between repeated slices, in m.")] = 0.5,
    color: Annotated[
        str, typer.Option(help="height, intensity, normalized, time or sensor.")
    ] = "height",
    draft: Annotated[
        bool, typer.Option("--draft", help="Without approval, whether or not there is one.")
    ] = False,
    reference: ReferenceOption = None,
    columns: ColumnsOption = "",
    unit: UnitOption = "",
    frame_of_reference: FrameOption = "auto",
) -> None:
    """Cut a map and write the slice, at full resolution. It carries the map's approval."""
    confine_command(write=[file.parent])
    from recon4.api.maps import open_map
    from recon4.api.slices import SliceLook, write_planes
    from recon4.review.approval_state import latest_state

    planes = _slice_plane(z, line, plane, thickness_m=thickness).repeated(count, spacing_m=spacing)
    opened = open_map(project, draft=draft)
    reading = (columns, unit, frame_of_reference)
    with open_reference(reference, reading, tiles=opened.tiles, frame=opened.frame) as against:
        look = SliceLook("distance" if against else color, project.name, against)
        points = write_planes(opened, planes, file, look=look)
    state = latest_state(project, draft=draft)
    is_thinned = file.suffix.lower() == ".dxf"
    say("slice-thinned" if is_thinned else "slice-written", points=points, file=str(file))
    say_approval(state)


@slices.command("doubles")
def double_walls(project: ProjectArgument) -> None:
    """Look for walls that two visits put at two places; exit code 1 if there are any."""
    confine_command()
    from recon4.cli.terminal import watcher
    from recon4.mapping.tiles import TileSet
    from recon4.slices.doubles import find_double_walls
    from recon4.slices.map_crs import frame_of
    from recon4.store.project import read_artifacts

    artifacts = read_artifacts(project)
    frame_of(artifacts)
    with watcher() as progress:
        found = find_double_walls(TileSet.open(artifacts["map"]), progress=progress)
    for wall in found.walls:
        x, y, z = wall.middle_m
        (a0, a1), (b0, b1) = wall.spans_s
        say(
            "doubles-wall",
            place=f"{x:9.2f} {y:9.2f} {z:7.2f}",
            apart_cm=100 * wall.separation_m,
            limit_cm=100 * wall.limit_m,
            spans=f"{a0:.0f}-{a1:.0f} s, {b0:.0f}-{b1:.0f} s",
        )
    say("doubles-found", count=len(found.walls), patches=found.patches)
    if found.walls:
        raise typer.Exit(1)


def _slice_plane(z: float | None, line: str, plane: str, *, thickness_m: float) -> SlicePlane:
    from recon4.slices.slice_plane import SlicePlane

    if (z is not None) + bool(line) + bool(plane) != 1:
        raise ConfigError(CodedText("slice-where"))
    if z is not None:
        return SlicePlane.horizontal(z, thickness_m=thickness_m)
    if line:
        x1, y1, x2, y2 = numbers(line, 4)
        return SlicePlane.vertical((x1, y1), (x2, y2), thickness_m=thickness_m)
    px, py, pz, nx, ny, nz = numbers(plane, 6)
    return SlicePlane.free((px, py, pz), (nx, ny, nz), thickness_m=thickness_m)


def numbers(text: str, count: int) -> list[float]:
    """Numbers of an option, with commas between them."""
    try:
        values = [float(word) for word in text.split(",")]
    except ValueError as error:
        raise ConfigError(CodedText("numbers-commas", count=count, text=text)) from error
    if len(values) != count:
        raise ConfigError(CodedText("numbers-commas", count=count, text=text))
    return values
