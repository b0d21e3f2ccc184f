"""What can be chosen of an export: the one list for shell, pages and HTTP."""

from __future__ import annotations

import re
from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING, ClassVar

from recon4.errors import ConfigError
from recon4.locales.coded import CodedText
from recon4.untrusted.names import visible

if TYPE_CHECKING:
    from recon4.export.selection import PointSelection

Box = tuple[float, float, float, float, float, float]
"""Smallest x, y, z and largest x, y, z [m]."""


ClipBox = tuple[float, float, float, float, float, float, float]
"""Middle x, y, z and edges along x, y, z [m], turned about z by the last, counterclockwise [°]."""


def _said(text: str) -> dict[str, str]:
    """Metadata of an option: what it is for."""
    return {"help": text}


@dataclass(frozen=True, slots=True, kw_only=True)
class ExportOptions:
    """What is written of a map, and how; each kind of file takes some of it."""

    __pydantic_config__: ClassVar[dict[str, str]] = {"extra": "forbid"}
    """HTTP refuses what is none of these."""

    crs: str = field(default="", metadata=_said("As EPSG:5514+8357; default: the map's."))
    raw: bool = field(
        default=False, metadata=_said("Points where they were measured, not on fitted surfaces.")
    )
    all_points: bool = field(
        default=False, metadata=_said("Also noise, the carrier and what moves, by class.")
    )
    classes: tuple[int, ...] = field(
        default=(), metadata=_said("Only these classes; default: those of the map.")
    )
    box_m: Box | None = field(
        default=None,
        metadata=_said("Only points in X1,Y1,Z1,X2,Y2,Z2 in m, in the coordinates of the file."),
    )
    clip: tuple[ClipBox, ...] = field(
        default=(),
        metadata=_said(
            "Only points inside of all these boxes of the map: middle X,Y,Z and edges DX,DY,DZ in "
            "m, turned by DEG degrees."
        ),
    )
    storey: str = field(default="", metadata=_said("Only this storey: 0, 1, -1; default: all."))
    thin_m: float = field(
        default=0.0, metadata=_said("One point in each cube with this edge in m; default: all.")
    )
    pixel_m: float = field(default=0.01, metadata=_said("Edge of a pixel in m."))
    cell_m: float = field(default=0.25, metadata=_said("Edge of a cell of heights in m."))
    draft: bool = field(
        default=False, metadata=_said("Without approval, whether or not there is one.")
    )

    @property
    def changed(self) -> tuple[str, ...]:
        """Names of those that are not as by default."""
        return tuple(f.name for f in fields(self) if getattr(self, f.name) != f.default)

    def selection(self, heights_m: tuple[float, float] | None = None) -> PointSelection:
        """Which points are wanted.

        Args:
            heights_m: Of the storey, in the map [m]; None = all.

        Raises:
            ConfigError: If there is no such class, or a box has no extent.
        """
        from recon4.export.selection import EVERY_CLASS, PointSelection

        classes = EVERY_CLASS if self.all_points else frozenset(self.classes)
        if self.all_points and self.classes:
            raise ConfigError(CodedText("export-classes-both"))
        return PointSelection(
            classes=classes,
            box_m=self.box_m,
            clip=self.clip,
            heights_m=heights_m,
            thin_m=self.thin_m,
        )


def option_text(name: str) -> str:
    """What an option of `ExportOptions` is for."""
    return str(next(f.metadata["help"] for f in fields(ExportOptions) if f.name == name))


def classes_named(text: str) -> tuple[int, ...]:
    """Codes of classes by their names or codes, with commas between them: ``ground,building``.

    Raises:
        ConfigError: If there is no such class.
    """
    from recon4.model.classes import CLASSES  # with numpy

    known = {_plain(facts.title): int(code) for code, facts in CLASSES.items()}
    known |= {str(int(code)): int(code) for code in CLASSES}
    codes = []
    for word in filter(None, (_plain(part) for part in text.split(","))):
        if word not in known:
            names = ", ".join(_plain(facts.title) for facts in CLASSES.values())
            raise ConfigError(CodedText("export-classes", names=names, word=visible(word)))
        codes.append(known[word])
    return tuple(dict.fromkeys(codes))


def _plain(title: str) -> str:
    return re.sub(r"[\s_-]+", "-", title.strip().lower())
