"""All texts of a report, of a map or a calibration, are shown in the language that is asked for."""

import json
import re
from dataclasses import replace
from html import unescape

import numpy as np
import pytest

from recon4.cli.main import main
from recon4.evaluation.evaluate import evaluate
from recon4.findings.derived import derived_text
from recon4.findings.wording import text_of, title_of, whole_text
from recon4.locales.coded import CodedText
from recon4.model.calibration_figures import CalibrationFigures, ParameterFigures
from recon4.model.import_notes import derived_in
from recon4.model.pose_graph import Judge, Reason, Verdict
from recon4.model.rig import RigCalibration
from recon4.model.rig_origin import RigOrigin
from recon4.model.tried_hypotheses import Because, TrialVerdict
from recon4.pipeline import process
from recon4.recording.sources import Sources
from recon4.report.approval import approved_block, replace_block
from recon4.report.assessment import assess
from recon4.report.calibration_page import CalibrationPage, CloudSlice, write_calibration_page
from recon4.report.edges import _reason_text
from recon4.report.html import render
from recon4.report.stretches import _PATHS
from recon4.report.translation import in_language
from recon4.report.tried_hypotheses import COLUMNS
from tests.planar_walks import along, furnished_room, scanned, write_carmen
from tests.unit.report.test_report import DERIVED, EVIL, made_facts

SAME = {
    EVIL, "Drift", "joint", "earlier ring", "GNSS", "IMU", "Import", "Rig", "RMSE", "SHA-256",
    "min:s", "cm", "max", "min", "median", "pcap", "2σ [cm]", "laser", "frames", "front, OS1",
}  # fmt: skip
"""Names, units and words that are those of both languages."""
CODE = re.compile(r"[A-Z0-9-]{4,}|[\w.]+\.(log|npz|png|pcap)|[\d.+−± -]*(cm|mm|m|s|Hz|MB)?")
ENGLISH = re.compile(r"\b(the|of|and|is|are|was|not|to|from|with|by|for|no|each|which)\b")


def texts(page):
    """Pairs of a text and whether it is to be translated."""
    page = re.sub(r"<style.*?</style>|<metadata>.*?</metadata>|<!--.*?-->", "", page, flags=re.S)
    found = re.findall(r"<([^<>]*)>([^<>]+)", page)
    return [(" ".join(unescape(text).split()), 'translate="no"' not in tag) for tag, text in found]


def left_english(page, german):
    """Texts of a page that its translation has, too, and those with English words."""
    pairs = zip(texts(page), texts(german), strict=True)
    shown = [(one, said) for (one, is_text), (said, _) in pairs if is_text]
    same = {one for one, said in shown if one == said and not CODE.fullmatch(one)}
    return {one for one in same if re.search("[A-Za-z]{3}", one)} - SAME | {
        said for _, said in shown if ENGLISH.search(said)
    }


@pytest.fixture(scope="module")
def room(tmp_path_factory):
    folder = tmp_path_factory.mktemp("room")
    corners = np.array([[-3.0, 0.0], [0.0, -1.0], [3.0, -2.0], [3.0, 1.0]])
    write_carmen(folder / "walk.log", scanned(furnished_room(), along(corners)).scans)
    process(Sources((folder / "walk.log",)), folder / "out")
    return folder / "out"


def test_the_report_of_a_map_has_no_english_text(tmp_path):
    facts = made_facts(tmp_path)
    note = RigCalibration(date="2026-05-01", method="joint", sd_deg=0.1, sd_mm=2.0, sd_ms=0.1)
    origin = RigOrigin(name="CAL", sensors=(), calibration=note, age_days=31, max_age_days=365)
    facts = replace(facts, title="walk", rig="CAL", rig_origin=origin)
    walk, truth = (tmp_path / name / "trajectory.npz" for name in ("level", "odometry"))
    assessed = assess(replace(facts, evaluation=evaluate(walk, truth=truth)))
    page = render(assessed)
    known = {
        say(one): say(one, "de") for say in (text_of, whole_text) for one in assessed.findings
    } | {title_of(one.kind): title_of(one.kind, "de") for one in assessed.findings}

    derived = derived_in({"derived": DERIVED})
    known |= {derived_text(one): derived_text(one, "de") for one in derived}

    german = in_language(page, "de", known)

    assert left_english(page, german) == set()
    assert '<html lang="de">' in german and "Zeit ab dem Start [s]</text>" in german
    assert in_language(page, "en", known) == page
    assert re.sub(r">[^<]+<", "><", german).count("<") == page.count("<"), "only texts differ"


def test_the_report_of_a_plan_is_written_in_the_language_of_the_terminal(room, capsys):
    page = (room / "report.html").read_text("utf-8")

    assert main(["--language", "de", "report", str(room), "--html", str(room / "de.html")]) == 0

    german = (room / "de.html").read_text("utf-8")
    assert not left_english(page, german)
    length = json.loads((room / "summary.json").read_text())["path_length_m"]
    assert f"{length:.1f}".replace(".", ",") + " <small>m</small>" in german
    capsys.readouterr()


def test_the_page_of_a_calibration_is_german(tmp_path):
    rows = [
        ParameterFigures(
            sensor="front", quantity=quantity, axis=axis, unit=unit, change=0.01, sd=0.001,
            status="off",
        )
        for quantity, axis, unit in (
            ("rotation", "x", "rad"), ("clock", "", "s"), ("beam range", "3", "m"),
        )
    ]  # fmt: skip
    points = (("front", np.zeros((9, 2))), ("back", np.ones((9, 2))))
    page = CalibrationPage(
        title="rig",
        method="maps",
        outcome=CodedText("calibrated-by-maps"),
        figures=CalibrationFigures(parameters=tuple(rows[:2]), beams=(rows[2],)),
        report_lines=(
            CodedText(
                "calibrated-windows", sensor="front", windows=3, scatter_rad=0.1, scatter_mm=2.0
            ),
        ),
        slices=(CloudSlice("rig file", points), CloudSlice("calibrated", points)),
    )
    for language in ("en", "de"):
        write_calibration_page(tmp_path / f"{language}.html", page, language)

    english, german = ((tmp_path / f"{one}.html").read_text("utf-8") for one in ("en", "de"))

    found = left_english(english, german)
    assert found <= {"front", "back", "front 3", "3"}
    assert "weicht ab" in german and "+0,573 ± 0,057 °" in german


@pytest.mark.parametrize(
    "text",
    [
        *map(str, [*Because, *TrialVerdict, *Judge, *Verdict]), *COLUMNS,
        *(_reason_text(one, 0.1) for one in Reason if one), *(text for _, text in _PATHS.values()),
    ],
)  # fmt: skip
def test_each_word_of_the_tables_has_a_translation(text):
    if text not in {"IMU", "GNSS"}:
        assert in_language(f"<td>{text}</td>", "de", {}) != f"<td>{text}</td>"


def test_an_approval_and_its_notes_are_german_and_names_stay():
    stamp = {"version": 2, "who": "Ann not", "role": "Chief", "time": "2026-05-01T10:00:00Z",
             "hash": "ab", "verdict": "check", "why": "seen"}  # fmt: skip
    page = replace_block("", approved_block(stamp))

    german = in_language(page, "de", {})

    assert "Version 2, freigegeben von Ann not (Chief) am 2026-05-01 10:00 UTC." in german
    assert "Urteil über die Karte bei der Freigabe: prüfen. Begründung: „seen“." in german
    assert "unterschrieben in versions/2/approval.json" in german
