"""Corrections of classes by people, as a run is given them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from recon4.errors import ConfigError
from recon4.locales.coded import CodedText
from recon4.model.classes import CLASSES, PointClass
from recon4.model.volumes import Volume

GIVEN_CLASSES = tuple(one for one in CLASSES if one is not PointClass.NEVER_CLASSIFIED)
"""Classes that a person can give to points."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Reclassified:
    """Points in a volume get another class."""

    volume: Volume
    """In the frame of the map."""
    to: int
    """The new class, a code of `PointClass`."""
    only: tuple[int, ...] = ()
    """Only points that have one of these classes; empty = one of those that the map delivers."""

    def __post_init__(self) -> None:
        known = {int(one) for one in CLASSES}
        if self.to not in known - {int(PointClass.NEVER_CLASSIFIED)} or not {*self.only} <= known:
            raise ConfigError(CodedText("class-expected", to=self.to, only=str(self.only)))


@dataclass(frozen=True, slots=True, kw_only=True)
class Anchor:
    """Where the body was when it measured some of the points."""

    t_ns: int
    T_map_body: tuple[float, ...]
    """x y z [m], quaternion x y z w."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ClassCorrection:
    """A correction, and what leads it into another map of the same walk."""

    what: Reclassified
    points: int
    """How many points it changed in the map that the person looked at."""
    map_key: str
    """Key of that map."""
    anchors: tuple[Anchor, ...]
    """In that map, in order of time; at least one."""

    def __post_init__(self) -> None:
        if not self.anchors or self.points <= 0:
            raise ConfigError(CodedText("class-none-changed"))


def class_named(name: str) -> PointClass:
    """The class with a title, or with a code as LAS files have it.

    Raises:
        ConfigError: If there is none.
    """
    wanted = name.strip().casefold()
    for one, facts in CLASSES.items():
        if wanted in (facts.title, str(int(one))):
            return one
    known = ", ".join(facts.title for facts in CLASSES.values())
    raise ConfigError(CodedText("class-unknown", name=name, known=known))


def titles_of(classes: Sequence[int]) -> tuple[str, ...]:
    """What people read of classes."""
    return tuple(CLASSES[PointClass(one)].title for one in classes)
