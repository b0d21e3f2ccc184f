"""Findings that a reviewer acknowledged with a note; the verdict on the map does not change.

An acknowledgment is about a finding as the reviewer saw it. If the map is made again and has no
such finding, because it is gone or its stretch, level or figures differ, it is outdated.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from html import escape
from pathlib import Path

from recon4.findings.summary_notes import SaidFinding, findings_in
from recon4.model.finding import Finding
from recon4.report.approval import add_to_block, is_draft
from recon4.review.decisions import (
    DecisionKind,
)
from recon4.review.journal import JournalRow, read_rows
from recon4.review.row_contents import SeenFinding
from recon4.review.state import read_summary
from recon4.review.tuning import ACKNOWLEDGMENTS


@dataclass(frozen=True, slots=True, kw_only=True)
class Acknowledgment:
    """A note of a reviewer about a finding."""

    who: str
    time: str
    """UTC, ISO 8601."""
    why: str
    """The note."""
    kind: str
    """Code of the finding."""
    span_s: tuple[float, float] | None
    """Its stretch of the walk [s]; null = the whole walk."""
    finding: int | None
    """Its place in the list of findings of the map; null = outdated, the map has no such one."""


def seen_finding(finding: SaidFinding | Finding) -> SeenFinding:
    """What an acknowledgment is about: the finding without its wording, and without its place,
    which moves with the map.
    """
    return SeenFinding(
        kind=str(finding.kind),
        level=str(finding.level),
        span_s=finding.span_s,
        direction=finding.direction,
        sensor=finding.sensor,
        values=dict(finding.values),
    )


def seen_findings(summary: Mapping[str, object]) -> list[SeenFinding]:
    """The findings in ``summary.json``, as acknowledgments are about them.

    Raises:
        StoreError: If they cannot be read.
    """
    return [seen_finding(one) for one in findings_in(summary) or []]


def acknowledgments(
    rows: Sequence[JournalRow], summary: Mapping[str, object]
) -> list[Acknowledgment]:
    """All acknowledgments of a project, oldest first; of one person about one finding the last.

    Args:
        rows: The journal.
        summary: ``summary.json`` of the map.

    Raises:
        StoreError: If either is damaged.
    """
    findings = seen_findings(summary)
    last: list[tuple[SeenFinding, Acknowledgment]] = []
    for row in rows:
        if row.kind != DecisionKind.ACKNOWLEDGE:
            continue
        seen = row.decision().finding
        assert seen is not None
        last = [(other, one) for other, one in last if (other, one.who) != (seen, row.who)]
        note = Acknowledgment(
            who=row.who,
            time=row.time,
            why=row.why,
            kind=seen.kind,
            span_s=seen.span_s,
            finding=findings.index(seen) if seen in findings else None,
        )
        last.append((seen, note))
    return [one for _, one in last]


def signed_acknowledgments(
    rows: Sequence[JournalRow], summary: Mapping[str, object]
) -> list[dict[str, object]]:
    """Those about findings of the map, as an approval signs them."""
    current = [one for one in acknowledgments(rows, summary) if one.finding is not None]
    return [
        {name: value for name, value in asdict(one).items() if name != "finding"}
        for one in current
    ]  # fmt: skip


def write_into_report(report: Path, signed: Sequence[Mapping[str, object]]) -> None:
    """Add the acknowledgments to the approval in a report."""
    if signed and report.is_file():
        page = add_to_block(report.read_text("utf-8"), map(_line, signed))
        report.write_text(page, "utf-8")


def report_with_notes(root: Path, report: Path) -> Iterator[bytes]:
    """The bytes of a report; a draft with the notes of reviewers as they stand now.

    The file keeps the bytes of the run, which an approval compares; the approved report has the
    notes that were signed.

    Args:
        root: Project.
        report: Its ``report.html``.

    Raises:
        StoreError: If the journal or the summary is damaged.
    """
    with report.open("rb") as file:
        page = file.read(ACKNOWLEDGMENTS.head_bytes).decode("utf-8", errors="surrogateescape")
    if is_draft(page):
        notes = signed_acknowledgments(read_rows(root), read_summary(root) or {})
        page = add_to_block(page, map(_line, notes))
    return _with_rest(page.encode("utf-8", errors="surrogateescape"), report)


def _with_rest(head: bytes, report: Path) -> Iterator[bytes]:
    yield head
    with report.open("rb") as file:
        file.seek(ACKNOWLEDGMENTS.head_bytes)
        while part := file.read(ACKNOWLEDGMENTS.head_bytes):
            yield part


def _line(one: Mapping[str, object]) -> str:
    span = one["span_s"]
    stretch = f", {span[0]:.1f} s to {span[1]:.1f} s" if isinstance(span, (tuple, list)) else ""
    day = str(one["time"])[:16].replace("T", " ")
    return (
        f"{escape(str(one['kind']))}{stretch}, acknowledged by {escape(str(one['who']))} on {day} "
        f"UTC: “{escape(str(one['why']))}”."
    )
