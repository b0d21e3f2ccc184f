"""What the report for the client says of check points, and whose notes it shows."""

import json
import shutil
from collections import Counter
from dataclasses import replace
from io import BytesIO

import numpy as np
import pytest
from pypdf import PdfReader

from recon4.delivery.report_files import _notes, checked_approval, people_section
from recon4.findings.summary_notes import findings_in
from recon4.findings.wording import said
from recon4.mapping.tiles import TileSet
from recon4.model.finding import Finding, Level
from recon4.model.finding_kinds import FindingKind
from recon4.model.height_system import height_system
from recon4.model.pose_graph import EdgeKind, Verdict
from recon4.model.site_control import SITE_GRID
from recon4.report.assessment import assess
from recon4.report.client import Signature
from recon4.report.client_front import front_page
from recon4.report.client_report import ReportExtras, client_report
from recon4.report.client_sections import _verdicts, weakest_loops
from recon4.report.client_words import words
from recon4.report.pdf import _printable, pdf_of
from recon4.report.project import project_facts
from recon4.review.acknowledgments import seen_finding
from recon4.review.annotations import measured_text
from recon4.review.decisions import Decision, DecisionKind
from recon4.review.journal import append
from recon4.review.trusted_keys import ensure_own_key
from recon4.store.checked import Altered
from recon4.store.project import read_artifacts
from recon4.store.seal import changing
from recon4_app.annotations.model import NewMapView, NewNote
from recon4_app.annotations.store import add_note, add_view
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


POINTS = {
    "P1": ("control", [0.03, -0.04, 0.02], {"redundancy": [0.7, 0.6, 0.5], "w": 1.2, "limit": 3.3,
           "single_handed": False, "least_found_h_m": 0.031, "least_found_v_m": 0.042}),
    "P2": ("control", [0.0, 0.0, 0.001], {"redundancy": [0.0, 0.0, 0.0], "w": 0.0, "limit": 3.3,
           "single_handed": True}),
    "C1": ("check", [0.006, 0.008, None], None),
}  # fmt: skip
"""Name, role, residual [m], test."""


def _georeferenced(room, crs):
    rows = [
        {"id": name, "role": role, "sd_m": [0.01, 0.01], "rigid_m": off, "adjusted_m": off}
        | ({"test": test} if test else {})
        for name, (role, off, test) in POINTS.items()
    ]
    control = {"crs": crs, "freedom": 5, "scale": 1.0001, "scale_sd": 2e-5, "points": rows,
               "blunders": ["P9 is 1 m off"]}  # fmt: skip
    assessed = assess(project_facts(room))
    record = assessed.results.georeference | {"control": control}
    results = replace(assessed.results, georeference=record)
    return replace(assessed, results=results, facts=replace(assessed.facts, crs=crs))


@pytest.mark.parametrize(
    ("crs", "controlled", "heights"),
    [
        ("", False, "local"),
        (SITE_GRID, True, "site"),
        ("EPSG:25832", True, "survey"),
        ("EPSG:25832", False, "ellipsoid"),
        ("EPSG:25832+7837", True, "crs"),
        ("EPSG:5555", False, "crs"),
    ],
)
def test_what_heights_are_above_follows_from_the_system_and_its_points(crs, controlled, heights):
    assert height_system(crs, controlled=controlled) == heights


def test_heights_of_a_horizontal_system_are_those_of_the_survey(room):
    front = _front(_with_points(assess(project_facts(room)), crs="EPSG:25832", role="control"))
    (value,) = [row.value for row in front.where if row.label == words()("front.heights")]
    assert value.startswith("those of the control points: EPSG:25832 is horizontal only")


def _titles(*names):
    return {words()(f"section.{name}") for name in names}


def _noted(room):
    """Notes and a saved view as the server writes them."""
    note = NewNote(p_map=(1.0, 2.0, 0.5), text="crack in the wall", key="a" * 16)
    query = "camera=0,0,0,1,2,3,0&m=distance;0,0,0;3,4,1;hall%20width&m=rubbish;1,2&m=angle;1,0,0"
    add_note(room, note, "Eva")
    add_view(room, NewMapView(name="hall", query=query), "Adam")


