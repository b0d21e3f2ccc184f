"""Artifacts of versions whose readers wrote sentences still say them."""

import json
from pathlib import Path

import pytest

from recon4.errors import StoreError
from recon4.findings.walk_record import WalkRecord
from recon4.findings.witnesses.imports import Import
from recon4.findings.wording import text_of
from recon4.model.finding import Finding, Level
from recon4.model.finding_kinds import MOUNT_DOUBTS, FindingKind
from recon4.model.import_notes import import_notes

FROZEN = Path(__file__).with_name("report_with_sentences.json")
"""``report.json`` as the version of 2026-11-26 wrote it."""
CLOCK = "the clock of the GNSS is ahead of the LiDAR's by +18.000 s (GPS time against UTC)"
TILTED = "the laser is tilted by 80°: distances in the map are up to 475.9% too long"


def test_sentences_of_an_earlier_import_are_findings_that_quote_them():
    found = list(Import().check(WalkRecord(imported=json.loads(FROZEN.read_text()))))

    assert [(one.kind, one.level) for one in found] == [(FindingKind.IMPORT_REMARK, Level.CHECK)]
    assert text_of(found[0]).startswith(CLOCK)


def test_sentences_about_a_mount_stay_doubts_about_it():
    report = {"warnings": [TILTED, CLOCK], "counts": {"scans": 3}}

    notes = import_notes(report, mount_doubts=(TILTED,))

    doubts = [text_of(one) for one in notes.findings if one.kind in MOUNT_DOUBTS]
    others = [text_of(one) for one in notes.findings if one.kind not in MOUNT_DOUBTS]
    assert (doubts, others) == ([TILTED], [CLOCK])
    assert notes.counts == {"scans": 3}


def test_a_finding_that_an_earlier_version_stored_as_a_sentence_still_says_it():
    stored = {"text": "512 of 603 scans are not used."}

    found = Finding(kind=FindingKind.IMPORT_UNUSED, level=Level.CHECK, values=stored)

    assert text_of(found) == stored["text"]


@pytest.mark.parametrize("damaged", [{"warnings": [1]}, {"findings": [{"kind": "NO-SUCH"}]}])
def test_a_damaged_report_of_an_import_is_refused(damaged):
    with pytest.raises(StoreError, match=r"report\.json"):
        import_notes(damaged)
