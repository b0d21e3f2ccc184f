"""Slice sheets to print: true scale, coordinate grid, scale bar, legend, approval."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

import numpy as np

import recon4
from recon4.errors import ConfigError
from recon4.locales.coded import CodedText
from recon4.model.usability import Usability
from recon4.slices.colors import LABELS, UNITS, ColorBy, Span, table
from recon4.slices.points import SliceWindow
from recon4.slices.slice_image import RasterGrid, SliceImage
from recon4.slices.slice_plane import SlicePlane
from recon4.slices.tuning_files import SHEETS, SLICE_COLORS
from recon4.store.atomic import atomic_file
from recon4.units import MM_PER_INCH
from recon4.untrusted.names import visible

Size = Literal["a4", "a3", "a2", "a1"]
SIZES_MM: dict[Size, tuple[float, float]] = {
    "a4": (297.0, 210.0),
    "a3": (420.0, 297.0),
    "a2": (594.0, 420.0),
    "a1": (841.0, 594.0),
}
_INK, _QUIET, _GRID = "#17202a", "#56636f", "#b9c3cc"


@dataclass(frozen=True, slots=True)
class SheetText:
    """Texts of a sheet."""

    project: str
    frame: str
    """Frame, axes, unit."""
    sources: str
    """Program version and key of the map."""
    approval: str
    """Who approved the map and when, or `Not approved`."""
    surface: str
    """Where the points lie, see `recon4.mapping.tiles.surface_text`."""
    reference: str = ""
    compared: str = ""
    """How the slice lies beside the reference, see `compare.signed_text`."""
    sensors: tuple[str, ...] = field(default=())


@dataclass(frozen=True, slots=True)
class SheetLayout:
    """Scale and window of a sheet."""

    size: Size
    scale: int
    """Denominator of the scale 1 : n."""
    window: SliceWindow
    """The printed window [m]: the requested one, centered in the printable area."""

    @property
    def paper(self) -> RasterGrid:
        """Window and pixel size of the image to draw, at `SHEETS.dpi`."""
        return RasterGrid(self.window, self.scale * MM_PER_INCH / 1000.0 / SHEETS.dpi)


def lay_out(window: SliceWindow, size: Size = "a4", scale: int = 0) -> SheetLayout:
    """Choose the largest usual scale at which a window fits, or use the requested one.

    Raises:
        ConfigError: If it does not fit at 1 : 10 000, or the scale is not a usual one.
    """
    if scale and scale not in SHEETS.scales:
        raise ConfigError(CodedText("sheet-scale", scales=str(list(SHEETS.scales)), scale=scale))
    across_mm, up_mm = _field_mm(size)
    width_m, height_m = window.right - window.left, window.top - window.bottom
    least = max(width_m * 1000.0 / across_mm, height_m * 1000.0 / up_mm)
    chosen = scale or next((s for s in SHEETS.scales if s >= least * (1.0 - 1e-9)), 0)
    if not chosen:
        raise ConfigError(CodedText("sheet-window", width_m=width_m, size=size))
    half_u, half_v = across_mm * chosen / 2000.0, up_mm * chosen / 2000.0
    u, v = (window.left + window.right) / 2.0, (window.bottom + window.top) / 2.0
    return SheetLayout(size, chosen, SliceWindow(u - half_u, v - half_v, u + half_u, v + half_v))


def write_sheet(
    drawn: SliceImage, layout: SheetLayout, path: Path, *, span: Span, text: SheetText
) -> None:
    """Write a sheet as PNG (300 dpi), SVG or PDF; the same image gives the same bytes.

    Raises:
        ConfigError: If the file name has another suffix.
        StoreError: If the file cannot be written.
    """
    kind = path.suffix.lower().lstrip(".")
    if kind not in {"png", "svg", "pdf"}:
        raise ConfigError(CodedText("sheet-file", file=path.name))
    import matplotlib
    from matplotlib.figure import Figure

    plain: dict[Any, Any] = {
        "svg.hashsalt": "recon4",
        "svg.fonttype": "none",
        "font.family": "DejaVu Sans",
    }
    with matplotlib.rc_context({**plain, "font.size": 7, "path.simplify": False}):
        across_mm, up_mm = SIZES_MM[layout.size]
        figure = Figure(figsize=(across_mm / MM_PER_INCH, up_mm / MM_PER_INCH), dpi=SHEETS.dpi)
        _field(figure, drawn, layout, span=span)
        _head(figure, drawn, layout, text=text)
        _scale_bar(figure, layout)
        _legend(figure, drawn, span, text=text)
        metadata = {"Date": None} if kind == "svg" else {}
        if kind == "pdf":
            metadata = {"CreationDate": None}
        with atomic_file(path) as temporary:
            figure.savefig(temporary, format=kind, dpi=SHEETS.dpi, metadata=metadata)


def grid_step_m(across_m: float) -> float:
    """Distance of grid lines: 1, 2 or 5 times a power of ten, six to fourteen of them."""
    rough = across_m / 14.0
    power = 10.0 ** np.floor(np.log10(rough))
    return float(power * next(s for s in (1.0, 2.0, 5.0, 10.0) if s * power >= rough * 0.999))


def axis_labels(plane: SlicePlane) -> tuple[str, str]:
    """Labels of the axes u and v."""
    if plane.kind == "horizontal":
        return "x [m]", "y [m]"
    if plane.kind == "vertical":
        return "along the section [m]", "height z [m]"
    return "u [m]", "v [m]"


def _field_mm(size: Size) -> tuple[float, float]:
    across_mm, up_mm = SIZES_MM[size]
    return across_mm - SHEETS.left_mm - SHEETS.right_mm, up_mm - SHEETS.top_mm - SHEETS.bottom_mm


def _field(figure: Any, drawn: SliceImage, layout: SheetLayout, *, span: Span) -> None:
    across_mm, up_mm = SIZES_MM[layout.size]
    width, height = _field_mm(layout.size)
    axes = figure.add_axes(
        (SHEETS.left_mm / across_mm, SHEETS.bottom_mm / up_mm, width / across_mm, height / up_mm)
    )
    w = layout.window
    axes.imshow(
        drawn.rgba(span, "light"),
        extent=(w.left, w.right, w.bottom, w.top),
        interpolation="none",
        aspect="auto",
        zorder=2,
    )
    step = grid_step_m(max(w.right - w.left, w.top - w.bottom))
    digits = max(0, -int(np.floor(np.log10(step) + 1e-9)))
    for axis, low, high in ((axes.xaxis, w.left, w.right), (axes.yaxis, w.bottom, w.top)):
        ticks = np.arange(np.ceil(low / step), np.floor(high / step) + 1.0) * step
        axis.set_ticks(ticks, [f"{tick:.{digits}f}".replace("-", "\u2212") for tick in ticks])
    axes.tick_params(colors=_QUIET, width=0.4, length=2.5)
    axes.grid(color=_GRID, linewidth=0.35, zorder=0)
    axes.set_axisbelow(True)
    u_label, v_label = axis_labels(drawn.plane)
    axes.set_xlabel(u_label, color=_QUIET, labelpad=2)
    axes.set_ylabel(v_label, color=_QUIET, labelpad=2)
    for spine in axes.spines.values():
        spine.set_color(_INK)
        spine.set_linewidth(0.6)


def _head(figure: Any, drawn: SliceImage, layout: SheetLayout, *, text: SheetText) -> None:
    across_mm, up_mm = SIZES_MM[layout.size]
    x = SHEETS.left_mm / across_mm
    kind = {"horizontal": "Horizontal slice", "vertical": "Vertical slice", "free": "Slice"}
    title = f"{text.project}   {kind[drawn.plane.kind]}  {drawn.plane.name}"
    facts = (
        f"1 : {layout.scale} on {layout.size.upper()}     "
        f"thickness {_length(drawn.plane.thickness_m)}"
        f"     {drawn.points:,} points".replace(",", "\u2009")
        + f" {text.surface}"
        + f"     {text.frame}"
    )
    figure.text(
        x, 1.0 - 9.0 / up_mm, title, fontsize=10, weight="bold", color=_INK, parse_math=False
    )
    figure.text(x, 1.0 - 15.0 / up_mm, facts, color=_INK, parse_math=False)
    figure.text(x, 11.5 / up_mm, text.compared, fontsize=5.5, color=_INK, parse_math=False)
    figure.text(x, 4.5 / up_mm, text.sources, fontsize=5.5, color=_QUIET, parse_math=False)
    figure.text(x, 8.0 / up_mm, text.approval, fontsize=6, color=_INK, parse_math=False)


def _scale_bar(figure: Any, layout: SheetLayout) -> None:
    across_mm, up_mm = SIZES_MM[layout.size]
    step = grid_step_m(60.0 * layout.scale / 1000.0 * 14.0 / 4.0)
    length_mm = step * 1000.0 / layout.scale
    axes = figure.add_axes(
        (SHEETS.left_mm / across_mm, 14.0 / up_mm, 3 * length_mm / across_mm, 1.6 / up_mm)
    )
    axes.set(xlim=(0, 3), ylim=(0, 1), yticks=[])
    axes.axvspan(0, 1, color=_INK)
    axes.axvspan(2, 3, color=_INK)
    axes.set_xticks(range(4), [f"{k * step:g}" for k in range(3)] + [f"{3 * step:g} m"])
    axes.tick_params(colors=_INK, length=0, pad=1.5, labelsize=6)
    for spine in axes.spines.values():
        spine.set_linewidth(0.5)


def _legend(figure: Any, drawn: SliceImage, span: Span, *, text: SheetText) -> None:
    across_mm, up_mm = SIZES_MM[layout_size(figure)]
    color: ColorBy = drawn.color
    right = 1.0 - (SHEETS.right_mm + 3.0) / across_mm
    width = 60.0 / across_mm
    bar = (right - width, 12.5 / up_mm, width, 2.4 / up_mm)
    unit = f" [{UNITS[color]}]" if UNITS[color] else ""
    label = f"{LABELS[color]}{unit}"
    if color == "sensor":
        _sensors(figure, bar, text)
    else:
        axes = figure.add_axes(bar)
        axes.imshow(table(color, "light")[None], aspect="auto", extent=(0, 1, 0, 1))
        axes.set_yticks([])
        ends = (span.low, (span.low + span.high) / 2.0, span.high)
        axes.set_xticks((0, 0.5, 1), [f"{end:.4g}" for end in ends])
        axes.tick_params(colors=_INK, length=2, width=0.4, pad=1.5, labelsize=6)
        for spine in axes.spines.values():
            spine.set_linewidth(0.4)
    figure.text(right - width, 16.2 / up_mm, label, color=_INK, fontsize=6.5, parse_math=False)
    if text.reference:
        green = tuple(c / 255.0 for c in SLICE_COLORS.reference_color)
        x = right - width - 4.0 / across_mm
        figure.text(
            x, 13.0 / up_mm, f"\u25a0 reference: {text.reference}", color=green, fontsize=6.5,
            ha="right", parse_math=False,
        )  # fmt: skip


def layout_size(figure: Any) -> Size:
    """Paper size of a figure."""
    across_mm = figure.get_figwidth() * MM_PER_INCH
    return min(SIZES_MM, key=lambda size: abs(SIZES_MM[size][0] - across_mm))


def _sensors(figure: Any, bar: tuple[float, float, float, float], text: SheetText) -> None:
    for k, name in enumerate(text.sensors or ("1", "2")):
        rgb = tuple(
            c / 255.0 for c in SLICE_COLORS.sensor_colors[k % len(SLICE_COLORS.sensor_colors)]
        )
        x = bar[0] + k * bar[2] / max(2, len(text.sensors))
        figure.text(x, bar[1], f"\u25a0 {name}", color=rgb, fontsize=6.5, parse_math=False)


def _length(length_m: float) -> str:
    return f"{100.0 * length_m:g} cm" if length_m < 1.0 else f"{length_m:g} m"


def approval_text(approval: Mapping[str, object] | None) -> str:
    """Who approved a map and when, for sheets and files."""
    if not approval:
        return "Not approved"
    who, role, when = (str(approval.get(key, ""))[:80] for key in ("who", "role", "time"))
    version, digest = str(approval.get("version", ""))[:10], str(approval.get("hash", ""))[:16]
    signed = f"Approved by {who} ({role}) {when}, version {version}, statement {digest}"
    verdict, why = str(approval.get("verdict", "")), str(approval.get("why", ""))
    if verdict in ("", Usability.GOOD):
        return signed
    reason = (
        f", signed because: {visible(' '.join(why.split()), most=SHEETS.reason_characters)}"
        if why
        else ""
    )
    return f"{signed}. Verdict on the map: {verdict}{reason}"


"""Where the points of a map lie, or which they are."""


def source_text(artifact_key: str) -> str:
    """Program version and key of the map, for the sheet."""
    return f"recon4 {recon4.__version__}, map {artifact_key[:16]}"
