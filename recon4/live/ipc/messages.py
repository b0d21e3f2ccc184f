"""Builds messages of the mapper from its preview and coverage."""

from __future__ import annotations

import zlib
from dataclasses import dataclass

from recon4.live.preview.cloud import Chunk
from recon4.live.preview.coverage import Coverage
from recon4.live.preview.tuning import PLAN_TILES
from recon4.live.protocol import Gap, Gaps, MapperMessage, Path, Plan, Points
from recon4.live.tuning import MESSAGES
from recon4.model.plain import finite_or_none


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
        cell_m=PLAN_TILES.cell_m,
        first_cell=first_cell.tolist(),
        shape=list(seen.shape),
        seen=zlib.compress(seen.tobytes(), 1),
    )


class PlanSchedule:
    """Decides when the plan is sent: a large one less often."""

    def __init__(self) -> None:
        self.newest: list[Plan] = []
        """The last plan that was sent."""
        self._due_ns = self._floor = 0

    def due(self, coverage: Coverage, now_ns: int) -> list[Plan]:
        """The message ``plan``, unless the next one is not due because the last one was large."""
        if now_ns < self._due_ns and coverage.floor == self._floor:
            return []
        plan, self._floor = plan_message(coverage), coverage.floor
        lasts_s = 4 * -(-len(plan.seen) // 3) / MESSAGES.plan_bytes_per_s  # in base64
        self._due_ns = now_ns + round(1e9 * lasts_s)
        self.newest = [plan]
        return self.newest

    def reset(self) -> None:
        """The next plan is due at once."""
        self.newest, self._due_ns = [], 0


def gaps_message(coverage: Coverage) -> Gaps:
    """The message ``gaps``: gaps on this floor, and their count on other floors."""
    gaps = [
        Gap(p=list(gap.p_map), width_m=gap.width_m, away_m=round(gap.away_m, 2))
        for gap in coverage.gaps()[: MESSAGES.max_gaps]
    ]
    return Gaps(
        gaps,
        well=finite_or_none(coverage.well_seen_ratio(), 4),
        elsewhere=coverage.gaps_elsewhere(),
    )
