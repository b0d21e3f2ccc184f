"""The command ``recon4 evaluate``: survey markers and the density of a patch."""

import json

import pytest

from recon4.cli.main import main
from recon4.recording.formats.poses import write_tum
from tests.project_builder import REMARK, build_project, loop_walk, write_summary

SURVEYED = "name,x_m,y_m,z_m,role\nA,1,2,3,check\nB,4,5,6,control\nC,7,8,9,check\n"
MEASURED = "name,x_m,y_m,z_m\nA,1.03,2.04,3.1\nB,4,5,6\n"


@pytest.fixture
def markers(tmp_path):
    (tmp_path / "surveyed.csv").write_text(SURVEYED)
    (tmp_path / "measured.csv").write_text(MEASURED)
    return ["--markers", str(tmp_path / "surveyed.csv"), str(tmp_path / "measured.csv")]


def test_markers_are_compared_and_missing_ones_named(tmp_path, markers, capsys):
    assert main(["evaluate", str(tmp_path), *markers]) == 0

    text = capsys.readouterr().out
    assert "A (check)" in text and "5.0" in text
    assert "not measured in the map: C" in text
    assert "– No verdict at the check points: horizontal – (1 point, 3 needed)" in text
    assert "mean 14 cm horizontal, 12 cm height" in text


def test_markers_as_json_have_the_verdict(tmp_path, markers, capsys):
    assert main(["evaluate", str(tmp_path), *markers, "--json"]) == 0

    table = json.loads(capsys.readouterr().out)["markers"]
    assert table["passed"] is None
    assert table["missing"] == ["C"]
    assert table["rows"][0]["up_m"] == pytest.approx(0.1)


def test_markers_are_judged_by_the_given_limits_where_they_were_measured(tmp_path, capsys):
    names = "ABCD"
    surveyed, measured = tmp_path / "surveyed.csv", tmp_path / "measured.csv"
    surveyed.write_text(
        "name,x_m,y_m,z_m\n" + "".join(f"{n},{k},{k * k},0\n" for k, n in enumerate(names))
    )
    measured.write_text("name,x_m,y_m,z_m\n" + "".join(f"{n},,-,0.03\n" for n in names))
    ask = ["evaluate", str(tmp_path), "--markers", str(surveyed), str(measured), "--limits"]

    assert main([*ask, "-,2,-,-,-"]) == 0
    strict = capsys.readouterr().out
    assert main([*ask, "-,4,-,5,-", "--json"]) == 0
    loose = json.loads(capsys.readouterr().out)["markers"]

    assert "✕ Outside the limits at the check points: height ✕ (4 points" in strict
    assert loose["passed"] is True and loose["rows"][1]["east_m"] is None
    assert loose["figures"][0]["axes"][0]["rmse_m"] is None
    assert main([*ask, "1,2"]) == 1 and "expected five numbers" in capsys.readouterr().err


def test_the_density_of_a_patch_of_the_map(tmp_path, capsys):
    root = tmp_path / "office"
    build_project(root, points=20_000)
    capsys.readouterr()
    floor = "-8,-5,0,8,-5,0,-8,5,0"

    assert main(["evaluate", str(root), "--patch", floor, "--json"]) == 0

    patch = json.loads(capsys.readouterr().out)["patch"]
    assert patch["area_m2"] == pytest.approx(160.0)
    assert patch["points"] > 0
    assert patch["points_per_cm2"] == pytest.approx(patch["points"] / 160.0 / 1e4)


def test_a_patch_needs_nine_numbers_and_a_map(tmp_path, capsys):
    assert main(["evaluate", str(tmp_path), "--patch", "1,2,3"]) == 1
    assert "expected nine numbers" in capsys.readouterr().err


def test_nothing_to_evaluate_is_wrong_usage(tmp_path, capsys):
    assert main(["evaluate", str(tmp_path)]) == 2
    assert "--truth, --markers or --patch" in capsys.readouterr().err


def test_the_report_is_written_again_with_the_evaluation(tmp_path, capsys):
    root, report = tmp_path / "office", tmp_path / "report.html"
    build_project(root, points=20_000)
    stage = {"seconds": 2.0, "cpu_seconds": 3.0, "peak_bytes": 10**8, "reused": False}
    summary = {
        "name": "office", "created": "2026-01-01T00:00:00Z", "preset": "indoor", "rig": "4RECON",
        "crs": "", "versions": {"recon4": "1"}, "warnings": ["early", "late"],
        "stages": [stage | {"stage": "frames", "figures": {"warnings": ["early"]}}],
    }  # fmt: skip
    write_summary(root, summary)
    for path in (root / "trajectory.tum", tmp_path / "truth.tum"):
        write_tum(path, loop_walk())
    truth = ["--truth", str(tmp_path / "truth.tum")]

    assert main(["evaluate", str(root), *truth, "--report", str(report)]) == 0

    page = report.read_text("utf-8")
    assert "Accuracy against ground truth" in page
    assert REMARK in page and "EARLIER-REMARK" in page
    assert "The absolute trajectory error is 0.0 cm" in page


def test_a_report_needs_a_truth(tmp_path, capsys):
    assert main(["evaluate", str(tmp_path), "--patch", "1", "--report", "r.html"]) == 2


def test_damaged_lines_of_a_trajectory_are_said_beside_its_relations(tmp_path, capsys):
    lines = [f"{k}.0 {k}.0 0 0 0 0 0 1\n" for k in range(40)]
    lines[5] = "5.0 5.0 0\n"
    (tmp_path / "walk.tum").write_text("".join(lines))
    (tmp_path / "true.relations").write_text("0.0 30.0 30.0 0 0 0 0 0\n")
    command = ["evaluate", str(tmp_path / "walk.tum"), "--truth", str(tmp_path / "true.relations")]

    assert main(command) == 0
    assert "Warning: walk.tum: 1 of 40 poses" in capsys.readouterr().out

    assert main([*command, "--json"]) == 0
    assert "walk.tum: 1 " in json.loads(capsys.readouterr().out)["relations"]["hints"][0]
