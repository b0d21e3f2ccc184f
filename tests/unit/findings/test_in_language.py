"""Findings of a finished map are said again in the language of the person who reads them."""

from recon4.errors import CorruptFile
from recon4.findings.derived import derived_text
from recon4.findings.in_language import summary_in
from recon4.findings.wording import said, text_of, whole_text
from recon4.model.derived_kinds import DerivedKind
from recon4.model.finding import Finding, Level
from recon4.model.finding_kinds import FindingKind
from recon4.recording.report import ImportReport

KEPT = Finding(kind=FindingKind.TRACKING_KEPT, level=Level.GOOD, values={"multiframes": 600})
LOST = Finding(kind=FindingKind.MIRROR, level=Level.CHECK, values={"area_m2": 2.5})
UNKNOWN = {"kind": "OF-TOMORROW", "level": "note", "title": "Later", "text": "x", "values": {}}


def summary():
    reasons = [whole_text(LOST), "a reason of an earlier version"]
    findings = [said(LOST) | {"values": {"area_m2": 2.5, "unknown": None}}, said(KEPT), UNKNOWN]
    return {
        "points": 5,
        "verdict": {"usability": "check", "reasons": reasons},
        "findings": findings,
    }


def test_findings_and_reasons_are_said_again_and_what_is_unknown_stays():
    german = summary_in("de", summary())

    first, second, third = german["findings"]
    assert first["title"] == "Spiegel" and first["text"] == said(LOST, "de")["text"]
    assert "600 Multiframes" in second["text"]
    assert third == UNKNOWN
    assert german["verdict"]["reasons"] == [
        whole_text(LOST, "de"),
        "a reason of an earlier version",
    ]
    assert german["points"] == 5


def test_english_and_summaries_without_findings_stay():
    assert summary_in("en", summary()) == summary()
    assert summary_in("de", {"warnings": ["x"]}) == {"warnings": ["x"]}


def test_the_error_that_a_reader_quotes_has_the_code_of_its_kind():
    report = ImportReport()
    report.warn(FindingKind.FILE_LEFT_OUT, error=CorruptFile("a.pcd: cut"))
    report.derive(DerivedKind.DESCRIPTION_UNREAD, topic="/robot", error=CorruptFile("no tree"))
    (left_out,), (unread,) = report.findings, report.derived

    assert left_out.values == {"error": "a.pcd: cut", "error_code": "kind-corrupt-file"}
    assert text_of(left_out) == "Left out: a.pcd: cut."
    assert "Ausgelassen: Eine Datei ist beschädigt" in text_of(left_out, "de")
    assert "(Meldung auf Englisch): no tree." in derived_text(unread, "de")
