"""What the report for the client says of check points, and whose notes it shows."""

import json
import shutil
from dataclasses import replace

import pytest

from recon4.delivery.report_files import _notes, checked_approval
from recon4.findings.summary_notes import findings_in
from recon4.findings.wording import said
from recon4.model.finding import Finding, Level
from recon4.model.finding_kinds import FindingKind
from recon4.report.assessment import assess
from recon4.report.client import Signature
from recon4.report.client_front import front_page
from recon4.report.client_words import words
from recon4.report.pdf import _printable
from recon4.report.project import project_facts
from recon4.review.acknowledgments import seen_finding
from recon4.review.decisions import Decision, DecisionKind
from recon4.review.journal import append
from recon4.review.trusted_keys import ensure_own_key
from recon4.store.seal import changing
from tests.made_once import made_once
from tests.project_builder import approve_project, build_project, write_summary

TWO = [
    Finding(kind=FindingKind.FOLDER_DESCRIPTION, level=Level.NOTE, sensor=sensor)
    for sensor in ("left", "right")
]


def _make_server(folder):
    folder.mkdir()
    (folder / ".recon4").mkdir()
    ensure_own_key(folder / ".recon4")
    build_project(folder / "room", points=2_000)


@pytest.fixture
def room(tmp_path_factory, tmp_path):
    made = made_once(tmp_path_factory, "report-facts-server", _make_server)
    shutil.copytree(made, tmp_path / "server")
    return tmp_path / "server" / "room"


def _front(assessed):
    signature = Signature(approved=True, text="")
    return front_page(assessed, None, signature, words=words(), drawing=None)


def _with_points(assessed, *, crs, role):
    point = {
        "id": "P1",
        "role": role,
        "sd_m": [0.01, 0.01],
        "rigid_m": [0.03, 0.04, 0.02],
        "adjusted_m": [0.03, 0.04, 0.02],
    }
    record = {"control": {"crs": crs, "freedom": 6, "scale": 1.0, "points": [point]}}
    results = replace(assessed.results, georeference=assessed.results.georeference | record)
    return replace(assessed, results=results, facts=replace(assessed.facts, crs=crs))


def test_check_points_are_part_of_the_first_page(room):
    assessed = assess(project_facts(room))
    checked = _front(_with_points(assessed, crs="EPSG:25832", role="check"))
    controlled = _front(_with_points(assessed, crs="EPSG:25832", role="control"))
    label, none = words()("accuracy.check_points"), words()("limits.computed")

    (value,) = [row.value for row in checked.accuracy if row.label == label]
    assert value == "5.0 cm horizontal, 2.0 cm in height (number of points: 1)"
    assert none not in checked.limits
    assert none in controlled.limits
    assert all(row.label != label for row in controlled.accuracy)


def test_the_grid_of_a_site_is_no_projection(room):
    assessed = assess(project_facts(room))
    front = _front(_with_points(assessed, crs="site grid", role="control"))

    assert words()("limits.site_grid") in front.limits
    assert not any("projection" in text for text in front.limits)


def _say(room, findings):
    with changing(room, "summary.json", compared=False):
        summary = json.loads((room / "summary.json").read_text("utf-8"))
        write_summary(room, summary | {"findings": [said(one) for one in findings]})


def _acknowledge(room, place, why):
    found = findings_in(json.loads((room / "summary.json").read_text("utf-8")))
    finding = seen_finding(found[place])
    append(room, Decision(kind=DecisionKind.ACKNOWLEDGE, who="Eva", why=why, finding=finding))


def test_a_note_stands_at_the_finding_that_it_is_about(room):
    _say(room, TWO)
    _acknowledge(room, 1, "seen on site")
    assessed = replace(assess(project_facts(room)), findings=TWO)

    notes = _notes(room, None, assessed)

    assert list(notes) == [1] and notes[1][0].endswith(": seen on site")


def test_an_approved_report_has_the_notes_that_were_signed(room):
    _say(room, TWO)
    _acknowledge(room, 0, "before")
    approve_project(room, room.parent / ".recon4" / "signing.key")
    _acknowledge(room, 0, "after")
    assessed = replace(assess(project_facts(room)), findings=TWO)
    _, approval = checked_approval(room, draft=False)

    def texts(of):
        return [text.rpartition(": ")[2] for text in _notes(room, of, assessed)[0]]

    assert texts(approval) == ["before"]
    assert texts(None) == ["after"]


def test_characters_without_a_shape_in_the_font_are_shown_as_numbers():
    assert _printable({"title": "Žižkov – 中"}) == {"title": "Žižkov – <U+4E2D>"}
