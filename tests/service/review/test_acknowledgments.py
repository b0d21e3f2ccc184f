"""Acknowledged findings over HTTP: journal, report, approval; outdated when the map differs."""

import json

import pytest

from recon4.review.journal import broken, read_rows
from recon4.store.seal import changing
from tests.service.review.reviewing import RIGHT, decide

NOTE = "seen on site: <b>glass</b> doors"


def findings_of(root):
    return json.loads((root / "summary.json").read_text())["findings"]


def acknowledge(server, root, at=0, why=NOTE, **other):
    seen = findings_of(root)[at]
    asked = {"finding": at, "kind": seen["kind"], "span_s": seen.get("span_s"), "why": why}
    return server.post("/acknowledgments", json=asked | other)


def change_findings(root, change):
    """Give the map other findings, as another run would."""
    with changing(root, "summary.json", compared=False):
        path = root / "summary.json"
        record = json.loads(path.read_text())
        record["findings"] = change(record["findings"])
        path.unlink()
        path.write_text(json.dumps(record))


def test_a_note_is_in_the_chain_of_the_journal_and_changes_neither_verdict_nor_decisions(
    server, root
):
    before = server.get().json()
    answer = acknowledge(server, root)

    assert answer.status_code == 201, answer.text
    (note,) = answer.json()["notes"]
    assert (note["who"], note["why"], note["finding"]) == ("local", NOTE, 0)
    assert server.get("/acknowledgments").json() == answer.json()
    after = server.get().json()
    assert after["seq"] == before["seq"] + 1
    kept = ("key", "in_map", "undoable", "map", "standing")
    assert [after[name] for name in kept] == [before[name] for name in kept]
    rows = read_rows(root)
    assert (rows[-1].kind, broken(rows)) == ("acknowledge", [])


def test_undo_takes_the_decision_back_and_not_the_note(server, root):
    decide(server, "reject", RIGHT)
    acknowledge(server, root)
    assert server.post("/undo", json={}).json()["standing"] == []

    assert len(server.get("/acknowledgments").json()["notes"]) == 1


def test_the_last_note_of_a_person_about_a_finding_stands(server, root):
    acknowledge(server, root, why="first")
    (note,) = acknowledge(server, root, why="second").json()["notes"]

    assert note["why"] == "second"


def test_the_approval_and_its_report_carry_the_notes(server, root):
    acknowledge(server, root)
    answer = server.post("/approve", json={"why": "checked against the plan"})
    assert answer.status_code == 201, answer.text

    statement = json.loads((root / "versions/1/approval.json").read_text())["statement"]
    assert statement["format"] == 4
    (signed,) = statement["acknowledgments"]
    assert (signed["who"], signed["why"]) == ("local", NOTE)
    assert signed["kind"] == findings_of(root)[0]["kind"]
    report = (root / "report.html").read_text()
    assert "seen on site: &lt;b&gt;glass&lt;/b&gt; doors" in report
    assert "acknowledged by local" in report
    assert server.get().json()["approval"]["kind"] == "approved"


def test_the_report_of_a_draft_carries_the_notes_as_they_stand(server, root):
    before = (root / "report.html").read_bytes()
    acknowledge(server, root, why="an earlier note")
    acknowledge(server, root)

    shown = server.report()

    assert (
        "seen on site: &lt;b&gt;glass&lt;/b&gt; doors" in shown and "an earlier note" not in shown
    )
    assert shown.index("acknowledged by local") < shown.index("<dl")  # in the block on top
    assert (root / "report.html").read_bytes() == before  # which an approval compares
    assert shown.endswith(before[-1000:].decode())


def test_the_report_of_an_approved_map_has_the_signed_notes_only(server, root):
    acknowledge(server, root, why="signed")
    assert server.post("/approve", json={"why": "checked against the plan"}).status_code == 201
    acknowledge(server, root, why="written later")

    shown = server.report()

    assert "signed" in shown and "written later" not in shown


@pytest.mark.parametrize(
    "change",
    [
        lambda findings: findings[1:],
        lambda findings: [findings[0] | {"span_s": [1.0, 2.0]}, *findings[1:]],
        lambda findings: [findings[0] | {"values": {"other": 1}}, *findings[1:]],
        lambda findings: [findings[0] | {"level": "do not use"}, *findings[1:]],
    ],
    ids=["gone", "elsewhere", "other figures", "worse"],
)
def test_a_note_about_a_finding_that_is_gone_or_differs_is_outdated(server, root, change):
    acknowledge(server, root)
    change_findings(root, change)

    (note,) = server.get("/acknowledgments").json()["notes"]
    assert note["finding"] is None
    assert note["why"] == NOTE


def test_a_note_stays_when_only_the_wording_or_the_order_of_findings_changes(server, root):
    acknowledge(server, root)
    change_findings(root, lambda found: [*found[1:], found[0] | {"text": "Said in other words."}])

    (note,) = server.get("/acknowledgments").json()["notes"]
    assert note["finding"] == len(findings_of(root)) - 1


@pytest.mark.parametrize(
    ("other", "status"),
    [
        ({"finding": 9999}, 409),
        ({"kind": "GNSS-CLOCK"}, 409),
        ({"span_s": [3.0, 4.0]}, 409),
        ({"why": ""}, 422),
        ({"why": "   "}, 422),
        ({"why": "x" * 501}, 422),
        ({"finding": -1}, 422),
    ],
)
def test_a_note_about_nothing_or_without_words_is_refused(server, root, other, status):
    answer = acknowledge(server, root, **other)

    assert answer.status_code == status, answer.text
    assert server.get("/acknowledgments").json()["notes"] == []
