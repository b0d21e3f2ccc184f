"""How much the viewer shows, in which colors, and how fast."""

from __future__ import annotations

import numpy as np
from msgspec import Struct


class BrowserMessageLimits(Struct, frozen=True, kw_only=True):
    """Messages of browsers."""

    max_message_bytes: int = 1 << 16
    """Longest message from a browser."""


BROWSER_MESSAGES = BrowserMessageLimits()


class ClientTuning(Struct, frozen=True, kw_only=True):
    """One browser."""

    kept_view_timeout_s: float = 1.0
    """Longest wait for the view that the browser kept [s]."""
    play_s: float = 0.2
    """Time each multiframe is shown during playback [s]."""
    kept_actions: int = 16
    """Clicks and keys that wait for the thread; of more the oldest are dropped."""


CLIENTS = ClientTuning()


class PointBudgetTuning(Struct, frozen=True, kw_only=True):
    """How many points a browser is given."""

    phone_points: int = 300_000
    """Most points on a phone."""
    first_points: int = 200_000
    """Points before the speed of the browser is known."""
    fewest_points: int = 60_000
    """Smallest budget."""
    quick_s: float = 0.25
    """Response time below which the budget grows [s]."""
    slow_s: float = 0.7
    """Response time above which the budget shrinks [s]."""
    hold_s: float = 3.0
    """Longest wait for a response [s]."""


POINT_BUDGET = PointBudgetTuning()


class PointerColors(Struct, frozen=True, kw_only=True):
    """Colors of what is picked."""

    picked_color: tuple[int, int, int] = (255, 255, 255)
    """A picked point."""


POINTER_COLORS = PointerColors()


class ShowTuning(Struct, frozen=True, kw_only=True):
    """What a browser is shown."""

    phone_width_px: int = 700
    """A narrower window is that of a phone [px]."""
    narrow_fov_rad: float = np.deg2rad(6.0)
    usual_fov_rad: float = np.deg2rad(75.0)
    """Field of view of a narrow and of a usual camera [rad]."""
    redraw_growth: float = 0.2
    """Relative growth of the map after which the camera is moved to fit it."""


SHOW = ShowTuning()


class ViewLimits(Struct, frozen=True, kw_only=True):
    """A view that a browser sends."""

    max_measurements: int = 200
    """Measurements that are kept."""
    max_number: float = 1e12
    """Largest coordinate or end of a range: differences and squares of such numbers are finite."""
    max_stretch_text: int = 400
    """Characters of a fragment that are read."""


VIEWS = ViewLimits()


class DetailTuning(Struct, frozen=True, kw_only=True):
    """Points that are loaded step by step."""

    batch_points: int = 60_000
    """Points sent before checking whether the camera has moved."""
    color_batch_points: int = 400_000
    """The same where only colors are sent."""
    max_behind: int = 2
    """Messages that may wait for the browser before the next batch."""


DETAIL = DetailTuning()


class LodTuning(Struct, frozen=True, kw_only=True):
    """Level of detail."""

    strata: int = 64
    """Number of interleaved samples in which a tile of the map is stored
    (`recon4.mapping.tile`)."""
    strata_ends: tuple[int, ...] = (1, 2, 4, *range(8, strata + 1, 4))
    """Sample counts at which chunks end; the larger ones stay below a 16th of the tile."""
    nearest_m: float = 0.5
    """A tile the camera is in is taken to be this far away [m]."""
    fine_px: float = 1.0
    """Points nearer to each other on screen than this need no more between them."""
    edge_weight: float = 0.4
    """Detail at the edge of the view, relative to that in its center."""


LOD = LodTuning()


class MultiframeTuning(Struct, frozen=True, kw_only=True):
    """Single multiframes."""

    max_points: int = 150_000
    """A window with more points is thinned out."""
    slack_ns: int = 500_000_000
    """Largest time of a point outside the trajectory [ns]."""
    highlight: tuple[int, int, int] = (255, 145, 0)
    """A multiframe over the map."""


MULTIFRAMES = MultiframeTuning()


class PaletteColors(Struct, frozen=True, kw_only=True):
    """Colors of sensors."""

    sensor_colors: tuple[tuple[int, int, int], ...] = (
        (86, 180, 233),
        (230, 159, 0),
        (0, 158, 115),
        (204, 121, 167),
        (240, 228, 66),
    )
    """Distinguishable with color vision deficiency (Okabe and Ito 2008)."""


