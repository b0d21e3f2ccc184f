"""Builds messages of the mapper from its preview and coverage."""

from __future__ import annotations

import zlib
from dataclasses import dataclass

from recon4.live.preview.cloud import Chunk
from recon4.live.preview.coverage import CELL_M, Coverage
from recon4.live.protocol import Gap, Gaps, MapperMessage, Path, Plan, Points
from recon4.model.plain import finite_or_none

_MAX_GAPS = 50


@dataclass(frozen=True, slots=True)
class Snapshot:
    """The current state of a capture; its messages are built without blocking the mapping."""

    path: list[list[float]]
    chunk: Chunk | None
    others: list[MapperMessage]

    def messages(self) -> list[MapperMessage]:
        """The messages for a client that connects late."""
        points = [] if self.chunk is None else [points_message(self.chunk)]
        return [Path(self.path), *points, *self.others]


def points_message(chunk: Chunk) -> Points:
    """The message ``points``: points of the preview."""
    return Points(
        generation=chunk.generation,
        start=chunk.start,
        count=len(chunk.values),
        voxel_m=chunk.voxel_m,
        voxels=chunk.voxels.tobytes(),
        values=chunk.values.tobytes(),
    )


def plan_message(coverage: Coverage) -> Plan:
    """The message ``plan``: coverage of the floor the body is on."""
    first_cell, seen = coverage.seen()
    return Plan(
        floor=coverage.floor,
        cell_m=CELL_M,
        first_cell=first_cell.tolist(),
        shape=list(seen.shape),
        seen=zlib.compress(seen.tobytes(), 1),
    )


def gaps_message(coverage: Coverage) -> Gaps:
    """The message ``gaps``: gaps on this floor, and their count on other floors."""
    gaps = [
        Gap(p=list(gap.p_map), width_m=gap.width_m, away_m=round(gap.away_m, 2))
        for gap in coverage.gaps()[:_MAX_GAPS]
    ]
    return Gaps(
        gaps,
        well=finite_or_none(coverage.well_seen_ratio(), 4),
        elsewhere=coverage.gaps_elsewhere(),
    )
