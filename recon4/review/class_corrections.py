"""Corrections of classes in a project: which are in its map, and what a new one would change."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import msgspec

from recon4.classes.corrections import correction_of, count_points, place_correction
from recon4.classes.likeness import find_alike
from recon4.errors import StoreError
from recon4.locales.coded import CodedText, StoredText
from recon4.mapping.tiles import TileSet
from recon4.model.alike import Alike, PickedThing
from recon4.model.class_corrections import ClassCorrection, Reclassified, titles_of
from recon4.model.trajectory import Trajectory
from recon4.review.decisions import Decided
from recon4.store.arrays import load_trajectory
from recon4.untrusted.typed import as_type


class _InMap(msgspec.Struct, frozen=True):
    """What tells a correction in ``summary.json``."""

    id: str


@dataclass(frozen=True, slots=True)
class CorrectionsNotInMap:
    """How the corrections in force differ from those in the map."""

    corrections: tuple[ClassCorrection, ...]
    """In force, and not in the map."""
    withdrawn: tuple[str, ...]
    """Ids of those in the map that are no longer in force, or not in this order."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CorrectionTrial:
    """What a correction would change in a map; nothing is changed."""

    points: int
    """How many points change."""
    now: dict[str, int]
    """Title of their class now -> how many of them."""
    inside: int
    """Points in the volume, those that the map leaves out as well."""
    refused: StoredText | None
    """Why it is not made; None = it may be."""
    correction: ClassCorrection | None
    """As the journal keeps it; None = it is refused."""


def corrections_in_map(summary: Mapping[str, object] | None) -> tuple[str, ...]:
    """Ids of the corrections in the map of a ``summary.json``, in their order.

    Raises:
        StoreError: If it is damaged.
    """
    try:
        found = as_type((summary or {}).get("corrections", ()), tuple[_InMap, ...])
    except msgspec.ValidationError as error:
        raise StoreError(CodedText("summary-corrections-unreadable", why=str(error))) from error
    return tuple(one.id for one in found)


def not_in_map(decided: Decided, in_map: Sequence[str]) -> CorrectionsNotInMap:
    """Compare the corrections in force with those in the map, `corrections_in_map`."""
    in_force = [one.id for one in decided.corrections]
    same = next(
        (k for k, (a, b) in enumerate(zip(in_force, in_map, strict=False)) if a != b),
        min(len(in_force), len(in_map)),
    )
    left = (one.correction for one in decided.corrections[same:])
    return CorrectionsNotInMap(tuple(left), tuple(in_map[same:]))


def try_correction(
    artifacts: Mapping[str, Path], what: Reclassified, before: Sequence[ClassCorrection] = ()
) -> CorrectionTrial:
    """Count what a correction would change.

    Args:
        artifacts: Of the run that made the map.
        what: The correction, in the frame of the map.
        before: Corrections in force that are not in the map yet; they apply first.

    Raises:
        StoreError: If the project has no classes of points, or an artifact cannot be read.
    """
    trajectory = _trajectory(artifacts)
    counted = count_points(TileSet.open(artifacts["map"]), what, _placed(before, trajectory))
    refused = counted.why_none(what)
    made = None
    if not refused:
        made = correction_of(what, counted, trajectory, map_key=artifacts["map"].name)
    return CorrectionTrial(
        points=counted.points,
        now={titles_of([one])[0]: count for one, count in counted.changed.items()},
        inside=sum(counted.inside.values()),
        refused=StoredText.of(refused) if refused else None,
        correction=made,
    )


def propose_alike(
    artifacts: Mapping[str, Path], picked: PickedThing, before: Sequence[ClassCorrection] = ()
) -> Alike:
    """All things like one that a person picked; nothing is changed.

    Args:
        artifacts: Of the run that made the map.
        picked: The thing, in the frame of the map.
        before: Corrections in force that are not in the map yet; they apply first.

    Raises:
        ConfigError: If nothing is there, or it is too large for a correction.
        StoreError: If the project has no classes of points, or an artifact cannot be read.
    """
    placed = _placed(before, _trajectory(artifacts))
    return find_alike(TileSet.open(artifacts["map"]), picked, placed)


def _trajectory(artifacts: Mapping[str, Path]) -> Trajectory:
    missing = [name for name in ("map", "level") if name not in artifacts]
    if missing:
        raise StoreError(CodedText("corrections-need", missing=", ".join(missing)))
    return load_trajectory(artifacts["level"] / "trajectory.npz")


def _placed(before: Sequence[ClassCorrection], trajectory: Trajectory) -> list[Reclassified]:
    placed = (place_correction(one, trajectory).what for one in before)
    return [one for one in placed if one is not None]
