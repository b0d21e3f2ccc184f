"""The legend of a view: the meaning of its colors."""

from __future__ import annotations

from dataclasses import dataclass

from recon4.locales.languages import ENGLISH
from recon4_app.viewer.client.view import ColorBy, EdgeColor, ViewState
from recon4_app.viewer.cloud.palette import Palette, Range, Rgb
from recon4_app.viewer.cloud.parts import sensor_names
from recon4_app.viewer.scene.build import CHI2_RANGE, ERROR_RANGE, Content, bounds, grid_cell_m
from recon4_app.viewer.scene.layers import Layer
from recon4_app.viewer.words import word_of

UNITLESS: frozenset[ColorBy] = frozenset({"normalized intensity", "sensor"})


@dataclass(frozen=True, slots=True, kw_only=True)
class Legend:
    """Meaning of the colors on screen."""

    color_by: ColorBy | None
    """None = there are no points."""
    palette: Palette
    span: Range
    unit: str
    sensors: tuple[tuple[str, Rgb], ...] = ()
    layers: tuple[Layer, ...] = ()
    points: int = 0
    """Points on screen."""
    points_in_map: int = 0
    surface: str = ""
    """Where the points lie, and how many points are left out; empty = no fitted surfaces."""
    grid_cell_m: float = 0.0
    edge_color: EdgeColor = "verdict"
    edge_span: Range = ERROR_RANGE
    multiframes: str = ""
    """Caption of the multiframes on screen; empty = none."""
    preview: bool = False
    """Whether the points on screen are the preview, by height."""
    language: str = ENGLISH


def legend(content: Content, view: ViewState, *, points: int = 0) -> Legend:
    """The legend of a view.

    Args:
        content: What the project has to show.
        view: The view settings of a person.
        points: Points of the map on screen.
    """
    shown = content.cloud is not None and view.color_by in content.colors
    return Legend(
        color_by=view.color_by if shown else None,
        palette=view.palette,
        span=span_of(content, view) if shown else Range(0.0, 1.0),
        unit=_unit(view),
        sensors=sensor_names(content.sensors),
        layers=tuple(layer for layer in content.layers if view.shows(layer)),
        points=points,
        points_in_map=len(content.cloud) if content.cloud else 0,
        surface=surface_caption(content, view),
        grid_cell_m=grid_cell_m(bounds(content)),
        edge_color=view.edge_color,
        edge_span=CHI2_RANGE if view.edge_color == "chi²" else ERROR_RANGE,
        multiframes=multiframe_caption(content, view),
        preview=shows_preview(content, view),
        language=view.language,
    )


def surface_caption(content: Content, view: ViewState) -> str:
    """Where the points on screen lie; empty if the map has no fitted surfaces."""
    if content.cloud is None or content.cloud.tiles.surface == "raw":
        return ""
    strays = content.cloud.tiles.strays
    match content.cloud.on(view.surface).tiles.surface:
        case "strays":
            return view.say("only-left-out", count=strays)
        case "raw":
            return view.say("raw-left-out", count=strays)
        case _:
            return view.say("fitted-left-out", count=strays)


def _unit(view: ViewState) -> str:
    """Unit and zero of what the points are colored by; empty = none."""
    return "" if view.color_by in UNITLESS else word_of("scale", view.color_by, view.say)


def shows_preview(content: Content, view: ViewState) -> bool:
    """Whether the preview is shown because there is no map yet."""
    there = content.preview is not None and content.trajectory is not None
    return there and view.points != "multiframe"


def multiframe_caption(content: Content, view: ViewState) -> str:
    """Caption of the multiframes on screen, with their time."""
    frames = content.multiframes
    if frames is None or view.points == "map":
        return ""
    rows = frames.window(view.moment, view.window_s)
    begin_s = (frames.t_mid_ns[rows[0]] - frames.t_mid_ns[0]) * 1e-9
    last = int(rows[-1]) if len(rows) > 1 else -1
    at = {"first": int(rows[0]), "last": last, "count": len(frames), "at": float(begin_s)}
    return view.say("multiframes-of", **at)


def span_of(content: Content, view: ViewState) -> Range:
    """Ends of the palette: set by a person, else those of the map."""
    mine = view.range_of(view.color_by)
    if mine is not None or content.cloud is None:
        return mine or Range(0.0, 1.0)
    return content.cloud.span(view.color_by)