def test_a_second_reader_finds_points_notes_and_measurements_in_the_pdf(room):
    _noted(room)
    extras = ReportExtras(
        signature=Signature(approved=False, text="draft"), people=people_section(room, words())
    )
    report = client_report(_georeferenced(room, "site grid"), extras)
    own = [one for one in report.sections if one.title in _titles("control", "people")]
    pages = PdfReader(BytesIO(pdf_of(replace(report, sections=tuple(own))))).pages
    text = " ".join(" ".join(page.extract_text() for page in pages).split())

    assert "P1 control 3.0 -4.0 2.0 5.0 5.4 3.1 4.2" in text
    assert "P2 control 0.0 0.0 0.1 0.0 0.1 – – no other point controls it" in text
    assert "C1 check 0.6 0.8 – 1.0 – – –" in text
    assert "control 2 3.5" in text  # RMSE H of 5 cm and 0
    assert "+100 ± 20 ppm" in text
    assert "Suspected blunder P9 is 1 m off" in text
    assert "grid of the site, defined by these control points alone" in text
    assert "EPSG:" not in text
    assert "crack in the wall open 1.00, 2.00, 0.50 Eva" in text
    assert "hall width distance 5.099 m, horizontal 5.000 m, vertical +1.000 m" in text
    assert text.count("Adam") == 1  # the others are no measurements


def test_notes_that_another_program_changed_are_refused(room):
    _noted(room)
    notes = room / "annotations" / "notes.json"
    notes.write_text(notes.read_text("utf-8").replace("Eva", "Eve"), "utf-8")
    with pytest.raises(Altered, match=r"notes\.json"):
        people_section(room, words())


@pytest.mark.parametrize(
    ("kind", "points", "said"),
    [
        ("angle", [[1, 0, 0], [0, 0, 0], [0, 2, 0]], "90.00°"),
        ("area", [[0, 0, 0], [2, 0, 0], [2, 3, 0], [0, 3, 0]], "6.000 m², from above 6.000 m²"),
        ("area", [[0, 0, 0], [2, 0, 0], [2, 0, 3]], "3.000 m², from above 0.000 m²"),
        ("point", [[1, 2, 3]], "1.000 2.000 3.000"),
    ],
)
def test_a_measurement_says_what_the_page_says(kind, points, said):
    assert measured_text(kind, np.array(points, float)) == said


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


def _tables(room, section):
    extras = ReportExtras(signature=Signature(approved=True, text=""))
    report = client_report(assess(project_facts(room)), extras)
    (found,) = [one for one in report.sections if one.title == words()(f"section.{section}")]
    return found.tables


def test_classes_are_those_of_the_points_that_the_first_page_counts(tmp_path):
    build_project(tmp_path / "room", points=1_000, strays=7)
    tiles = TileSet.open(read_artifacts(tmp_path / "room")["map"])

    (table,) = _tables(tmp_path / "room", "classes")

    counts = {answer: 0 for answer in ("yes", "no")}
    for _, points, _, answer in table.rows:
        counts[answer] += int(points.replace("\u202f", ""))
    assert counts == {"yes": len(tiles), "no": tiles.strays}


def test_only_two_visits_of_a_place_are_counted_as_loop_closures(room):
    graph = assess(project_facts(room)).results.graph
    near = next(k for k, one in enumerate(graph.edges) if one.kind is EdgeKind.LOOP)
    edges = [one.evolve(kind=EdgeKind.NEIGHBOR) if k == near else one
             for k, one in enumerate(graph.edges)]  # fmt: skip
    graph = replace(graph, edges=edges)
    kinds = Counter(one.kind for one in edges if one.verdict is Verdict.ACCEPTED)

    accepted = next(row for row in _verdicts(graph, words()).rows if row[0] == "accepted")

    counted = (EdgeKind.LOOP, EdgeKind.NEIGHBOR, EdgeKind.ODOMETRY)
    assert accepted[1:] == tuple(str(kinds[kind]) for kind in counted)
    assert edges[near] not in weakest_loops(graph)
