"""Slices of a finished map: as arrays, and as files at full resolution."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

from recon4.api.maps import OpenedMap, open_map
from recon4.cli.kernel_cache import settle_kernel_cache
from recon4.errors import ConfigError
from recon4.locales.coded import CodedText

if TYPE_CHECKING:
    from recon4.slices.colors import ColorBy
    from recon4.slices.reference import Reference
    from recon4.slices.slice_image import SliceImage
    from recon4.slices.slice_plane import SlicePlane

_IMAGES = (".png", ".svg", ".pdf", ".tif")


def cut_slice(
    project: str | PathLike[str],
    plane: SlicePlane,
    *,
    pixel_m: float = 0.02,
    color: ColorBy = "height",
) -> SliceImage:
    """Cut the map and return the slice as arrays: points and mean value of each pixel.

    Args:
        project: Folder of a finished project.
        plane: `SlicePlane.horizontal`, `SlicePlane.vertical` or `SlicePlane.free`.
        pixel_m: Edge of a pixel [m].
        color: What ``value`` holds: ``height``, ``intensity``, ``normalized``, ``time`` or
            ``sensor``.

    Returns:
        ``count`` and ``value``, (H, W) each, the first row at the top; ``points`` in all; and
        ``paper.corner``, the coordinates u, v of the upper left corner [m].

    Raises:
        ConfigError: If the image had more than 40 million pixels.
        StoreError: If there is no map, or it is damaged.

    >>> plan = api.cut_slice("walk", api.SlicePlane.horizontal(0.2, thickness_m=0.1))
    >>> plan.count.shape == plan.value.shape == (plan.paper.height, plan.paper.width)
    True
    >>> bool((plan.count > 0).any()), plan.points > 0
    (True, True)
    """
    settle_kernel_cache()
    from recon4.slices.points import extent
    from recon4.slices.slice_image import RasterGrid, draw

    tiles = open_map(Path(project)).tiles
    return draw(tiles, plane, RasterGrid(extent(tiles, plane), pixel_m), color=color)


def write_slice(
    project: str | PathLike[str],
    plane: SlicePlane,
    file: str | PathLike[str],
    *,
    color: ColorBy = "height",
    draft: bool = False,
) -> int:
    """Cut the map and write the slice, as ``recon4 slice`` does. It carries the map's approval.

    Args:
        project: Folder of a finished project.
        plane: Where to cut.
        file: To write: a sheet at scale (``.png .svg .pdf``), ``.tif`` (GeoTIFF), ``.dxf``, or the
            points (``.laz .csv``).
        color: As of `cut_slice`; of images only.
        draft: Without approval, whether or not there is one.

    Returns:
        The number of points in the slice.

    Raises:
        Altered: If the map was approved and is not what was approved; nothing is written.
        ConfigError: If the ending is another.
        StoreError: If there is no map, or the file cannot be written.

    >>> plane = api.SlicePlane.vertical((0.0, -2.0), (0.0, 2.0))
    >>> points = api.write_slice("walk", plane, "section.csv")
    >>> rows = Path("section.csv").read_text("utf-8").splitlines()
    >>> len(rows) > points > 0
    True
    """
    settle_kernel_cache()
    root = Path(project)
    look = SliceLook(color, root.resolve().name)
    return write_planes(open_map(root, draft=draft), (plane,), Path(file), look=look)


@dataclass(frozen=True, slots=True)
class SliceLook:
    """What a slice shows beside its points."""

    color: str
    """Key of `recon4.slices.colors.LABELS`."""
    name: str
    """Name of the project."""
    reference: Reference | None = None


def write_planes(
    opened: OpenedMap, planes: Sequence[SlicePlane], file: Path, *, look: SliceLook
) -> int:
    """Write slices to a file; its ending says how.

    Args:
        opened: The map.
        planes: Where to cut; several only as ``.dxf``, ``.laz`` or ``.csv``.
        file: To write.
        look: Colors, title and reference.

    Returns:
        The number of points.

    Raises:
        ConfigError: If such a file cannot hold them.
    """
    from recon4.review.stamp import stamp_file
    from recon4.slices.export import SliceSelection, write_csv, write_dxf, write_laz
    from recon4.store.atomic import atomic_file

    ending = file.suffix.lower()
    writers = {".laz": write_laz, ".csv": write_csv, ".dxf": write_dxf}
    if ending in writers and look.reference:
        raise ConfigError(CodedText("slice-distances-image", file=file.name))
    if ending in writers:
        with atomic_file(file) as temporary:
            chosen = SliceSelection(opened.tiles, tuple(planes))
            points = writers[ending](chosen, temporary, frame=opened.frame)
            if opened.stamp:
                stamp_file(temporary, temporary, opened.stamp)
        return points
    if ending not in _IMAGES:
        raise ConfigError(CodedText("slice-formats", file=file.name))
    if len(planes) > 1:
        raise ConfigError(CodedText("slice-one-image"))
    return _write_image(opened, planes[0], file, look=look)


def _write_image(opened: OpenedMap, plane: SlicePlane, file: Path, *, look: SliceLook) -> int:
    from recon4.mapping.tiles import surface_text
    from recon4.slices.colors import LABELS
    from recon4.slices.geotiff import write_geotiff
    from recon4.slices.points import extent
    from recon4.slices.sheet import SheetText, approval_text, lay_out, source_text, write_sheet
    from recon4.slices.slice_image import RasterGrid, draw

    if look.color not in LABELS:
        raise ConfigError(CodedText("slice-colors", labels=", ".join(LABELS), color=look.color))
    tiles, color, frame = opened.tiles, look.color, opened.frame
    approval = approval_text(opened.stamp.to_json() if opened.stamp else None)
    window = extent(tiles, plane)
    if file.suffix.lower() == ".tif":
        side_m = max(window.right - window.left, window.top - window.bottom)
        grid = RasterGrid(window, max(0.005, side_m / 6000))
        made = draw(tiles, plane, grid, color=color, reference=look.reference)
        title = f"{look.name}: {surface_text(tiles.surface)}. {approval}"
        write_geotiff(
            made, file, frame=frame, rgba=made.rgba(made.span, "light"), description=title
        )
        return made.points
    layout = lay_out(window)
    made = draw(tiles, plane, layout.paper, color=color, reference=look.reference)
    key = tiles.columns.folder.parent.name
    lie = surface_text(tiles.surface)
    against = look.reference.caption if look.reference else ""
    text = SheetText(look.name, frame.text, source_text(key), approval, lie, against)
    write_sheet(made, layout, file, span=made.span, text=text)
    return made.points
