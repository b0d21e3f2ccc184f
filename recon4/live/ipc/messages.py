"""Builds messages for clients: plain JSON values, arrays in base64 (``docs/live.md``)."""

from __future__ import annotations

import base64
import zlib
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.live.preview.cloud import Chunk
from recon4.live.preview.coverage import CELL_M, Coverage

Message = dict[str, Any]

_MOST_GAPS = 50


@dataclass(frozen=True, slots=True)
class Snapshot:
    """The current state of a capture; its messages are built without blocking the mapping."""

    path: list[list[float]]
    chunk: Chunk | None
    others: list[Message]

    def messages(self) -> list[Message]:
        """The messages for a client that connects late."""
        points = [] if self.chunk is None else [points_message(self.chunk)]
        return [{"kind": "path", "points": self.path}, *points, *self.others]


def points_message(chunk: Chunk) -> Message:
    """The message ``points``: points of the preview."""
    return {
        "kind": "points",
        "generation": chunk.generation,
        "start": chunk.start,
        "count": len(chunk.values),
        "voxel_m": chunk.voxel_m,
        "voxels": _base64(chunk.voxels),
        "values": _base64(chunk.values),
    }


def plan_message(coverage: Coverage) -> Message:
    """The message ``plan``: coverage of the floor the body is on."""
    first_cell, seen = coverage.seen()
    return {
        "kind": "plan",
        "floor": coverage.floor,
        "cell_m": CELL_M,
        "first_cell": first_cell.tolist(),
        "shape": list(seen.shape),
        "seen": _base64(np.frombuffer(zlib.compress(seen.tobytes(), 1), np.uint8)),
    }


def gaps_message(coverage: Coverage) -> Message:
    """The message ``gaps``: gaps on this floor, and their count on other floors."""
    gaps = [
        {"p": list(gap.p_map), "width_m": gap.width_m, "away_m": round(gap.away_m, 2)}
        for gap in coverage.gaps()[:_MOST_GAPS]
    ]
    well, elsewhere = figure(coverage.well_seen_ratio()), coverage.gaps_elsewhere()
    return {"kind": "gaps", "gaps": gaps, "well": well, "elsewhere": elsewhere}


def figure(value: float) -> float | None:
    """A number rounded to four digits; None if it is not finite."""
    return float(f"{value:.4g}") if np.isfinite(value) else None


def _base64(values: NDArray[Any]) -> str:
    return base64.b64encode(np.ascontiguousarray(values).tobytes()).decode("ascii")
