"""The commands ``recon4 plan``, ``recon4 orthophoto`` and ``recon4 terrain``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from recon4.cli.confinement import confine_command
from recon4.cli.exports import DraftOption
from recon4.cli.slices import ProjectArgument, numbers
from recon4.cli.terminal import write
from recon4.errors import ConfigError

if TYPE_CHECKING:
    from recon4.api.maps import OpenedMap
    from recon4.products.terrain import TerrainKind
    from recon4.products.write import ProductKind, ProductOptions

products = typer.Typer()

CrsOption = Annotated[str, typer.Option(help="As EPSG:5514+8357; default: the map's.")]


@products.command("plan")
def plan(
    project: ProjectArgument,
    file: Annotated[Path, typer.Argument(help="File to write: .dxf .geojson .png")],
    *,
    storey: Annotated[str, typer.Option(help="Only this one: 0, 1, -1; default: all.")] = "",
    crs: CrsOption = "",
    draft: DraftOption = False,
) -> None:
    """Draw the floor plans of a building: walls, columns, doors, windows, furniture as lines."""
    from recon4.products.write import ProductOptions

    options = ProductOptions(storey=storey)
    write(_made("plan", _open(project, file, crs, draft=draft), file, options))


@products.command("orthophoto")
def orthophoto(
    project: ProjectArgument,
    file: Annotated[Path, typer.Argument(help="File to write: .tif (and .tfw) or .png")],
    *,
    storey: Annotated[str, typer.Option(help="0, 1, -1; default: 0, where the walk begins.")] = "",
    line: Annotated[
        str, typer.Option(help="An elevation, seen from X1,Y1 (left) to X2,Y2 (right), in m.")
    ] = "",
    depth: Annotated[float, typer.Option(help="Of an elevation, around its line, in m.")] = 1.0,
    pixel: Annotated[float, typer.Option(help="Edge of a pixel in m.")] = 0.01,
    crs: CrsOption = "",
    draft: DraftOption = False,
) -> None:
    """Draw a storey from above, or the elevation of a wall, by normalized intensity."""
    from recon4.products.write import ProductOptions

    x1, y1, x2, y2 = numbers(line, 4) if line else [0.0] * 4
    options = ProductOptions(
        storey=storey, line=(x1, y1, x2, y2) if line else None, depth_m=depth, pixel_m=pixel
    )
    write(_made("orthophoto", _open(project, file, crs, draft=draft), file, options))


@products.command("terrain")
def terrain_of(  # noqa: PLR0913 - options of a command
    project: ProjectArgument,
    file: Annotated[
        Path, typer.Argument(help="Heights: .tif (and .tfw); contours: .dxf .geojson; .png")
    ],
    *,
    surface: Annotated[
        str, typer.Option(help="dtm (the ground) or dsm (what is highest).")
    ] = "dtm",
    cell: Annotated[float, typer.Option(help="Edge of a cell in m.")] = 0.25,
    interval: Annotated[float, typer.Option(help="Between contours, in m.")] = 0.5,
    polygon: Annotated[
        str, typer.Option(help="Also print the volume inside of X1,Y1,X2,Y2,X3,Y3… in m.")
    ] = "",
    base: Annotated[
        float | None, typer.Option(help="Height of its plane in m; default: fitted to its border.")
    ] = None,
    crs: CrsOption = "",
    draft: DraftOption = False,
) -> None:
    """Model the terrain of an outdoor walk: heights, contours, a volume over a plane."""
    from recon4.products.write import ProductOptions

    if surface not in ("dtm", "dsm"):
        raise ConfigError(f"a surface is dtm or dsm, got {surface!r}")
    kind: TerrainKind = "dtm" if surface == "dtm" else "dsm"
    options = ProductOptions(surface=kind, cell_m=cell, interval_m=interval)
    opened = _open(project, file, crs, draft=draft)
    write(_made("terrain", opened, file, options))
    if polygon:
        write(_volume(opened, options, polygon, base=base))


def _open(project: Path, file: Path, crs: str, *, draft: bool) -> OpenedMap:
    confine_command(write=[file.parent])
    from recon4.api.maps import open_map
    from recon4.review.approval_state import latest_state

    opened = open_map(project, draft=draft, crs=crs)
    write(latest_state(project, draft=draft).text)
    return opened


def _made(kind: ProductKind, opened: OpenedMap, file: Path, options: ProductOptions) -> str:
    from recon4.products.write import ProductSource, write_product

    source = ProductSource(opened.tiles, opened.frame, opened.stamp)
    return f"{write_product(kind, source, file, options)}\nin {file}"


def _volume(opened: OpenedMap, options: ProductOptions, polygon: str, *, base: float | None) -> str:
    """The volume inside of a polygon of the map or its CRS, in words."""
    from dataclasses import replace

    import numpy as np

    from recon4.products.terrain import terrain
    from recon4.products.volume import volume
    from recon4.products.write import up_to_crs

    corners = np.reshape(numbers(polygon, 2 * (1 + polygon.count(",")) // 2), (-1, 2))
    made = terrain(opened.tiles, options.surface, cell_m=options.cell_m)
    up_m = up_to_crs(made, opened.frame)
    if opened.frame.to_crs:
        raised = np.column_stack([corners, np.full(len(corners), up_m)])
        corners = opened.frame.from_crs(raised)[:, :2]
    found = volume(made, corners, base_m=None if base is None else base - up_m)
    return replace(found, base_m=found.base_m + up_m).text
