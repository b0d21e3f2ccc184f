"""Texts of a report that follow from records of its run, in English and in another language."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

from recon4.findings.derived import derived_text
from recon4.findings.in_language import summary_in
from recon4.locales.languages import ENGLISH
from recon4.model.import_counts import count_label
from recon4.model.import_notes import derived_in, import_notes
from recon4.report.tuning import PROJECT_FACTS
from recon4.store.json_files import read_object
from recon4.store.project import read_artifacts
from recon4.untrusted.limits import LIMITS

_IMPORTS = ("frames", "scans_2d")
"""Stages whose ``report.json`` says what was read."""


def known_texts(root: Path, language: str) -> dict[str, str]:
    """What the latest run of a project says in English -> the same in a language.

    Args:
        root: The project folder, with ``summary.json``.
        language: Its code.

    Raises:
        StoreError: If a file is damaged.
    """
    if language == ENGLISH:
        return {}
    summary = read_object(root / "summary.json", max_bytes=PROJECT_FACTS.max_bytes)
    pairs = dict(_findings(summary, language))
    artifacts = read_artifacts(root)
    for stage in _IMPORTS:
        path = artifacts.get(stage, root) / "report.json"
        if path.is_file():
            pairs |= _imported(read_object(path, max_bytes=LIMITS.findings_bytes), language)
    return pairs


def _findings(summary: Mapping[str, object], language: str) -> Iterator[tuple[str, str]]:
    again = summary_in(language, summary)
    for before, after in zip(_listed(summary), _listed(again), strict=True):
        for parts in (("title",), ("text",), ("text", "remedy")):
            yield _joined(before, parts), _joined(after, parts)


def _listed(summary: Mapping[str, object]) -> list[Mapping[str, object]]:
    findings = summary.get("findings")
    return [one for one in findings if isinstance(one, dict)] if isinstance(findings, list) else []


def _joined(finding: Mapping[str, object], parts: tuple[str, ...]) -> str:
    return " ".join(str(finding[part]) for part in parts if finding.get(part))


def _imported(report: Mapping[str, object], language: str) -> dict[str, str]:
    derived = derived_in(report)
    pairs = {derived_text(one): derived_text(one, language) for one in derived}
    return pairs | {
        count_label(name): count_label(name, language) for name in import_notes(report).counts
    }
