"""Plan of the map with lines, a scale bar and coordinates, as inline SVG."""

from __future__ import annotations

from base64 import b64encode
from dataclasses import dataclass

import numpy as np

from recon4.geometry.se3 import Array
from recon4.report.figures import thinned
from recon4.report.maps import ImageFrame, MapProjection
from recon4.report.tuning import PLANS


@dataclass(frozen=True, slots=True, eq=False)
class PlanPath:
    """A curve, or many separate pieces."""

    css: str
    """CSS class; a constant, never user input."""
    pieces: tuple[Array, ...]
    """Points in the frame of the map [m], (N, 3) each."""


@dataclass(frozen=True, slots=True, eq=False)
class PlanOverlay:
    """Curves and points above a plan."""

    paths: tuple[PlanPath, ...] = ()
    """Later ones above earlier ones."""
    marks: tuple[tuple[str, Array], ...] = ()
    """CSS class and position (3,) of each point."""


NO_OVERLAY = PlanOverlay()


def plan_svg(
    png: bytes | None,
    view: MapProjection,
    frame: ImageFrame,
    *,
    overlay: PlanOverlay = NO_OVERLAY,
    css: str = "",
) -> str:
    """Draw a plan of the map.

    Args:
        png: The map; None = lines only.
        view: Direction of view.
        frame: Part of the plane that the image shows.
        overlay: What is drawn above the map.
        css: CSS class of the image (``ink`` is inverted on dark pages).
    """
    scale = PLANS.longest / (max(frame.width, frame.height) * frame.pixel_m)
    width, height = (scale * n * frame.pixel_m for n in (frame.width, frame.height))
    place = _PlanTransform(view, frame, scale, width, height)
    out = [
        f'<svg class="plan" role="img" viewBox="-58 -28 {width + 70:.0f} {height + 102:.0f}">',
        f"<title>the map {view.name}</title>",
        _axes(place, view, frame),
    ]
    if png is not None:
        data = b64encode(png).decode("ascii")
        out.append(
            f'<image class="{css}" width="{width:.1f}" height="{height:.1f}" '
            f'href="data:image/png;base64,{data}"/>'
        )
    out += [f'<path class="{path.css}" d="{place.path(path.pieces)}"/>' for path in overlay.paths]
    for name, point in overlay.marks:
        x, y = place.of(point[None])[0]
        out.append(f'<circle class="{name}" cx="{x:.1f}" cy="{y:.1f}" r="8"/>')
    out += [_scale_bar(scale, width, height), "</svg>"]
    return "".join(out)


def frame_around(points: Array, view: MapProjection) -> ImageFrame:
    """A frame for lines without a map, a tenth larger than they are."""
    p = points[:, [view.right, view.up]]
    low, high = p.min(axis=0), p.max(axis=0)
    margin = 0.1 * float((high - low).max()) + 0.5
    low, size = low - margin, high - low + 2 * margin
    pixel_m = float(size.max()) / 1000.0
    return ImageFrame(float(low[0]), float(low[1]), pixel_m, *(int(s / pixel_m) for s in size))


def nice_step(extent: float, parts: int) -> float:
    """1, 2 or 5 times a power of ten: about ``parts`` of them make the extent."""
    wanted = max(extent / parts, 1e-9)
    power = 10.0 ** np.floor(np.log10(wanted))
    return float(min((1, 2, 5, 10), key=lambda step: abs(np.log(step * power / wanted))) * power)


@dataclass(frozen=True, slots=True)
class _PlanTransform:
    view: MapProjection
    frame: ImageFrame
    scale: float
    width: float
    height: float

    def of(self, points: Array) -> Array:
        x = (points[:, self.view.right] - self.frame.left_m) * self.scale
        y = self.height - (points[:, self.view.up] - self.frame.bottom_m) * self.scale
        return np.stack([x, y], axis=1)

    def path(self, pieces: tuple[Array, ...]) -> str:
        out = []
        for piece in pieces:
            few = self.of(piece[thinned(len(piece), 3000)])
            few = few[np.all(np.abs(few) < 1e5, axis=1)]
            if len(few) > 1:
                out.append("M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in few))
        return "".join(out)


def _axes(place: _PlanTransform, view: MapProjection, frame: ImageFrame) -> str:
    extent = (frame.width * frame.pixel_m, frame.height * frame.pixel_m)
    step = nice_step(max(extent), PLANS.ticks)
    out = [f'<rect class="edge" width="{place.width:.1f}" height="{place.height:.1f}"/>']
    for value in _multiples(frame.left_m, extent[0], step):
        x = (value - frame.left_m) * place.scale
        out.append(f'<path class="grid" d="M{x:.1f} 0V{place.height:.1f}"/>')
        out.append(f'<text x="{x:.1f}" y="{place.height + 26:.1f}" class="mid">{value:g}</text>')
    for value in _multiples(frame.bottom_m, extent[1], step):
        y = place.height - (value - frame.bottom_m) * place.scale
        out.append(f'<path class="grid" d="M0 {y:.1f}H{place.width:.1f}"/>')
        out.append(f'<text x="-8" y="{y + 6:.1f}" class="end">{value:g}</text>')
    right, up = view.labels
    out.append(
        f'<text x="{place.width:.1f}" y="{place.height + 62:.1f}" class="end">{right} [m] →</text>'
    )
    out.append(f'<text x="-50" y="-10">{up} [m] ↑</text>')
    return "".join(out)


def _multiples(start: float, extent: float, step: float) -> list[float]:
    first, last = int(np.ceil(start / step)), int(np.floor((start + extent) / step))
    return [round(k * step, 9) for k in range(first, last + 1)]


def _scale_bar(scale: float, width: float, height: float) -> str:
    length_m = nice_step(width / scale, 5)
    end = length_m * scale
    y = height + 60.0
    bar = f'<path class="bar" d="M0 {y - 6:.1f}V{y:.1f}H{end:.1f}V{y - 6:.1f}"/>'
    return f'{bar}<text x="{end + 8:.1f}" y="{y + 1:.1f}">{length_m:g} m</text>'
