"""Which maps have a common frame, and what ``recon4 compare`` says and writes of two."""

import json
from dataclasses import replace
from pathlib import Path

import laspy
import numpy as np
import pytest

from recon4.cli.main import main
from recon4.comparison.common_frame import MapSide, earlier_maps, open_side, relate
from recon4.comparison.run import common_frame
from recon4.errors import ConfigError, GeoreferenceError
from recon4.geometry.se3 import SE3
from recon4.locales.languages import ENVIRONMENT
from recon4.slices.map_crs import LOCAL, MapFrame
from recon4.store.project import read_artifacts
from tests.project_builder import ROOM_M, build_project
from tests.unit.slices.room_map import write_map

MOVED_M = 0.05


@pytest.fixture(scope="module")
def office(tmp_path_factory):
    """A project with an earlier map, in which one wall stood elsewhere; and the same elsewhere."""
    root = tmp_path_factory.mktemp("projects") / "office"
    build_project(root, points=150_000, normals=True)
    build_project(root, points=150_000, normals=True, moved_m=MOVED_M)
    return root


def side(folder, name, *, frame=LOCAL, recordings=()):
    p = np.array([[0.0, 0.0, 0.0], [8.0, 3.0, 2.0]])
    tiles = write_map(folder / name, p)
    return MapSide(folder / name, name, "key", tiles, frame, frozenset(recordings))


def grid(T_crs_map, name="EPSG:32633"):
    return MapFrame(name, f"WKT of {name}", lambda p: T_crs_map @ p)


def test_georeferenced_maps_meet_in_their_system(tmp_path):
    T_crs_a = SE3.from_rpy(0.0, 0.0, 0.4, t=[400_000.0, 5_500_000.0, 200.0])
    T_crs_b = SE3.from_rpy(0.0, 0.0, -1.0, t=[400_010.0, 5_500_020.0, 203.0])
    first = side(tmp_path, "a", frame=grid(T_crs_a))
    second = side(tmp_path, "b", frame=grid(T_crs_b))

    found = relate(first, second)

    expected = T_crs_a.inverse() @ T_crs_b
    assert np.allclose(found.T_a_b.matrix(), expected.matrix(), atol=1e-6)
    assert found.text == "both are georeferenced in EPSG:32633"


def test_maps_in_two_systems_or_scales_are_refused(tmp_path):
    T = SE3.identity()
    first = side(tmp_path, "a", frame=grid(T))
    other = side(tmp_path, "b", frame=grid(T, "EPSG:5514"))
    large = side(tmp_path, "c", frame=replace(grid(T), to_crs=lambda p: 1.01 * p))

    with pytest.raises(GeoreferenceError, match="a is in EPSG:32633, b in EPSG:5514"):
        relate(first, other)
    with pytest.raises(GeoreferenceError, match="do not differ by a rigid motion"):
        relate(first, large)


def test_local_maps_meet_only_if_they_are_of_one_recording(tmp_path):
    first = side(tmp_path, "a", recordings=["aa", "bb"])
    same = side(tmp_path, "b", recordings=["bb", "aa"])
    other = side(tmp_path, "c", recordings=["aa"])
    placed = side(tmp_path, "d", frame=grid(SE3.identity()), recordings=["aa", "bb"])

    assert np.array_equal(common_frame(first, same, align=False).T_a_b.matrix(), np.eye(4))
    for unrelated in (other, placed):  # a georeferenced map has another heading
        with pytest.raises(ConfigError, match="have no common frame"):
            common_frame(first, unrelated, align=False)


@pytest.mark.study
def test_an_unrelated_map_is_laid_on_the_other_by_icp(office, tmp_path):
    build_project(tmp_path / "again", points=150_000, normals=True)
    first, second = open_side(office), open_side(tmp_path / "again")
    assert relate(first, second) is None

    found = common_frame(first, second, align=True)

    assert found.text.startswith("aligned by ICP")
    assert np.linalg.norm(found.T_a_b.t) < 0.03


def test_the_map_before_the_last_one_is_compared(office, capsys, tmp_path):
    assert len(earlier_maps(office)) == 1
    out = tmp_path / "figures.json"

    assert main(["compare", str(office), "--out", str(out), "--core-spacing", "0.2"]) == 0

    said, record = capsys.readouterr().out, json.loads(out.read_text())
    assert "both were made of the same recording" in said
    counts = record["counts"]
    assert f"{counts['core_points']} core points" in said
    others = [count for name, count in counts.items() if name != "core_points"]
    assert sum(others) == counts["core_points"] > 1000
    assert record["first"]["key"] == read_artifacts(office)["map"].name
    assert record["second"]["key"] == earlier_maps(office)[0].name
    wall = ROOM_M[1] * ROOM_M[2] / 0.2**2
    assert counts["significant"] == pytest.approx(wall, rel=0.25)
    assert record["distances"]["largest_m"] == pytest.approx(MOVED_M, abs=0.01)


def test_the_comparison_is_said_in_the_language_of_the_terminal(office, capsys, monkeypatch):
    monkeypatch.setenv(ENVIRONMENT, "de")

    assert main(["compare", str(office), "--core-spacing", "0.5"]) == 0

    said = capsys.readouterr().out
    assert "beide sind aus derselben Aufzeichnung gemacht" in said
    assert " mit signifikantem Unterschied (95 %)" in said and "significant" not in said


@pytest.mark.parametrize("ending", [".laz", ".csv"])
def test_core_points_are_written_with_their_distances(office, tmp_path, ending, capsys):
    earlier, out = earlier_maps(office)[0], tmp_path / f"differences{ending}"

    assert main(["compare", str(earlier), str(office), "--out", str(out)]) == 0

    x, distance, lod, state = (read_laz if ending == ".laz" else read_csv)(out)
    assert int(capsys.readouterr().out.split(" core points")[0].split()[-1]) == len(x)
    on_wall = (x > ROOM_M[0] - 0.01) & (state == 1)
    assert on_wall.sum() > 1000
    # The wall moved away from those who saw it.
    assert np.median(distance[on_wall]) == pytest.approx(-MOVED_M, abs=1e-3)
    assert np.all(np.abs(distance[state == 1]) > lod[state == 1])
    assert np.isnan(distance[state > 1]).all()


def read_laz(path: Path):
    las = laspy.read(path)
    return (np.asarray(las[name]) for name in ("x", "distance_m", "lod_m", "state"))


def read_csv(path: Path):
    lines = path.read_text().splitlines()
    assert lines[0].startswith("# recon4 compare, map frame (local)")
    names = lines[1].split(",")
    rows = [dict(zip(names, line.split(","), strict=True)) for line in lines[2:]]
    codes = {"below_lod": 0, "significant": 1}
    yield np.array([float(row["x_m"]) for row in rows])
    yield from (
        np.array([float(row[name] or "nan") for row in rows]) for name in ("distance_m", "lod_m")
    )
    yield np.array([codes.get(row["state"], 2) for row in rows])


def test_what_cannot_be_compared_is_said(office, tmp_path, capsys):
    build_project(tmp_path / "other", points=3000)
    asked = {
        "names an earlier map": ["compare", str(tmp_path / "other")],
        "have no common frame": ["compare", str(office), str(tmp_path / "other")],
        ".laz, .csv, .json": ["compare", str(office), "--out", str(tmp_path / "a.txt")],
    }
    said = []
    for words in asked.values():
        assert main(words) == 1
        said.append(capsys.readouterr().err)

    assert "has no earlier map any more" in said[0]
    assert "have no common frame" in said[1] and "align them first" in said[1]
    assert ".laz, .csv, .json" in said[2]
