"""How much of a recording is not used, over all reasons: one rule for every kind of recording."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from recon4.model.finding import Value
from recon4.model.import_counts import Loss, losses, meaning
from recon4.model.tuning import LOSSES

_SAMPLES = {"imu_kept", "gnss_kept", "gnss_samples", "sample_datagrams", "positions"}
"""Counts of what only supports a map: the stages that use it judge what is missing."""


@dataclass(frozen=True, slots=True)
class UnusedPart:
    """Data of one kind of which at least `LOSSES.warned_ratio` is not used."""

    name: str
    """Count of the data of this kind."""
    number: int
    """How many are not used."""
    total: int
    reasons: tuple[Loss, ...]
    """Largest first."""

    @property
    def is_severe(self) -> bool:
        """Whether most of what the map is made of is missing: the map must not be used."""
        return self.name not in _SAMPLES and self.number > LOSSES.severe_ratio * self.total

    @property
    def is_scattered(self) -> bool:
        """Whether each reason by itself is too rare for a warning."""
        return not any(loss.ratio >= LOSSES.warned_ratio for loss in self.reasons)

    @property
    def values(self) -> dict[str, Value]:
        """As values of a finding: how many of how many, and how many for each reason."""
        return {
            "data": self.name,
            "number": self.number,
            "total": self.total,
            "ratio": self.number / self.total,
            "reasons": " ".join(f"{loss.name}={loss.number}" for loss in self.reasons),
        }


def unused_parts(counts: Mapping[str, int]) -> list[UnusedPart]:
    """Parts of a recording of which more than `warned_ratio` is not used, the largest ratio first.

    What is usual (points nearer than the limit, beams without a return) and what was repaired is
    no loss.

    Args:
        counts: Of an import.
    """
    groups: dict[str, list[Loss]] = {}
    for loss in losses(counts):
        if of := meaning(loss.name).of:
            groups.setdefault(of, []).append(loss)
    parts = [_part(name, tuple(reasons), counts) for name, reasons in groups.items()]
    large = [part for part in parts if part.number >= LOSSES.warned_ratio * part.total]
    return sorted(large, key=lambda part: -part.number / part.total)


def _part(name: str, reasons: tuple[Loss, ...], counts: Mapping[str, int]) -> UnusedPart:
    number = sum(loss.number for loss in reasons)
    apart = sum(loss.number for loss in reasons if meaning(loss.name).apart)
    return UnusedPart(name, number, max(counts.get(name, 0) + apart, number), reasons)
