"""Requests and responses about corrections of classes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

from pydantic import Field

from recon4.model.class_corrections import Reclassified, class_named
from recon4.model.tuning import VOLUMES
from recon4.model.volumes import Box, Brush, Prism, Sphere, Volume
from recon4_app.names import Note
from recon4_app.review.alike_model import ClustersSpec, StrictSpec, Title, Xyz
from recon4_app.review.model import Finite


class BoxSpec(StrictSpec):
    """A box with any orientation."""

    shape: Literal["box"]
    center_m: Xyz
    """In the map [m]."""
    size_m: Xyz
    """Along u, v and u × v [m]."""
    u: Xyz = (1.0, 0.0, 0.0)
    """Unit vectors along two edges."""
    v: Xyz = (0.0, 1.0, 0.0)

    def volume(self) -> Volume:
        """The same as a record.

        Raises:
            ConfigError: If it is empty, or its axes are none.
        """
        return Box(center_m=self.center_m, size_m=self.size_m, u=self.u, v=self.v)


class SphereSpec(StrictSpec):
    """A ball."""

    shape: Literal["sphere"]
    center_m: Xyz
    """In the map [m]."""
    radius_m: Finite

    def volume(self) -> Volume:
        """The same as a record.

        Raises:
            ConfigError: If it is empty.
        """
        return Sphere(center_m=self.center_m, radius_m=self.radius_m)


class PrismSpec(StrictSpec):
    """A polygon in a plane, extended along the normal u × v; the plane is level by default."""

    shape: Literal["prism"]
    polygon_m: Annotated[
        list[tuple[Finite, Finite]], Field(min_length=3, max_length=VOLUMES.most_corners)
    ]
    """Corners along u and v, in order, not closed [m]."""
    low_m: Finite
    """Where it begins along the normal [m]."""
    high_m: Finite
    """Where it ends [m]."""
    origin_m: Xyz = (0.0, 0.0, 0.0)
    """Place in the map where u, v and the distance along the normal are 0 [m]."""
    u: Xyz = (1.0, 0.0, 0.0)
    v: Xyz = (0.0, 1.0, 0.0)

    def volume(self) -> Volume:
        """The same as a record.

        Raises:
            ConfigError: If it is empty, its edges cross, or its axes are none.
        """
        return Prism(
            polygon_m=tuple(self.polygon_m),
            low_m=self.low_m,
            high_m=self.high_m,
            origin_m=self.origin_m,
            u=self.u,
            v=self.v,
        )


class BrushSpec(StrictSpec):
    """What a brush painted: all that lies within its radius of a path.

    Neighboring places are joined if they are at most a width of the brush apart.
    """

    shape: Literal["brush"]
    path_m: Annotated[list[Xyz], Field(min_length=1, max_length=VOLUMES.most_places)]
    """Places in the map, in the order in which they were painted [m]."""
    radius_m: Finite
    across: Xyz | None = None
    """Unit normal of the slice that was painted on; None = round in all directions."""
    thick_m: Finite = 0.0
    """Of the slice [m]; 0 without ``across``."""

    def volume(self) -> Volume:
        """The same as a record.

        Raises:
            ConfigError: If it is empty, or its normal is none.
        """
        return Brush(
            path_m=tuple(self.path_m),
            radius_m=self.radius_m,
            across=self.across,
            thick_m=self.thick_m,
        )


class CorrectionSpec(StrictSpec):
    """Points in a volume that get another class."""

    volume: Annotated[
        BoxSpec | SphereSpec | PrismSpec | BrushSpec | ClustersSpec, Field(discriminator="shape")
    ]
    to: Title
    """The new class."""
    only: list[Title] = Field(default=[], max_length=20)
    """Only points that have one of these classes; empty = one of those that the map delivers."""
    map: Annotated[str, Field(max_length=64)]
    """Key of the map that the person looks at; 409 if it was made again meanwhile."""

    def reclassified(self) -> Reclassified:
        """The same as a record.

        Raises:
            ConfigError: If the volume is none, or a class is not known.
        """
        return Reclassified(
            volume=self.volume.volume(),
            to=int(class_named(self.to)),
            only=tuple(int(class_named(one)) for one in self.only),
        )


class NewCorrection(CorrectionSpec):
    """A correction that is made."""

    why: Annotated[Note, Field(max_length=500)] = ""
    seen_seq: Annotated[int, Field(ge=0, le=1 << 40)]
    """Number of journal rows when the points were counted; 409 if another person corrected classes
    since."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CorrectionCount:
    """What a correction would change."""

    points: int
    now: dict[str, int]
    """Title of their class now -> how many of them."""
    inside: int
    """Points in the volume, those that the map leaves out as well."""
    refused: str
    """Why it cannot be made; empty = it can."""
    seq: int
    """Number of journal rows when they were counted."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CorrectionView:
    """A correction in force."""

    id: str
    to: str
    only: list[str]
    points: int
    """How many points it changed when it was made."""
    who: str
    why: str
    time: str
    in_map: bool
    """Whether the map has it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CorrectionsView:
    """The corrections of classes of a project."""

    seq: int
    """Number of rows of the journal."""
    corrections: list[CorrectionView]
    """In the order in which they apply."""
    withdrawn: list[str]
    """Ids of those that are still in the map and no longer in force."""
    may_correct: bool
    may_process: bool
    """Whether the caller may have the map made again."""
    classes: list[str]
    """Titles of the classes that points can get."""
    left_out: list[str]
    """Those of them that the map leaves out by default."""
