"""The view settings of a person: one immutable value, kept in the browser as JSON."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, replace
from typing import Any, Literal, get_args
from urllib.parse import parse_qs

from recon4.locales.languages import ENGLISH
from recon4.locales.texts import Texts
from recon4.mapping.tiles import Surface
from recon4.store.earlier_names import PALETTES
from recon4_app.viewer.cloud.palette import Palette, Range
from recon4_app.viewer.scene.layers import Layer
from recon4_app.viewer.tuning import VIEWS
from recon4_app.viewer.words import words

ColorBy = Literal[
    "normalized intensity", "raw intensity", "height", "time", "sensor", "ring", "multiframe",
    "distance", "uncertainty",
]  # fmt: skip
COLOR_BY: tuple[ColorBy, ...] = get_args(ColorBy)
CATEGORIES: frozenset[ColorBy] = frozenset({"sensor", "multiframe"})
"""Colored by a list of colors, not along a palette."""

Points = Literal["map", "map and multiframe", "multiframe"]
EdgeColor = Literal["verdict", "error / limit", "chi²"]

Position = tuple[float, float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class Stretch:
    """A part of the walk that is marked, as that of a finding."""

    span_s: tuple[float, float] | None = None
    """After the first pose of the trajectory [s]; None = only its places are known."""
    places: tuple[Position, ...] = ()
    """Positions in the map [m], at most two."""

    def text(self, say: Texts) -> str:
        """Its label in the scene, in the language of texts."""
        if self.span_s is None:
            return say("stretch-here")
        start_s, end_s = self.span_s
        if end_s > start_s:
            return say("stretch-span", **{"from": start_s, "to": end_s})
        return say("stretch-moment", **{"from": start_s})


@dataclass(frozen=True, slots=True, kw_only=True)
class ViewState:
    """View settings of a person."""

    color_by: ColorBy = "normalized intensity"
    palette: Palette = "viridis"
    ranges: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    """Ends of the palette that a person set, by what the points are colored by."""
    point_size_m: float = 0.02
    chosen: Mapping[str, bool] = field(default_factory=dict)
    """Layers a person switched, by key; the others have their default."""
    points: Points = "map"
    surface: Surface = "fitted"
    """Where the points of the map are drawn, if it has fitted surfaces."""
    moment: int = 0
    """Selected multiframe."""
    window_s: float = 0.0
    """Multiframes within this time after it are shown with it [s]."""
    edge_color: EdgeColor = "verdict"
    detail: int = 0
    """Most points; 0 = the server's limit."""
    adapt: bool = True
    """Whether a slow browser gets fewer points."""
    measurements: tuple[tuple[Position, ...], ...] = ()
    """One point each, or two, in the map [m]."""
    stretch: Stretch | None = None
    """What is marked of the walk."""
    language: str = ENGLISH
    """Of the page around it; not kept."""

    @property
    def say(self) -> Texts:
        """The texts in its language."""
        return words(self.language)

    def shows(self, layer: Layer) -> bool:
        """Whether a layer is on."""
        return self.chosen.get(layer.key, layer.shown)

    def with_layer(self, key: str, *, on: bool) -> ViewState:
        """The view with a layer switched."""
        return replace(self, chosen={**self.chosen, key: on})

    def with_range(self, span: Range | None) -> ViewState:
        """The view with other ends of the palette for its color; None = those of the map."""
        others = {name: ends for name, ends in self.ranges.items() if name != self.color_by}
        if span is not None:
            others[self.color_by] = (span.low, span.high)
        return replace(self, ranges=others)

    def range_of(self, color_by: ColorBy) -> Range | None:
        """The ends a person set."""
        return Range(*self.ranges[color_by]) if color_by in self.ranges else None

    def to_json(self) -> str:
        """The view as JSON text, without its language, which is that of the page."""
        record = asdict(self)
        del record["language"]
        return json.dumps(record)


def view_from_json(text: str | None) -> ViewState | None:
    """The view a browser kept; None if there is none or it is not one of ours.

    The text is untrusted: a malformed one counts as none.
    """
    try:
        record = json.loads(text or "")
        return _view(record)
    except (ValueError, TypeError, KeyError, AttributeError, OverflowError, RecursionError):
        return None


def stretch_from_text(text: str | None) -> Stretch | None:
    """The stretch in a fragment of a link, ``span=12.5,15&place=x,y,z,x,y,z``; None if it has none.

    The text is untrusted: a malformed one counts as none.
    """
    try:
        fields = parse_qs((text or "")[: VIEWS.max_stretch_text])
        span, place = (_numbers(fields.get(name, [""])[0]) for name in ("span", "place"))
        places = [place[first : first + 3] for first in range(0, len(place), 3)]
        return _stretch({"span_s": span or None, "places": places})
    except (ValueError, OverflowError):
        return None


def _numbers(text: str) -> list[float]:
    return [float(part) for part in text.split(",")] if text else []


def _stretch(record: Any) -> Stretch | None:
    if record is None:
        return None
    places = tuple((_number(x), _number(y), _number(z)) for x, y, z in record["places"])
    span_s = record["span_s"]
    if len(places) > 2 or not (places or span_s):
        raise ValueError(f"expected a span or up to two places, got {record}")
    if span_s is None:
        return Stretch(places=places)
    start_s, end_s = (_number(second) for second in span_s)
    return Stretch(span_s=(min(start_s, end_s), max(start_s, end_s)), places=places)


def _view(record: dict[str, Any]) -> ViewState:
    return ViewState(
        color_by=_one_of(record["color_by"], COLOR_BY),
        palette=_one_of(PALETTES.get(record["palette"], record["palette"]), get_args(Palette)),
        ranges={
            _one_of(name, COLOR_BY): (_number(low), _number(high))
            for name, (low, high) in record["ranges"].items()
        },
        point_size_m=min(max(_number(record["point_size_m"]), 0.001), 1.0),
        chosen={str(key)[:80]: on is True for key, on in list(record["chosen"].items())[:200]},
        points=_one_of(record["points"], get_args(Points)),
        surface=_one_of(record.get("surface", "fitted"), get_args(Surface)),
        moment=max(int(record["moment"]), 0),
        window_s=min(max(_number(record["window_s"]), 0.0), 60.0),
        edge_color=_one_of(record["edge_color"], get_args(EdgeColor)),
        detail=max(int(record["detail"]), 0),
        adapt=record["adapt"] is True,
        measurements=tuple(
            _measurement(m) for m in record["measurements"][: VIEWS.max_measurements]
        ),
        stretch=_stretch(record.get("stretch")),
    )


def _measurement(record: list[list[float]]) -> tuple[Position, ...]:
    points = tuple((_number(x), _number(y), _number(z)) for x, y, z in record)
    if len(points) not in (1, 2):
        raise ValueError(f"a measurement has one or two points, got {len(points)}")
    return points


def _one_of(value: Any, known: tuple[Any, ...]) -> Any:
    if value not in known:
        raise ValueError(f"expected one of {known}, got {value!r}")
    return value


def _number(value: Any) -> float:
    number = float(value)
    if not abs(number) <= VIEWS.max_number:
        raise ValueError(f"expected a number up to {VIEWS.max_number:g}, got {number:g}")
    return number
