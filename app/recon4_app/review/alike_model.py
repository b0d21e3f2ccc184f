"""Requests and responses about all things like one, to correct their classes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

from recon4.model.alike import Alike, PickedThing
from recon4.model.cell_clusters import CellCluster, Clusters
from recon4.model.class_corrections import class_named, titles_of
from recon4.model.tuning import CLUSTERS
from recon4.model.volumes import Volume
from recon4_app.review.model import Finite

Xyz = tuple[Finite, Finite, Finite]
Title = Annotated[str, Field(max_length=40)]
"""Title of a class, as ``classes`` of the list of corrections has it."""
_Number = Annotated[int, Field(ge=-CLUSTERS.most_number, le=CLUSTERS.most_number)]
Column = tuple[_Number, _Number, _Number, _Number]
"""Number along u, number along v, first and last number along u × v."""


class StrictSpec(BaseModel):
    """A part of a request, without further fields."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class ClusterSpec(StrictSpec):
    """Cubes of one thing, in columns along u × v."""

    origin_m: Xyz
    """Corner of the cube 0, 0, 0 in the map [m]."""
    columns: Annotated[list[Column], Field(min_length=1, max_length=CLUSTERS.most_columns)]
    u: Xyz = (1.0, 0.0, 0.0)
    """Unit vectors along two edges of the cubes."""
    v: Xyz = (0.0, 1.0, 0.0)

    def cluster(self) -> CellCluster:
        """The same as a record."""
        return CellCluster(origin_m=self.origin_m, columns=tuple(self.columns), u=self.u, v=self.v)


class ClustersSpec(StrictSpec):
    """Things that are alike, each as the cubes that its points lie in."""

    shape: Literal["clusters"]
    clusters: Annotated[list[ClusterSpec], Field(min_length=1, max_length=CLUSTERS.most)]
    edge_m: Finite
    """Of a cube [m]."""

    def volume(self) -> Volume:
        """The same as a record.

        Raises:
            ConfigError: If there are too many cubes, or their axes are none.
        """
        clusters = tuple(one.cluster() for one in self.clusters)
        return Clusters(clusters=clusters, edge_m=self.edge_m)


class LikeSpec(StrictSpec):
    """A thing that a person picked, to find all like it."""

    place_m: Xyz
    """On one of its points, in the map [m]."""
    to: Title
    """The new class."""
    only: list[Title] = Field(default=[], max_length=20)
    """It has one of these classes; empty = one of those that the map delivers."""
    map: Annotated[str, Field(max_length=64)]
    """Key of the map that the person looks at; 409 if it was made again meanwhile."""

    def picked(self) -> PickedThing:
        """The same as a record.

        Raises:
            ConfigError: If a class is not known.
        """
        return PickedThing(
            place_m=self.place_m,
            to=int(class_named(self.to)),
            only=tuple(int(class_named(one)) for one in self.only),
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class AlikeClusterView:
    """A thing, and how different it is from the picked one."""

    origin_m: tuple[float, float, float]
    columns: list[tuple[int, int, int, int]]
    """Its cubes, as a correction expects them."""
    low_m: tuple[float, float, float]
    high_m: tuple[float, float, float]
    """Its bounds in the map [m]."""
    points: int
    difference: float
    """0 = the same; 1 = as different as one thing looks from two sides."""
    over_ground_m: float | None
    """From the ground to its lowest points [m]; null = no ground was seen below."""
    planarity: float
    """0 to 1."""
    seen_through: float | None
    """Part of the beams that pass through it, 0 to 1; null = too few."""


@dataclass(frozen=True, slots=True, kw_only=True)
class AlikeView:
    """All things like a picked one; the picked one first, then those most like it."""

    only: str
    """Title of their class."""
    edge_m: float
    """Of their cubes [m]."""
    clusters: list[AlikeClusterView]
    left_out: int
    """Further ones, for which a correction has no room."""

    @staticmethod
    def of(found: Alike) -> AlikeView:
        """What was found, for a response."""
        return AlikeView(
            only=titles_of([found.of])[0],
            edge_m=found.edge_m,
            clusters=[
                AlikeClusterView(
                    origin_m=one.cluster.origin_m,
                    columns=list(one.cluster.columns),
                    low_m=one.low_m,
                    high_m=one.high_m,
                    points=one.points,
                    difference=one.difference,
                    over_ground_m=one.over_ground_m,
                    planarity=one.planarity,
                    seen_through=one.seen_through,
                )
                for one in found.clusters
            ],
            left_out=found.left_out,
        )
