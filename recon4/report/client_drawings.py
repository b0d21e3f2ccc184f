"""Drawings of the report for the client: SVG that stands by itself, for paper."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from recon4.geometry.se3 import Array
from recon4.mapping.tiles import TileSet
from recon4.model.finding import Finding
from recon4.model.pose_graph import PoseGraph
from recon4.model.trajectory import Trajectory
from recon4.report.client import Drawing
from recon4.report.client_words import Words
from recon4.report.edges import edge_paths
from recon4.report.maps import (
    ABOVE,
    MapChunk,
    Raster,
    height_png,
    ink_png,
    map_chunks,
    rasterize,
)
from recon4.report.plan import PlanOverlay, PlanPath, plan_svg
from recon4.report.tuning import CLIENT_REPORT

_PAPER = """
text{fill:#444;font-size:17px;font-family:"DejaVu Sans"}
.mid{text-anchor:middle}.end{text-anchor:end}
path{fill:none}.edge{fill:none;stroke:#bbb}.grid{stroke:#ddd;stroke-width:1}
.bar{stroke:#222;stroke-width:2}
.line-final{stroke:#0072b2;stroke-width:2.4}
.line-finding{stroke:#c85200;stroke-width:7;stroke-linecap:round;stroke-opacity:.8}
.line-nodes{stroke:#333;stroke-width:1}
.edge-accepted{stroke:#0072b2;stroke-width:1.1}
.edge-unverified{stroke:#888;stroke-width:1.3;stroke-dasharray:5 4}
.edge-rejected{stroke:none}
.edge-verification{stroke:#c22f2f;stroke-width:2.2}
.mark-start{fill:#00825f;stroke:#fff;stroke-width:2}
.mark-end{fill:#c85200;stroke:#fff;stroke-width:2}
"""
_VIEW_BOX = re.compile(r'viewBox="(\S+) (\S+) ([^" ]+) ([^" ]+)"')
_CHARTS = ("findings", "loops", "uncertainty", "gnss", "ate", "er")
"""What a client can make use of; the HTML report has all."""
_CHART_TEXT = re.compile(r">([^<>]+)</text>")
_NAMESPACES = 'xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink"'


def on_paper(svg: str) -> str:
    """A drawing of the HTML report as an SVG file of its own, in ink on white."""
    size = _VIEW_BOX.search(svg)
    assert size is not None
    head = f'<svg {_NAMESPACES} width="{size[3]}" height="{size[4]}"'
    page = svg.replace("<svg", head, 1).replace("currentColor", "#222")
    page = re.sub(r"<(title|metadata)>.*?</\1>", "", page, flags=re.DOTALL)
    end = page.index(">") + 1
    style = f"<style>{_PAPER}</style>" if 'class="plan"' in page[:end] else ""
    return page[:end] + style + page[end:]


@dataclass(frozen=True, slots=True, eq=False)
class MapDrawings:
    """Images of the map, made once, of which the drawings are drawn."""

    words: Words
    rasters: tuple[Raster, ...]
    final: Trajectory | None
    plan: Raster | None
    """A cut below the scanner, from above."""
    cut_m: tuple[float, float]
    """Depths of the cut below the scanner on the lowest storey [m]."""

    @staticmethod
    def of(words: Words, tiles: TileSet | None, final: Trajectory | None) -> MapDrawings:
        """Read the points of a map; two passes."""
        rasters = rasterize(partial(map_chunks, tiles)) if tiles is not None else []
        above = next((one for one in rasters if one.view is ABOVE), None)
        plan = None
        cut = CLIENT_REPORT.cut_m
        if tiles is not None and above is not None and final is not None and len(final):
            scanner_m = float(np.percentile(final.T_a_b.t[:, 2], 5))
            plan = _cut(tiles, above, (scanner_m - cut[1], scanner_m - cut[0]))
        return MapDrawings(words, tuple(rasters), final, plan, cut)

    def front(self) -> Drawing | None:
        """The map from above with the trajectory."""
        above = self._above
        if above is None:
            return None
        svg = plan_svg(ink_png(above), ABOVE, above.frame, overlay=self._walk())
        return Drawing(
            svg=on_paper(svg), caption=self.words("caption.above", pixel=_pixel_cm(above))
        )

    def all(self) -> list[Drawing]:
        """Plan, heights, and the views from the sides."""
        words, out = self.words, []
        if self.plan is not None and self.plan.count.any():
            low, high = self.cut_m
            caption = words(
                "caption.plan",
                low=words.number(low, 1),
                high=words.number(high, 1),
                pixel=_pixel_cm(self.plan),
            )
            svg = plan_svg(ink_png(self.plan), ABOVE, self.plan.frame)
            out.append(_drawing(svg, caption))
        for raster in self.rasters:
            if raster.view is ABOVE:
                png, (low, high) = height_png(raster)
                caption = words(
                    "caption.height", low=words.number(low, 1), high=words.number(high, 1)
                )
            else:
                png = ink_png(raster)
                caption = words(
                    "caption.side", view=words.term(raster.view.name), pixel=_pixel_cm(raster)
                )
            svg = plan_svg(png, raster.view, raster.frame)
            out.append(_drawing(svg, caption))
        return out

    def of_finding(self, finding: Finding) -> Drawing | None:
        """The surroundings of a finding from above; None if it has no place or there is no map."""
        above, places = self._above, _places(finding, self.final)
        if above is None or not len(places):
            return None
        close = _around(above, places)
        if close is None or not close.count.any():
            return None
        paths: tuple[PlanPath, ...] = (PlanPath("line-finding", (places,)),)
        if self.final is not None:
            paths = (PlanPath("line-final", (self.final.T_a_b.t,)), *paths)
        marks = (("mark-end", places[len(places) // 2]),)
        svg = plan_svg(ink_png(close), ABOVE, close.frame, overlay=PlanOverlay(paths, marks))
        return _drawing(_clipped(svg), self.words("caption.place"))

    def loops(self, graph: PoseGraph) -> Drawing | None:
        """Every loop closure over the map."""
        above = self._above
        if above is None:
            return None
        paths = (PlanPath("line-nodes", (graph.T_map_body.t,)), *edge_paths(graph))
        svg = plan_svg(ink_png(above), ABOVE, above.frame, overlay=PlanOverlay(paths))
        return Drawing(
            svg=on_paper(svg.replace("<image", '<image opacity=".4"', 1)),
            caption=self.words("caption.loops"),
        )

    @property
    def _above(self) -> Raster | None:
        return next((one for one in self.rasters if one.view is ABOVE), None)

    def _walk(self) -> PlanOverlay:
        if self.final is None or len(self.final) < 2:
            return PlanOverlay()
        at = self.final.T_a_b.t
        return PlanOverlay(
            (PlanPath("line-final", (at,)),), (("mark-start", at[0]), ("mark-end", at[-1]))
        )


def charts_on_paper(charts: Sequence[tuple[str, str]], words: Words) -> tuple[Drawing, ...]:
    """Charts of the HTML report, two beside each other, with captions and axes in its words."""
    return tuple(
        _drawing(_worded(svg, words), words(f"chart.{name}"), wide=False)
        for svg, _ in charts
        for name in _CHARTS
        if f'data-name="{name}"' in svg
    )


def _worded(svg: str, words: Words) -> str:
    """A chart with the names of its axes in the words of the report."""
    return _CHART_TEXT.sub(lambda found: f">{words.value(found[1])}</text>", svg)


def _drawing(svg: str, caption: str, *, wide: bool = True) -> Drawing:
    size = _VIEW_BOX.search(svg)
    assert size is not None
    aspect = float(size[3]) / float(size[4])
    return Drawing(svg=on_paper(svg), caption=caption, wide=wide, aspect=aspect)


def _cut(tiles: TileSet, above: Raster, between_m: tuple[float, float]) -> Raster:
    """The points between two heights, in the frame of another image."""
    low_m, high_m = between_m
    plan = Raster(ABOVE, above.frame)
    for chunk in map_chunks(tiles):
        inside = (chunk.xyz_m[:, 2] >= low_m) & (chunk.xyz_m[:, 2] <= high_m)
        plan.add(MapChunk(chunk.xyz_m[inside], chunk.intensity[inside]))
    return plan


def _places(finding: Finding, walk: Trajectory | None) -> Array:
    """Positions of a finding [m], (N, 3)."""
    if finding.span_s is not None and walk is not None and len(walk):
        t_s = (walk.t_ns - walk.t_ns[0]) / 1e9
        first, last = np.searchsorted(t_s, finding.span_s)
        found = walk.T_a_b.t[max(int(first) - 1, 0) : int(last) + 1]
        if len(found):
            return found
    if finding.place_m is not None:
        return np.array(finding.place_m, np.float64)
    return np.empty((0, 3))


def _around(above: Raster, places: Array) -> Raster | None:
    """The part of an image around some places, with a margin."""
    frame = above.frame
    low, high = places[:, :2].min(axis=0), places[:, :2].max(axis=0)
    half = max(0.6 * float((high - low).max()), CLIENT_REPORT.around_m)
    middle = (low + high) / 2
    x0 = int((middle[0] - half - frame.left_m) / frame.pixel_m)
    y0 = int((middle[1] - half * 0.6 - frame.bottom_m) / frame.pixel_m)
    width, height = int(2 * half / frame.pixel_m), int(1.2 * half / frame.pixel_m)
    x1, y1 = min(x0 + width, frame.width), min(y0 + height, frame.height)
    x0, y0 = max(x0, 0), max(y0, 0)
    if x1 - x0 < 2 or y1 - y0 < 2:
        return None
    part = replace(
        frame,
        left_m=frame.left_m + x0 * frame.pixel_m,
        bottom_m=frame.bottom_m + y0 * frame.pixel_m,
        width=x1 - x0,
        height=y1 - y0,
    )
    close = Raster(ABOVE, part)
    rows = slice(frame.height - y1, frame.height - y0)
    whole = above.sums.reshape(frame.height, frame.width, -1)
    close.sums = whole[rows, x0:x1].reshape(-1, whole.shape[2])
    return close


def _clipped(svg: str) -> str:
    """A plan whose curves end at its edge."""
    size = re.search(r'<rect class="edge" width="(\S+)" height="(\S+)"/>', svg)
    assert size is not None
    clip = f'<clipPath id="edge"><rect width="{size[1]}" height="{size[2]}"/></clipPath>'
    svg = svg.replace("<image", f"<defs>{clip}</defs><image", 1)
    return svg.replace('<path class="line', '<path clip-path="url(#edge)" class="line')


def _pixel_cm(raster: Raster) -> str:
    return f"{raster.frame.pixel_m * 100:g}"
