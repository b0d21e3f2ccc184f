"""Corrections of classes in force, led into the map that is made, and what became of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from recon4.classes.corrections import PlacedCorrection, place_correction
from recon4.mapping.class_corrections import ClassVolumes
from recon4.model.cell_clusters import Clusters
from recon4.model.class_corrections import titles_of
from recon4.model.figures import CorrectedClass
from recon4.model.plain import finite_or_none
from recon4.model.trajectory import Trajectory
from recon4.model.volumes import corners_of
from recon4.review.decisions import StandingCorrection


@dataclass(frozen=True, slots=True, eq=False)
class CorrectionsInMap:
    """Corrections in force, in the order in which they apply."""

    standing: Sequence[StandingCorrection]
    placed: Sequence[PlacedCorrection]
    """Of each of them."""

    @property
    def volumes(self) -> ClassVolumes | None:
        """Those that apply; None = none does."""
        found = [one.what for one in self.placed if one.what is not None]
        return ClassVolumes.of(found) if found else None


def corrections_in(
    standing: Sequence[StandingCorrection], trajectory: Trajectory
) -> CorrectionsInMap:
    """Lead corrections into the map with a trajectory ``T_map_body``."""
    return CorrectionsInMap(
        standing, [place_correction(one.correction, trajectory) for one in standing]
    )


def corrected(found: CorrectionsInMap, counts: Sequence[int]) -> tuple[CorrectedClass, ...]:
    """What became of corrections.

    Args:
        found: All in force.
        counts: Points that each of those changed that apply.
    """
    changed = iter(counts)
    return tuple(
        CorrectedClass(
            id=one.id,
            to=titles_of([one.correction.what.to])[0],
            who=one.who,
            why=one.why,
            time=one.time,
            points_then=one.correction.points,
            points=next(changed) if placed.what is not None else 0,
            applied=placed.what is not None,
            moved_m=finite_or_none(placed.moved_m, 4),
            apart_m=finite_or_none(placed.apart_m, 4),
            place_m=_middle(one),
            lost=placed.lost,
        )
        for one, placed in zip(found.standing, found.placed, strict=True)
    )


def _middle(one: StandingCorrection) -> tuple[float, float, float]:
    volume = one.correction.what.volume
    if isinstance(volume, Clusters):  # that of the first thing, which a person picked
        volume = Clusters(clusters=volume.clusters[:1], edge_m=volume.edge_m)
    x, y, z = corners_of(volume).mean(axis=0).round(3).tolist()
    return x, y, z
