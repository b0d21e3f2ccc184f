"""The report of a finished run for the client: as PDF, signed if the map is approved, or HTML."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from recon4.delivery.pdf_signature import Organization, sign_pdf
from recon4.errors import StoreError
from recon4.locales.coded import CodedText
from recon4.locales.languages import ENGLISH
from recon4.progress import Progress, Silent
from recon4.report.assessment import Assessment, assess
from recon4.report.client import ClientReport, Row, Section, Signature, Table
from recon4.report.client_front import shown
from recon4.report.client_html import client_html
from recon4.report.client_report import ReportExtras, client_report
from recon4.report.client_words import Words, words
from recon4.report.known_texts import known_texts
from recon4.report.pdf import pdf_of, require_pdf
from recon4.report.project import project_facts
from recon4.report.translation import in_language
from recon4.report.tuning import CLIENT_REPORT
from recon4.review.acknowledgments import (
    acknowledgments,
    report_with_notes,
    seen_finding,
    seen_findings,
)
from recon4.review.annotations import pinned_notes, saved_measurements
from recon4.review.approval_state import ApprovalState, latest_state
from recon4.review.approved import Approval, approval_of
from recon4.review.decisions import DecisionKind
from recon4.review.journal import JournalRow, read_rows
from recon4.review.state import read_summary
from recon4.review.trusted_keys import SIGNING_KEY, trusted_for
from recon4.store.atomic import atomic_file, write_text
from recon4.store.project import read_artifacts
from recon4.store.seal import check_sealed

SUMMARY, HTML = "summary.json", "report.html"


@dataclass(frozen=True, slots=True, kw_only=True)
class ReportWish:
    """How the report is written."""

    language: str = ENGLISH
    draft: bool = False
    """Without an approval, whether or not there is one; never signed."""
    key: Path | Organization | None = None
    """What signs the PDF of an approved map; None = nothing."""
    files: Sequence[Row] = ()
    """Delivered files with their SHA-256, for the list at its end."""


@dataclass(frozen=True, slots=True)
class WrittenReport:
    """What was written."""

    approval: ApprovalState
    signed: bool


def server_key(project: Path) -> Path | None:
    """The key of the server in whose folder a project lies; None if there is none to be read."""
    trusted = trusted_for(project)
    path = trusted.folder / SIGNING_KEY
    return path if trusted.server and os.access(path, os.R_OK) else None


def write_pdf(root: Path, path: Path, wish: ReportWish) -> WrittenReport:
    """Write the report of the latest run of a project as PDF.

    Args:
        root: The project folder.
        path: File to write, replaced only when the new one is complete.
        wish: Language, key, delivered files.

    Raises:
        Altered: If the map was approved and is not what was approved.
        ConfigError: If the extra ``pdf`` is not installed, or the language is not known.
        StoreError: If there is no finished run, or a file is damaged.
    """
    require_pdf()
    state, approval = checked_approval(root, draft=wish.draft)
    made = pdf_of(report_of(root, approval, state, wish=wish))
    signed = approval is not None and wish.key is not None
    if approval is not None and wish.key is not None:
        made = sign_pdf(made, wish.key, reason=state.text)
    with atomic_file(path) as temporary:
        temporary.write_bytes(made)
    return WrittenReport(state, signed)


def write_client_html(root: Path, path: Path, wish: ReportWish) -> WrittenReport:
    """Write the report of the latest run of a project as HTML for the client; it is not signed.

    Args:
        root: The project folder.
        path: File to write, replaced only when the new one is complete.
        wish: Language, delivered files.

    Raises:
        Altered: If the map was approved and is not what was approved.
        ConfigError: If the language is not known.
        StoreError: If there is no finished run, or a file is damaged.
    """
    state, approval = checked_approval(root, draft=wish.draft)
    made = client_html(report_of(root, approval, state, wish=replace(wish, key=None)))
    write_text(path, made)
    return WrittenReport(state, signed=False)


def write_html(root: Path, path: Path, wish: ReportWish) -> WrittenReport:
    """Write the report with all figures, as the run made it, with its approval and notes.

    Args:
        root: The project folder.
        path: File to write, replaced only when the new one is complete.
        wish: Language.

    Raises:
        Altered: If the map was approved and is not what was approved.
        StoreError: If there is no report, or a file is damaged.
    """
    state, _ = checked_approval(root, draft=wish.draft)
    source = root / HTML
    if not source.is_file():
        raise StoreError(CodedText("report-no-run", root=str(root)))
    with atomic_file(path) as temporary, temporary.open("wb") as file:
        file.writelines(said_report(root, report_with_notes(root, source), wish.language))
    return WrittenReport(state, signed=False)


def said_report(root: Path, page: Iterable[bytes], language: str) -> Iterable[bytes]:
    """The report of the latest run in a language; the file has it in English.

    Args:
        root: The project folder.
        page: The report, in parts.
        language: Its code.

    Raises:
        StoreError: If a file with what it quotes is damaged.
    """
    if language == ENGLISH:
        return page
    text = b"".join(page).decode("utf-8", errors="replace")
    return (in_language(text, language, known_texts(root, language)).encode("utf-8"),)


def checked_approval(
    root: Path, *, draft: bool, progress: Progress | None = None
) -> tuple[ApprovalState, Approval | None]:
    """The approval of the latest results, whose bytes are compared with it.

    Args:
        root: The project folder.
        draft: Without an approval, whether or not there is one.
        progress: Counts the bytes that are compared.

    Raises:
        Altered: If it is not what was approved, or the approval is not to be trusted.
        StoreError: If a file cannot be read.
    """
    artifacts = read_artifacts(root)
    keys = {stage: folder.name for stage, folder in artifacts.items()}
    approval = None if draft else approval_of(root, keys)
    if approval is None:
        check_sealed(root, SUMMARY)
        return latest_state(root, draft=draft), None
    approval.check_issued()
    for name in (SUMMARY, HTML):
        if name in approval.issued:
            approval.check_issued_file(root / name)
    watch = progress or Silent()
    checked = [approval.evidence.artifact(*one) for one in artifacts.items()]
    sizes = (file.size for one in checked for file in one.files.values())
    watch.start("approvals", sum(sizes), "B")
    for one in checked:
        one.check_all(watch.advance)
    return latest_state(root), approval


def report_of(
    root: Path, approval: Approval | None, state: ApprovalState, *, wish: ReportWish
) -> ClientReport:
    """The record that the PDF lays out.

    Raises:
        StoreError: If the map is none of a 3-D walk, or a file is damaged.
    """
    if not (read_artifacts(root).get("map", root) / "tiles.json").is_file():
        raise StoreError(CodedText("report-2d", root=root.name))
    assessed = assess(project_facts(root))
    extras = ReportExtras(
        signature=_signature(approval, state, words(wish.language), wish=wish),
        notes=_notes(root, approval, assessed),
        files=wish.files,
        people=people_section(root, words(wish.language)),
    )
    return client_report(assessed, extras, language=wish.language)


def _signature(
    approval: Approval | None, state: ApprovalState, texts: Words, *, wish: ReportWish
) -> Signature:
    if approval is None:
        text = said_state(state, texts)
        row = Row(texts("signature.state"), text)
        return Signature(approved=False, text=text, rows=(row,))
    stamp = approval.stamp
    signed = "pdf_signed" if wish.key is not None else "pdf_unsigned"
    who = texts("signature.who_value", who=state.who, role=stamp.role)
    pairs = {
        "who": who,
        "time": f"{stamp.time[:16].replace('T', ' ')} UTC",
        "version": str(stamp.version),
        "verdict": texts.term(stamp.verdict),
        "why": state.why,
        "hash": " ".join(stamp.hash[k : k + 16] for k in range(0, len(stamp.hash), 16)),
        "pdf": texts(f"signature.{signed}"),
    }
    rows = tuple(Row(texts(f"signature.{key}"), text) for key, text in pairs.items() if text)
    return Signature(approved=True, text=said_state(state, texts), rows=rows)


def said_state(state: ApprovalState, texts: Words) -> str:
    """The line of an approval in the words of a language."""
    return state.line.said(texts.language)


def _notes(
    root: Path, approval: Approval | None, assessed: Assessment
) -> Mapping[int, Sequence[str]]:
    """Notes of reviewers by finding; of an approved map those up to its approval."""
    summary = read_summary(root) or {}
    said = seen_findings(summary)
    notes = acknowledgments(_rows_before(approval, read_rows(root)), summary)
    about = [(said[one.finding], one) for one in notes if one.finding is not None]
    out: dict[int, list[str]] = {}
    for place, finding in enumerate(assessed.findings):
        seen = seen_finding(finding)
        texts = [f"{one.who}, {one.time[:10]}: {one.why}" for other, one in about if other == seen]
        if texts:
            out[place] = texts
    return out


def _rows_before(approval: Approval | None, rows: Sequence[JournalRow]) -> Sequence[JournalRow]:
    """The rows that an approval was signed over; all of them without one."""
    for place, row in enumerate(rows):
        facts = row.decision().facts if row.kind == DecisionKind.APPROVE else None
        if approval is not None and facts is not None and facts.approval == approval.hash:
            return rows[:place]
    return rows


def people_section(root: Path, words: Words) -> Section:
    """Notes and measurements of a project, each with who made it and when.

    Raises:
        Altered: If a file was changed by another program.
        StoreError: If one is damaged.
    """
    most = CLIENT_REPORT.most_notes
    notes, measured = pinned_notes(root), saved_measurements(root)
    of_notes: list[tuple[str, ...]] = [
        (
            shown(one.text),
            words.term(one.status),
            _place(one.p_map, words),
            shown(one.who),
            one.time[:10],
        )
        for one in notes[:most]
    ]
    of_measurements: list[tuple[str, ...]] = [
        (
            shown(one.name or one.view.name),
            words.term(shown(one.kind)),
            words.decimal(one.text),
            _place(one.points[0], words),
            shown(one.view.who),
            one.view.time[:10],
        )
        for one in measured[:most]
    ]
    left = max(0, len(notes) - most) + max(0, len(measured) - most)
    names = (("note", "status"), ("name", "kind", "value"))
    tables = tuple(
        Table(
            head=tuple(words(f"people.{name}") for name in (*own, "place", "who", "date")),
            rows=tuple(rows),
            texts=tuple(range(1, len(own) + 3)),
            title=words(f"people.{title}"),
        )
        for title, own, rows in zip(
            ("notes", "measurements"), names, (of_notes, of_measurements), strict=True
        )
        if rows
    )
    more = (words("people.more", count=str(left)),) if left else ()
    return Section(title=words("section.people"), text=(words("text.people"), *more), tables=tables)


def _place(p_map: Sequence[float], words: Words) -> str:
    return ", ".join(words.number(value) for value in p_map)
