"""Makes the report for the client of an assessed run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from recon4.mapping.tiles import TileSet
from recon4.report.assessment import Assessment
from recon4.report.client import ClientReport, Row, Section, Signature
from recon4.report.client_drawings import MapDrawings
from recon4.report.client_front import front_page, shown
from recon4.report.client_sections import sections
from recon4.report.client_words import Words, words
from recon4.report.tuning import CLIENT_REPORT


@dataclass(frozen=True, slots=True, kw_only=True)
class ReportExtras:
    """What the artifacts of a run do not say."""

    signature: Signature
    notes: Mapping[int, Sequence[str]] = field(default_factory=dict)
    """Place of a finding, worst first -> notes of reviewers about it."""
    files: Sequence[Row] = ()
    """Delivered files with their SHA-256."""
    people: Section | None = None
    """Notes and measurements of people; None = there are none."""


def client_report(
    assessed: Assessment, extras: ReportExtras, *, language: str = "en"
) -> ClientReport:
    """The report for the client.

    Args:
        assessed: The run as read and judged.
        extras: Approval, notes of reviewers, delivered files.
        language: Of its texts.

    Raises:
        ConfigError: If there is no catalog of this language.
        StoreError: If an artifact is damaged.
    """
    texts = words(language)
    facts = assessed.facts
    tiles = TileSet.open(facts.artifacts["map"]) if "map" in facts.artifacts else None
    walk = assessed.results.final or assessed.results.odometry
    drawings = MapDrawings.of(texts, tiles, walk)
    front = front_page(assessed, tiles, extras.signature, words=texts, drawing=drawings.front())
    made = sections(assessed, drawings, extras.notes, words=texts)
    if extras.people is not None and not extras.people.empty:
        made.append(extras.people)
    if extras.files:
        made.append(_files(extras.files, texts))
    title = shown(facts.title)
    return ClientReport(
        title=title,
        subtitle=texts("front.subtitle"),
        created=facts.created,
        foot=f"{title} · {extras.signature.text}",
        language=texts.language,
        front=front,
        sections=tuple(made),
        words=texts.all("layout"),
    )


def _files(files: Sequence[Row], texts: Words) -> Section:
    return Section(
        title=texts("section.files"),
        text=(texts("text.files"),),
        hashes=tuple(files[: CLIENT_REPORT.most_files]),
    )
