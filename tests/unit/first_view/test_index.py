"""The order, extent and storeys of what the page *Map* draws."""

import hashlib
import json
import re
import tracemalloc
from dataclasses import replace

import numpy as np
import pytest
from pydantic import TypeAdapter

from recon4.errors import StoreError
from recon4.first_view import index, points
from recon4.first_view.cubes import CubeFile
from recon4.first_view.files import read_index, write_first_files
from recon4.first_view.index import _extent, _values, storeys, usual_color
from recon4.first_view.points import _shown_order, encoded, read_shown
from recon4.first_view.records import MapColumn, MapIndex
from recon4.first_view.surfaces import surfaces_m2
from recon4.first_view.tuning import FIRST_VIEW, MAP_CHUNKS
from recon4.mapping.tiles import TileSet
from recon4.slices.map_crs import LOCAL
from recon4.store.project import read_artifacts
from recon4.untrusted.typed import decoded
from tests.project_builder import build_project

BOX = np.random.default_rng(3).uniform(0.0, (20.0, 10.0, 3.0), (50_000, 3))

CELLS_M2 = np.array([4.0, 2.0, 0.01])


@pytest.fixture(scope="module")
def tiles(tmp_path_factory):
    root = tmp_path_factory.mktemp("project")
    build_project(root, points=60_000, normals=True)
    return TileSet.open(read_artifacts(root)["map"])


@pytest.mark.parametrize("count", [10, 63, 400])
def test_any_first_rows_are_spread_evenly(count):
    order = _shown_order(938)

    first = np.sort(order[:count])

    assert sorted(order.tolist()) == list(range(938))
    assert np.diff(np.concatenate([[0], first, [938]])).max() <= 2 * 1024 / count + 1


def test_points_of_the_first_stratum_are_read_in_that_order(tiles):
    tile = tiles.tiles[0]
    stratum = len(tile) // 64

    mine = read_shown(tile, ["xyz"], slice(5, stratum + 9))["xyz"]

    every = tile.read(["xyz"])["xyz"]
    assert (mine[: stratum - 5] == every[_shown_order(stratum)[5:]]).all()
    assert (mine[stratum - 5 :] == every[stratum : stratum + 9]).all()


def test_stray_points_do_not_decide_the_extent():
    strays = np.tile([500.0, -300.0, 80.0], (100, 1))

    low, high = _extent(np.vstack([BOX, strays]))

    assert (low > -1.0).all() and (high < (21.0, 11.0, 4.0)).all()


def test_points_that_are_far_apart_have_a_large_surface():
    rng = np.random.default_rng(8)
    sparse = np.column_stack([rng.uniform(0, 20, (500, 2)), np.zeros(500)])
    dense = np.column_stack([rng.uniform(0, 1, (500, 2)), np.zeros(500)])

    found = surfaces_m2(np.vstack([sparse, dense, sparse[:3]]), np.array([500, 500, 3]), CELLS_M2)

    assert found[:2] == pytest.approx([400.0, 2.0], rel=0.15)  # of the dense one that of its cells
    assert found[2] == pytest.approx(CELLS_M2[2] * np.median(found[:2] / CELLS_M2[:2]), rel=0.5)


def test_each_storey_has_its_floor_and_stairs_are_none():
    rng = np.random.default_rng(5)
    floors = [np.column_stack([rng.uniform(0, 9, (4000, 2)), np.full(4000, z)]) for z in (0.0, 3.2)]
    ceiling = np.column_stack([rng.uniform(0, 9, (4000, 2)), np.full(4000, 6.0)])
    up = np.tile([0.0, 0.0, 1.0], (8000, 1))
    normal = np.vstack([up, -up[:4000]])
    heights = np.concatenate([np.full(300, 1.3), np.linspace(1.3, 4.5, 40), np.full(300, 4.5)])
    walk = np.column_stack([np.zeros((len(heights), 2)), heights])

    found = storeys(np.vstack([*floors, ceiling]), normal, walk)

    assert [one.floor_m for one in found] == pytest.approx([0.0, 3.2], abs=0.06)
    assert [one.ceiling for one in found] == [False, True]
    assert [one.name for one in found] == ["0", "1"]  # as in plans and exports
    down = storeys(np.vstack([*floors, ceiling]), normal, walk[::-1])
    assert [one.name for one in down] == ["-1", "0"]


