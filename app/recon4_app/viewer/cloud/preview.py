"""Preview of the walk while there is no map: one multiframe per second at its current pose.

The points of some seconds are one node, so that a growing walk sends only its last seconds. A node
is placed again when its poses change (a loop closure, the refinement).
"""

from __future__ import annotations

import threading
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.model.trajectory import Trajectory
from recon4_app.viewer.cloud.multiframes import Multiframes
from recon4_app.viewer.cloud.palette import Palette, Range, paint
from recon4_app.viewer.scene.nodes import PointsNode
from recon4_app.viewer.tuning import CLOUD_PREVIEW

HEIGHTS = Range(-2.0, 1.0)
"""Heights above the body at the ends of the palette [m]. Higher points are left out: ceilings would
hide the walk."""


@dataclass(frozen=True, slots=True, eq=False)
class _Piece:
    rows: NDArray[np.intp]
    """Multiframes in it."""
    at: Array
    """Position and heading of the body at each, to detect changed poses, (K, 6)."""
    origin_m: Array
    p_piece: NDArray[np.float32]
    """(N, 3)"""
    height_m: NDArray[np.float32]
    """Above the body at the time of the multiframe, (N,)."""


class JobPreview:
    """Caches the placed points; thread-safe."""

    def __init__(self, frames: Multiframes) -> None:
        self._frames = frames
        self._rows = _one_a_second(frames)
        self._of_one = int(
            np.clip(
                CLOUD_PREVIEW.max_points // max(len(self._rows), 1), 20, CLOUD_PREVIEW.max_of_one
            )
        )
        self._pieces: dict[int, _Piece] = {}
        self._painted: dict[tuple[int, Palette], tuple[_Piece, NDArray[np.uint8]]] = {}
        self._lock = threading.Lock()

    def nodes(self, line: Trajectory, *, palette: Palette, size_m: float) -> list[PointsNode]:
        """The points of the walk as far as a trajectory reaches, by height above the body."""
        t_ns = self._frames.t_mid_ns[self._rows]
        # the end of a growing trajectory still changes
        reached = self._rows[(t_ns >= line.t_ns[0]) & (t_ns + 100_000_000 <= line.t_ns[-1])]
        with self._lock:
            return list(self._draw(reached, line, palette, size_m=size_m))

    def _draw(
        self, rows: NDArray[np.intp], line: Trajectory, palette: Palette, *, size_m: float
    ) -> Iterator[PointsNode]:
        for number, begin in enumerate(range(0, len(rows), CLOUD_PREVIEW.piece)):
            piece = self._piece(number, rows[begin : begin + CLOUD_PREVIEW.piece], line)
            if piece is not None:
                yield PointsNode(
                    path=f"/preview/{number}",
                    position_m=piece.origin_m,
                    p_node=piece.p_piece,
                    rgb=self._colors(number, piece, palette),
                    size_m=1.5 * size_m,
                )

    def _piece(self, number: int, rows: NDArray[np.intp], line: Trajectory) -> _Piece | None:
        T = line.at(self._frames.t_mid_ns[rows])
        at = np.concatenate([T.t, T.R[:, :, 0]], axis=1)
        kept = self._pieces.get(number)
        if (
            kept is not None
            and np.array_equal(kept.rows, rows)
            and np.allclose(kept.at, at, atol=CLOUD_PREVIEW.same_m, rtol=0.0)
        ):
            return kept
        placed = [self._frames.thinned(int(row), line, most=self._of_one) for row in rows]
        height_m = [p_map[:, 2] - t[2] for p_map, t in zip(placed, T.t, strict=True)]
        p_map, height = np.concatenate(placed), np.concatenate(height_m).astype(np.float32)
        p_map, height = p_map[height <= HEIGHTS.high], height[height <= HEIGHTS.high]
        if len(p_map) == 0:
            return None
        piece = _Piece(rows, at, p_map[0], (p_map - p_map[0]).astype(np.float32), height)
        self._pieces[number] = piece
        return piece

    def _colors(self, number: int, piece: _Piece, palette: Palette) -> NDArray[np.uint8]:
        made = self._painted.get((number, palette))
        if made is None or made[0] is not piece:
            made = (piece, paint(piece.height_m, HEIGHTS, palette))
            self._painted[number, palette] = made
        return made[1]


def _one_a_second(frames: Multiframes) -> NDArray[np.intp]:
    """Rows of the first multiframe in each second that has one."""
    t_ns = frames.t_mid_ns
    if len(t_ns) == 0:
        return np.empty(0, np.intp)
    second = (t_ns - t_ns[0]) // round(CLOUD_PREVIEW.every_s * 1e9)
    return np.flatnonzero(np.diff(second, prepend=-1) > 0)
