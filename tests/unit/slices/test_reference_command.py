"""``recon4 slice --reference`` and ``recon4 evaluate --model``: columns and units are asked for."""

import numpy as np
import pytest
import trimesh
from PIL import Image

from recon4.cli.main import main
from tests.project_builder import build_project


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    root = tmp_path_factory.mktemp("office") / "office"
    build_project(root, points=20_000)
    return root


def wall(template, size=1.0):
    places = [(0.03, y / 10, z / 5) for y in range(100) for z in range(15)]
    rows = [np.array(place) / size for place in places]
    return "\n".join(template.format(k=k, x=x, y=y, z=z) for k, (x, y, z) in enumerate(rows))


def cut(project, reference, *options):
    out = reference.with_suffix(".png")
    ask = ["slice", str(project), str(out), "--z", "1.5", "--reference", str(reference)]
    return main([*ask, *options]), out


def test_a_reference_is_drawn_and_how_it_was_read_is_said(project, tmp_path, capsys):
    path = tmp_path / "a.csv"
    path.write_text("Punkt;Hochwert;Rechtswert;Höhe\n" + wall("{k};{y};{x};{z}"))

    code, out = cut(project, path)

    assert code == 0
    with Image.open(out) as image:
        assert image.width > 100
    assert "a.csv: columns: x (east) = Rechtswert" in capsys.readouterr().err


def test_columns_that_are_not_certain_are_asked_for_and_given(project, tmp_path, capsys):
    path = tmp_path / "a.csv"
    path.write_text(wall("{k};{x};{y};{z}"))

    asked = cut(project, path)[0]
    question = capsys.readouterr().err
    given = cut(project, path, "--columns", "id,x,y,z")[0]

    assert (asked, given) == (1, 0)
    assert "first one is like a point number" in question and "--columns id,x,y,z" in question


@pytest.mark.study
def test_a_reference_in_millimeters_is_asked_for_its_unit(project, tmp_path, capsys):
    path = tmp_path / "a.xyz"
    path.write_text(wall("{x} {y} {z}", 0.001) + "\n9000 0 0\n")

    asked = cut(project, path)[0]
    question = capsys.readouterr().err
    given = cut(project, path, "--unit", "mm")[0]

    assert (asked, given) == (1, 0) and "--unit mm" in question


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--unit", "furlong"], "--unit: expected one of m, dm"),
        (["--columns", "a,b,c"], "columns: expected x, y, z"),
        (["--frame", "moon"], "--frame: expected auto, map or crs"),
        (["--frame", "crs"], "the map is local"),
    ],
)
def test_options_without_meaning_are_refused(project, tmp_path, capsys, options, words):
    path = tmp_path / "a.xyz"
    path.write_text(wall("{x} {y} {z}"))

    assert cut(project, path, *options)[0] == 1
    assert words in capsys.readouterr().err


def test_a_model_in_millimeters_is_asked_for_its_unit(project, tmp_path, capsys):
    box = trimesh.creation.box((16000.0, 10000.0, 3000.0))
    box.export(tmp_path / "model.ply")
    truth = project / "trajectory.tum"
    ask = ["evaluate", str(project), "--truth", str(truth), "--model", str(tmp_path / "model.ply")]

    assert main(ask) == 1
    assert "--unit mm" in capsys.readouterr().err
