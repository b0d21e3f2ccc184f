"""The report for the client as one record: what its templates lay out, in words and numbers.

It has no markup: every text is shown as it is. Drawings are SVG that recon4 draws.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Row:
    """A name and its value, with unit."""

    label: str
    value: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Table:
    """Cells in rows; the first column is text, the others are numbers unless ``texts`` says so."""

    head: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    texts: tuple[int, ...] = ()
    """Further columns of text, by index."""
    title: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Drawing:
    """A drawing with its caption."""

    svg: str
    caption: str
    wide: bool = True
    """Whether it takes the whole width; else two stand beside each other."""
    aspect: float = 2.0
    """Its width over its height."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FindingBox:
    """A finding with its place, and who acknowledged it."""

    code: str
    level: str
    """`recon4.model.finding.Level`."""
    label: str
    """It in words."""
    title: str
    text: str
    where: str = ""
    acknowledged: tuple[str, ...] = ()
    drawing: Drawing | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Section:
    """A part of the report; parts that are empty are left out."""

    title: str
    text: tuple[str, ...] = ()
    """Paragraphs."""
    rows: tuple[Row, ...] = ()
    tables: tuple[Table, ...] = ()
    drawings: tuple[Drawing, ...] = ()
    findings: tuple[FindingBox, ...] = ()
    hashes: tuple[Row, ...] = ()
    """Names of files and their SHA-256."""

    @property
    def empty(self) -> bool:
        """Whether there is nothing to show."""
        return not (self.rows or self.tables or self.drawings or self.findings or self.hashes)


@dataclass(frozen=True, slots=True, kw_only=True)
class Signature:
    """Whether the map is approved, and by whom."""

    approved: bool
    text: str
    """One line."""
    rows: tuple[Row, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class FrontPage:
    """What a client reads first."""

    verdict: str
    level: str
    """``good``, ``warning`` or ``bad``."""
    reasons: tuple[str, ...]
    what: tuple[Row, ...]
    where: tuple[Row, ...]
    when: tuple[Row, ...]
    accuracy: tuple[Row, ...]
    limits: tuple[str, ...]
    signature: Signature
    drawing: Drawing | None


@dataclass(frozen=True, slots=True, kw_only=True)
class ClientReport:
    """The whole report."""

    title: str
    subtitle: str
    created: str
    """Time of the run, ISO 8601 UTC."""
    foot: str
    """On every page."""
    language: str
    front: FrontPage
    sections: tuple[Section, ...]
    words: dict[str, str]
    """Headings of the layout, by key."""
