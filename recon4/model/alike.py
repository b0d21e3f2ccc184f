"""All things like one that a person picked, as clusters of the points of their class."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from recon4.errors import ConfigError
from recon4.locales.coded import CodedText
from recon4.model.cell_clusters import CellCluster, Clusters
from recon4.model.class_corrections import Reclassified
from recon4.model.classes import CLASSES

Vector = tuple[float, float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class PickedThing:
    """What a person picked, to find all like it."""

    place_m: Vector
    """On or beside one of its points, in the map [m]."""
    to: int
    """The new class, a code of `PointClass`."""
    only: tuple[int, ...] = ()
    """It has one of these classes; empty = one of those that the map delivers."""

    def __post_init__(self) -> None:
        if not np.isfinite(self.place_m).all():
            raise ConfigError(CodedText("place-expected", place_m=str(self.place_m)))

    @property
    def classes(self) -> tuple[int, ...]:
        """Codes of the classes that it may have."""
        delivered = tuple(int(one) for one, facts in CLASSES.items() if facts.delivered)
        return tuple(one for one in self.only or delivered if one != self.to)


@dataclass(frozen=True, slots=True, kw_only=True)
class AlikeCluster:
    """A cluster, and how different it is from the picked one."""

    cluster: CellCluster
    points: int
    low_m: Vector
    high_m: Vector
    """Its bounds in the map [m]."""
    difference: float
    """0 = the same; 1 = as different as one thing looks from two sides. The largest difference of
    all evidence."""
    over_ground_m: float | None
    """From the ground to its lowest points [m]; None = no ground was seen below."""
    planarity: float
    """0 to 1."""
    seen_through: float | None
    """Part of the beams that pass through it, 0 to 1; None = too few."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Alike:
    """Clusters like a picked one."""

    of: int
    """Their class, a code of `PointClass`."""
    edge_m: float
    """Of their cells [m]."""
    clusters: tuple[AlikeCluster, ...]
    """The picked one first, then those most like it."""
    left_out: int
    """Further ones, for which a correction has no room."""

    def reclassified(self, to: int, *, most_different: float) -> Reclassified:
        """The correction that gives them another class.

        Args:
            to: Code of the new class.
            most_different: More different ones are left as they are.
        """
        chosen = [one.cluster for one in self.clusters if one.difference <= most_different]
        volume = Clusters(clusters=tuple(chosen), edge_m=self.edge_m)
        return Reclassified(volume=volume, to=to, only=(self.of,))
