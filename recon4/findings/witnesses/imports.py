"""What the readers of the recording had to repair or leave out."""

from __future__ import annotations

from collections.abc import Iterator

from recon4.findings.finding import Finding, Level
from recon4.findings.kinds import FindingKind
from recon4.findings.walk import WalkRecord
from recon4.findings.witnesses.base import finding
from recon4.model.import_notes import import_notes
from recon4.model.unused import unused_parts


class Import:
    """Outcome, warnings and losses of the import."""

    def check(self, walk: WalkRecord) -> Iterator[Finding]:
        """What the reader warned of, and data that is not used."""
        notes = import_notes(walk.imported)
        if notes.outcome != "complete":
            yield finding(FindingKind.IMPORT_INCOMPLETE, Level.CHECK, {"outcome": notes.outcome})
        for text in notes.warnings:
            yield finding(FindingKind.IMPORT_REMARK, Level.CHECK, {"text": text})
        for part in unused_parts(notes.counts):
            if part.is_severe or part.is_scattered:
                level = Level.DO_NOT_USE if part.is_severe else Level.CHECK
                yield finding(FindingKind.IMPORT_UNUSED, level, {"text": part.text})


class Earlier:
    """Sentences of stages that were made before findings were records."""

    def check(self, walk: WalkRecord) -> Iterator[Finding]:
        """Each of them."""
        for text, severe in walk.earlier_warnings:
            level = Level.DO_NOT_USE if severe else Level.CHECK
            yield finding(FindingKind.EARLIER_REMARK, level, {"text": text})
