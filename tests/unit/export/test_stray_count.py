"""``recon4 export`` says how many stray returns are in the file, or left out of it."""

import laspy
import pytest

from recon4.cli.main import main
from recon4.mapping.tiles import TileSet
from recon4.store.project import read_artifacts
from tests.project_builder import build_project


@pytest.fixture
def project(tmp_path):
    build_project(tmp_path / "room", points=300, strays=3)
    return tmp_path / "room"


def test_stray_returns_left_out_are_counted(project, tmp_path, capsys):
    tiles = TileSet.open(read_artifacts(project)["map"])
    assert tiles.strays > 0

    assert main(["export", str(project), str(tmp_path / "map.laz")]) == 0

    printed = capsys.readouterr().out
    assert f"{len(tiles)} points, {tiles.strays} stray returns left out, in" in printed
    assert len(laspy.read(tmp_path / "map.laz")) == len(tiles)


def test_stray_returns_in_the_file_are_counted(project, tmp_path, capsys):
    assert main(["export", str(project), str(tmp_path / "map.laz"), "--strays"]) == 0

    noise = laspy.read(tmp_path / "map.laz").classification >= 7
    assert f"{noise.sum()} stray returns of them marked as noise" in capsys.readouterr().out


def test_a_map_without_stray_returns_says_nothing_of_them(tmp_path, capsys):
    build_project(tmp_path / "room", points=300)

    assert main(["export", str(tmp_path / "room"), str(tmp_path / "map.laz")]) == 0

    assert "stray returns" not in capsys.readouterr().out