PALETTE = PaletteColors()


class CloudPartTuning(Struct, frozen=True, kw_only=True):
    """Parts of the cloud."""

    base_points: int = 60_000
    """Most points of the coarsest sample, which is sent first and always on screen."""
    painted_points: int = 6_000_000
    """Points whose colors are cached, for clients with the same view [3 bytes each]."""


CLOUD_PARTS = CloudPartTuning()


class PointPickTuning(Struct, frozen=True, kw_only=True):
    """Picking of points."""

    edge_px: float = 7.0
    """Largest distance on screen at which an edge is picked."""
    point_px: tuple[float, float] = (3.0, 12.0)
    """Search radii around the ray, tried in this order."""
    most_cells: int = 200
    """Cells on either side in which a surface is looked for."""
    same_surface_m: float = 0.05
    """Points up to this far behind the first hit are on the same surface [m]."""


POINT_PICKS = PointPickTuning()


class CloudPreviewTuning(Struct, frozen=True, kw_only=True):
    """The cloud while a map is made."""

    every_s: float = 1.0
    """Interval of the multiframes shown [s]."""
    piece: int = 10
    """Multiframes that are sent together."""
    max_points: int = 150_000
    """Most points in total."""
    max_of_one: int = 2000
    """Most points of one multiframe."""
    same_m: float = 0.02
    """Poses that moved by less count as unchanged [m]."""


CLOUD_PREVIEW = CloudPreviewTuning()


class ViewerPoolTimes(Struct, frozen=True, kw_only=True):
    """Viewers of projects."""

    starts_within_s: float = 60.0
    """A viewer that does not listen after this much time of its own has failed [s]."""
    ends_within_s: float = 5.0
    """A viewer requested to end is killed after this long [s]."""


VIEWER_POOL = ViewerPoolTimes()


class ViewerProcessTuning(Struct, frozen=True, kw_only=True):
    """The process of a viewer."""

    memory_fraction: float = 0.7
    """Part of the memory of the machine that it may use."""
    look_every_s: float = 0.5
    """Interval of checking for new artifacts and events of a running job [s]."""


VIEWER_PROCESS = ViewerProcessTuning()


class RelayLimits(Struct, frozen=True, kw_only=True):
    """The relay of WebSockets."""

    messages_a_second: float = 120.0
    """Most messages read from a browser per second; a moving camera sends 60 per second."""
    burst: int = 240
    """Most messages at once."""
    attempts: int = 3
    """Most starts of a viewer for one connection."""
    stalled_s: float = 30.0
    """A browser that reads nothing for this long is disconnected [s]."""


RELAY = RelayLimits()


class SceneTuning(Struct, frozen=True, kw_only=True):
    """What the scene shows."""

    closed_m: float = 2.0
    """Start and end nearer than this have one label [m]."""
    max_frames: int = 1000
    """More body frames than this are thinned out."""
    max_poses: int = 20_000
    """A trajectory of more poses is thinned out for drawing."""
    piece: int = 500
    """Segments of a line, or edges, that are sent together."""
    mark_m: float = 0.12
    """Half the size of the crosses at GNSS positions and measured points [m]."""
    under_m: float = 0.05
    """Of the image of a 2-D map below the trajectory [m]."""
    free_color: tuple[int, int, int] = (38, 50, 56)
    """Cells that are free."""
    measured_color: tuple[int, int, int] = (255, 235, 59)
    """Measurements."""


SCENE = SceneTuning()


class EdgeColors(Struct, frozen=True, kw_only=True):
    """Colors of edges."""

    rejected_color: tuple[int, int, int] = (244, 67, 54)
    """Rejected."""
    unverified_color: tuple[int, int, int] = (158, 158, 158)
    """Unverified."""


EDGE_COLORS = EdgeColors()


class LiveSceneTimes(Struct, frozen=True, kw_only=True):
    """The scene of a capture."""

    silent_s: float = 30.0
    """A job without a heartbeat for this long is not followed [s]."""


LIVE_SCENE = LiveSceneTimes()


class MarkTuning(Struct, frozen=True, kw_only=True):
    """A marked place."""

    mark_color: tuple[int, int, int] = (255, 64, 160)
    """Its color."""
    mark_width_px: float = 7.0
    """Of the stretch, over the line of the trajectory."""


MARK = MarkTuning()