def test_what_was_walked_is_not_hidden_as_above_a_ceiling():
    rng = np.random.default_rng(5)
    place = rng.uniform(0, 9, (8000, 2))
    rooms = np.column_stack([place, np.repeat([0.0, 2.6], 4000)])
    normal = np.repeat([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]], 4000, axis=0)
    heights = np.concatenate([np.full(600, 1.3), np.linspace(1.3, 4.5, 5), np.full(5, 4.5)])
    walk = np.column_stack([np.zeros((610, 2)), heights])

    (below,) = storeys(rooms, normal, walk[:600])
    (attic,) = storeys(rooms, normal, walk)

    assert below.ceiling and not attic.ceiling


def test_a_slope_has_no_storeys():
    walk = np.column_stack([np.zeros((900, 2)), np.linspace(1.3, 13.3, 900)])
    slope = np.column_stack([np.zeros((900, 2)), np.linspace(0.0, 12.0, 900)])

    assert storeys(slope, np.tile([0.0, 0.0, 1.0], (900, 1)), walk) == []
    assert storeys(slope, None, np.empty((0, 3))) == []


def test_what_has_no_value_is_said(tiles, monkeypatch):
    monkeypatch.setattr(points, "read_shown", lambda *_: {"surface_sd_m": np.array([0.01, np.nan])})

    steps = np.frombuffer(encoded(tiles, 0, "thickness", rows=slice(0, 2)), "<u2")

    assert steps.tolist() == [100, 65_535]


def test_a_large_map_is_known_by_some_of_its_tiles(tiles, monkeypatch):
    many = replace(tiles, tiles=tiles.tiles * 400, points=len(tiles) * 400)
    reads = []
    monkeypatch.setattr(
        index, "read_shown", lambda tile, *rest: reads.append(tile) or read_shown(tile, *rest)
    )

    few, all_of_it = _values(tiles, ["intensity"]), _values(many, ["intensity"])

    assert len(reads) == len(tiles.tiles) + FIRST_VIEW.most_tiles
    for name in ("xyz", "intensity"):
        usual = [np.percentile(found[name], (10, 50, 90), axis=0) for found in (few, all_of_it)]
        assert usual[1] == pytest.approx(usual[0], rel=0.1, abs=0.3)


def test_values_that_are_the_same_everywhere_are_not_shown_at_first():
    def column(name, low, high):
        return MapColumn(name=name, unit="", offset=0.0, scale=0.0625, low=low, high=high)

    intensity = column("intensity", 3.0, 90.0)
    assert usual_color([intensity, column("normalized", 1.0, 40.0)]) == "normalized"
    assert usual_color([intensity, column("normalized", 0.0, 0.0625)]) == "intensity"
    assert usual_color([column("intensity", 0.0, 0.0625)]) == "height"


def test_a_map_without_points_has_an_index_and_no_points(tiles, tmp_path):
    notes = replace(tiles.notes, classes={1: 0})
    none = replace(tiles, tiles=(), points=0, first_ns=0, last_ns=0, notes=notes)

    write_first_files(tmp_path / "first", none, LOCAL, walk_m=np.zeros((1, 3)))

    found = decoded(read_index(tmp_path / "first/index.json", "key"), MapIndex)
    assert (found.key, found.points, found.tiles) == ("key", 0, [])
    assert CubeFile(tmp_path / "first/xyz.bin", "xyz").sample() == b""


@pytest.mark.parametrize("head", [b"", b"\x01\x00", b"\xff\xff\xff\xff" + bytes(64)])
def test_a_damaged_head_of_coarse_points_takes_no_memory(head, tmp_path):
    (tmp_path / "xyz.bin").write_bytes(head)
    tracemalloc.start()

    with pytest.raises(StoreError, match=r"xyz\.bin ends early"):
        CubeFile(tmp_path / "xyz.bin", "xyz").sample()

    most_bytes = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert most_bytes < 1 << 26  # texts of errors are loaded, too


def test_a_changed_layout_of_the_index_has_another_version():
    """Else an index that an earlier version kept would be read as one of this."""
    layout = json.dumps(TypeAdapter(MapIndex).json_schema(), sort_keys=True)
    text = re.sub(r'"(description|title)": "[^"]*",? ?', "", layout)

    assert (MAP_CHUNKS.version, hashlib.sha256(text.encode()).hexdigest()[:12]) == (
        6,
        "df730ce651c7",
    )
