"""The commands ``recon4 plan``, ``recon4 orthophoto``, ``recon4 terrain`` and
``recon4 volume``.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from recon4.cli.confinement import confine_command
from recon4.cli.exports import DraftOption
from recon4.cli.slices import ProjectArgument, numbers
from recon4.cli.terminal import in_terminal, say, say_approval, write
from recon4.errors import ConfigError
from recon4.locales.coded import CodedText

if TYPE_CHECKING:
    from recon4.api.maps import OpenedMap
    from recon4.products.terrain import TerrainKind
    from recon4.products.write import ProductKind, ProductOptions

products = typer.Typer()

SurfaceOption = Annotated[
    str, typer.Option(help="dtm (the ground) or dsm (what is highest: heaps, roofs).")
]
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
    opened = _open(project, file, crs, draft=draft)
    from recon4.products.write import ProductOptions

    _make("plan", opened, file, options=ProductOptions(storey=storey))


@products.command("orthophoto")
def orthophoto(
    project: ProjectArgument,
    file: Annotated[Path, typer.Argument(help="File to write: .tif (and .tfw) or .png")],
    *,
    of: Annotated[
        str,
        typer.Option(
            help="A storey from above: 0, 1, -1. Or an elevation: X1,Y1,X2,Y2 in m, seen with "
            "the first point on the left, and its depth: X1,Y1,X2,Y2,1.2."
        ),
    ] = "0",
    pixel: Annotated[float, typer.Option(help="Edge of a pixel in m.")] = 0.01,
    crs: CrsOption = "",
) -> None:
    """Draw a storey from above, or the elevation of a wall, by normalized intensity."""
    opened = _open(project, file, crs)
    from recon4.products.write import ProductOptions

    options = ProductOptions(storey=of, pixel_m=pixel)
    if "," in of:
        x1, y1, x2, y2, *depth = numbers(of, 5 if of.count(",") == 4 else 4)
        options = replace(options, storey="", line=(x1, y1, x2, y2))
        options = replace(options, depth_m=depth[0]) if depth else options
    _make("orthophoto", opened, file, options=options)


@products.command("terrain")
def terrain_of(
    project: ProjectArgument,
    file: Annotated[
        Path, typer.Argument(help="Heights: .tif (and .tfw); contours: .dxf .geojson; .png")
    ],
    *,
    surface: SurfaceOption = "dtm",
    spacing: Annotated[
        float | None,
        typer.Option(help="Cell of heights, or between contours, in m; default: 0.25, 0.5."),
    ] = None,
    crs: CrsOption = "",
) -> None:
    """Model the terrain of an outdoor walk: its heights, or contours of the ground."""
    opened = _open(project, file, crs)
    from recon4.products.drawing import DRAWINGS
    from recon4.products.write import ProductOptions

    options = ProductOptions(surface=_surface(surface))
    if spacing is not None:
        lines = file.suffix.lower() in DRAWINGS
        options = (
            replace(options, interval_m=spacing) if lines else replace(options, cell_m=spacing)
        )
    _make("terrain", opened, file, options=options)


@products.command("volume")
def volume_of(
    project: ProjectArgument,
    polygon: Annotated[str, typer.Argument(help="Its corners: X1,Y1,X2,Y2,X3,Y3… in m.")],
    *,
    base: Annotated[
        float | None, typer.Option(help="Height of the plane in m; default: fitted to the border.")
    ] = None,
    surface: SurfaceOption = "dsm",
    crs: CrsOption = "",
) -> None:
    """Say how much lies above and below a plane inside of a polygon, as a heap, and how sure."""
    confine_command()
    from recon4.api.maps import open_map

    opened = open_map(project, crs=crs)
    write(in_terminal(_volume(opened, polygon, surface=_surface(surface), base=base)))


def _surface(name: str) -> TerrainKind:
    if name not in ("dtm", "dsm"):
        raise ConfigError(CodedText("terrain-surface", name=name))
    return "dtm" if name == "dtm" else "dsm"


def _open(project: Path, file: Path, crs: str, *, draft: bool = False) -> OpenedMap:
    """Confine the process and open the map; what imports kernels comes after it."""
    confine_command(write=[file.parent])
    from recon4.api.maps import open_map
    from recon4.review.approval_state import latest_state

    opened = open_map(project, draft=draft, crs=crs)
    say_approval(latest_state(project, draft=draft))
    return opened


def _make(kind: ProductKind, opened: OpenedMap, file: Path, *, options: ProductOptions) -> None:
    from recon4.products.write import ProductSource, write_product

    source = ProductSource(opened.tiles, opened.frame, opened.stamp)
    say("written", file=str(file), what=write_product(kind, source, file, options=options))


def _volume(opened: OpenedMap, polygon: str, *, surface: TerrainKind, base: float | None) -> str:
    """The volume inside of a polygon of the map or its CRS, in words."""
    import numpy as np

    from recon4.products.terrain import terrain
    from recon4.products.volume import volume
    from recon4.products.write import ProductOptions, up_to_crs

    corners = np.reshape(numbers(polygon, 2 * ((1 + polygon.count(",")) // 2)), (-1, 2))
    made = terrain(opened.tiles, surface, cell_m=ProductOptions().cell_m)
    up_m = up_to_crs(made, opened.frame)
    if opened.frame.to_crs:
        raised = np.column_stack([corners, np.full(len(corners), up_m)])
        corners = opened.frame.from_crs(raised)[:, :2]
    level = None if base is None else base - up_m
    found = volume(made, corners, base_m=level, rng=np.random.default_rng(1))
    return replace(found, base_m=found.base_m + up_m).text
