"""The command ``recon4 evaluate``: survey markers and the density of a patch."""

import json

import pytest

from recon4.cli.main import main
from tests.project_builder import build_project

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
    assert "not measured: C" in text
    assert "by check points: mean H 5.0 cm, mean V 10.0 cm" in text


def test_markers_as_json_have_the_verdict(tmp_path, markers, capsys):
    assert main(["evaluate", str(tmp_path), *markers, "--json"]) == 0

    table = json.loads(capsys.readouterr().out)["markers"]
    assert table["within_limits"] is True
    assert table["missing"] == ["C"]
    assert table["rows"][0]["dz_m"] == pytest.approx(0.1)


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
