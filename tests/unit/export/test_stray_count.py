"""``recon4 export`` says how many points the map leaves out, and whether they are in the file."""

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


def test_points_left_out_are_counted(project, tmp_path, capsys):
    tiles = TileSet.open(read_artifacts(project)["map"])
    assert tiles.strays > 0

    assert main(["export", str(project), str(tmp_path / "map.laz")]) == 0

    printed = capsys.readouterr().out
    assert f"{len(tiles)} points, without {tiles.strays} (noise, moving, carrier)" in printed
    assert len(laspy.read(tmp_path / "map.laz")) == len(tiles)


def test_points_left_out_that_are_in_the_file_are_counted(project, tmp_path, capsys):
    assert main(["export", str(project), str(tmp_path / "map.laz"), "--all-points"]) == 0

    noise = laspy.read(tmp_path / "map.laz").classification >= 7
    assert f"with the {noise.sum()} that the map leaves out" in capsys.readouterr().out


def test_a_map_that_leaves_nothing_out_says_nothing_of_it(tmp_path, capsys):
    build_project(tmp_path / "room", points=300)

    assert main(["export", str(tmp_path / "room"), str(tmp_path / "map.laz")]) == 0

    assert ": 300 points\n" in capsys.readouterr().out
