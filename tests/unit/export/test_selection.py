"""Parts of a map: classes, box, heights, one point a cube; and files that read back wrong."""

import laspy
import numpy as np
import pytest
from msgspec import structs

from recon4.errors import ConfigError, StoreError
from recon4.export import account, laz
from recon4.export.laz import export_laz, export_map_laz
from recon4.export.map_files import cloud_writer
from recon4.export.options import ExportOptions, classes_named
from recon4.export.points import OutputCrs, PointSource
from recon4.export.selection import EVERY_CLASS, PointSelection
from recon4.mapping.tiles import TileSet
from recon4.store.project import read_artifacts
from tests.project_builder import build_project

SHIFT_M = np.array([500_000.0, 5_400_000.0, 300.0])
IN_A_GRID = OutputCrs("EPSG:32633", lambda xyz: xyz + SHIFT_M)


@pytest.fixture(scope="module")
def tiles(tmp_path_factory):
    folder = tmp_path_factory.mktemp("part") / "room"
    build_project(folder, points=4_000, strays=5)
    return TileSet.open(read_artifacts(folder)["map"])


def points(tiles, selection, output=IN_A_GRID):
    blocks = list(PointSource.of(tiles, output, selection).blocks([], None))
    return np.concatenate([one.xyz for one in blocks]), np.concatenate(
        [one.columns["classification"] for one in blocks]
    )


def test_a_box_is_in_the_coordinates_of_the_file_and_counted_before(tiles):
    every, _ = points(tiles, PointSelection())
    low, high = np.percentile(every, [20, 60], axis=0)
    box = PointSelection(box_m=(*low.tolist(), *high.tolist()))

    found, _ = points(tiles, box)

    inside = ((every >= low) & (every <= high)).all(axis=1)
    np.testing.assert_array_equal(found, every[inside])
    source = PointSource.of(tiles, IN_A_GRID, box)
    assert source.count == inside.sum() < len(every)
    middle = (found.min(axis=0) + found.max(axis=0)) / 2.0
    np.testing.assert_array_equal(source.offset, np.round(middle))


def test_a_part_of_the_heights_is_in_the_map(tiles):
    z = points(tiles, PointSelection())[0][:, 2] - 300.0
    low, high = np.percentile(z, [30, 70])

    found = points(tiles, PointSelection(heights_m=(low, high)))[0][:, 2] - 300.0

    assert len(found) == ((z >= low) & (z < high)).sum()


def test_classes_that_the_map_leaves_out_are_written_if_they_are_named(tiles):
    noise = points(tiles, PointSelection(classes=frozenset({7, 18})))[1]
    every = points(tiles, PointSelection(classes=EVERY_CLASS))[1]

    assert set(noise) <= {7, 18} and len(noise) == tiles.strays > 0
    assert len(every) == len(tiles) + tiles.strays


def test_a_thinned_map_has_one_point_of_each_cube(tiles):
    edge_m = 0.4
    every, _ = points(tiles, PointSelection(), OutputCrs())
    found, _ = points(tiles, PointSelection(thin_m=edge_m), OutputCrs())

    def cubes(xyz):
        """Cubes begin at the corner of each tile."""
        corner = np.floor(xyz / tiles.tile_m) * tiles.tile_m
        return set(map(tuple, np.round(corner + np.floor((xyz - corner) / edge_m) * edge_m, 3)))

    assert len(found) == len(cubes(found)) == len(cubes(every)) < len(every) / 2
    assert set(map(tuple, found)) <= set(map(tuple, every))


@pytest.mark.parametrize(
    ("selection", "says"),
    [
        ({"box_m": (0.0, 0.0, 0.0, 1.0, 1.0, 1.0)}, "no point of the map"),
        ({"box_m": (1.0, 0.0, 0.0, 0.0, 1.0, 1.0)}, "expected the smallest"),
        ({"box_m": (0.0, 0.0, 0.0, np.inf, 1.0, 1.0)}, "six finite numbers"),
        ({"classes": frozenset({9})}, "got \\[9\\]"),
        ({"thin_m": -1.0}, "0 to 100 m"),
        ({"thin_m": 1e-9}, "at least 0.0001 m"),
    ],
)
def test_what_cannot_be_chosen_is_said(tiles, selection, says):
    with pytest.raises(ConfigError, match=says):
        PointSource.of(tiles, IN_A_GRID, PointSelection(**selection))


def test_classes_are_named_as_the_docs_name_them():
    assert classes_named("ground, Low vegetation,6,high_noise") == (2, 3, 6, 18)
    with pytest.raises(ConfigError, match="got 'wals'"):
        classes_named("wals")
    with pytest.raises(ConfigError, match="not both"):
        ExportOptions(all_points=True, classes=(2,)).selection()


@pytest.mark.parametrize("name", ["map.laz", "map.copc.laz", "map.ply", "map.pcd", "map.xyz"])
def test_a_file_of_which_a_byte_changes_before_it_is_read_again_is_refused(tiles, tmp_path, name):
    def damage(path):
        data = bytearray(path.read_bytes())
        data[len(data) // 2] ^= 0x05
        path.write_bytes(data)

    output = OutputCrs("EPSG:32633", lambda xyz: xyz + SHIFT_M, damage)
    with pytest.raises(StoreError, match="reads back wrong"):
        cloud_writer(tmp_path / name)(tiles, tmp_path / name, output)
    assert list(tmp_path.iterdir()) == []


def test_any_byte_of_the_file_beside_the_tiles_that_changes_is_noticed(
    tiles, tmp_path, monkeypatch
):
    check, out = laz._check_bytes, tmp_path / "map.laz"
    assert export_map_laz(tiles, out, IN_A_GRID) == len(tiles)
    length = out.stat().st_size
    export_laz(tiles, tmp_path / "whole.laz", IN_A_GRID)
    assert out.read_bytes() == (tmp_path / "whole.laz").read_bytes()
    for at in (0, 100, length // 3, length - 1, length):
        monkeypatch.setattr(laz, "_check_bytes", damaging(check, at))
        with pytest.raises(StoreError, match="reads back wrong"):
            export_map_laz(tiles, tmp_path / "other.laz", IN_A_GRID)
    assert not (tmp_path / "other.laz").exists()


def damaging(check, at):
    """Change a byte of a file before it is checked, or add one behind its last."""

    def changed(path, *arguments):
        data = bytearray(path.read_bytes())
        data[at : at + 1] = bytes([data[at] ^ 1 if at < len(data) else 0])
        path.write_bytes(data)
        check(path, *arguments)

    return changed


@pytest.mark.parametrize("batch", [0, 2, -1])
def test_of_the_file_beside_the_tiles_the_first_points_of_each_batch_are_expanded(
    tiles, tmp_path, monkeypatch, batch
):
    check = laz._check

    def other_points_were_meant(path, meant, *arguments, **named):
        assert len(meant.sums) == 4
        meant.sums[batch] ^= 1
        check(path, meant, *arguments, **named)

    monkeypatch.setattr(laz, "_check", other_points_were_meant)
    monkeypatch.setattr(laz, "LAZ", structs.replace(laz.LAZ, together=-(-len(tiles) // 4)))
    small = structs.replace(laz.POINT_EXPORT, summed=100)
    monkeypatch.setattr(laz, "POINT_EXPORT", small)
    monkeypatch.setattr(account, "POINT_EXPORT", small)
    with pytest.raises(StoreError, match="reads back wrong: points from number"):
        export_map_laz(tiles, tmp_path / "map.laz", IN_A_GRID)


def test_coordinates_are_kept_to_a_tenth_of_a_millimeter_far_from_zero(tiles, tmp_path):
    every, _ = points(tiles, PointSelection())
    for name in ("map.laz", "map.copc.laz"):
        cloud_writer(tmp_path / name)(tiles, tmp_path / name, IN_A_GRID)
        with laspy.open(tmp_path / name) as file:
            found = file.read()
        off_m = np.abs(np.sort(every, axis=0) - np.sort(found.xyz, axis=0))
        assert off_m.max() <= 0.000_051


def test_a_turned_clip_is_in_the_map_whatever_the_coordinates_of_the_file(tiles):
    every = points(tiles, PointSelection())[0] - SHIFT_M
    middle, turn = np.median(every, axis=0), np.radians(30.0)
    box = (*middle.tolist(), 2.0, 1.0, 1.5, 30.0)
    strip = (*middle.tolist(), 0.6, 50.0, 50.0, -20.0)

    found = points(tiles, PointSelection(clip=(box,)))[0] - SHIFT_M
    both = points(tiles, PointSelection(clip=(box, strip)))[0]

    x, y, z = (every - middle).T
    along = np.cos(turn) * x + np.sin(turn) * y, np.cos(turn) * y - np.sin(turn) * x, z
    pairs = zip(along, (1.0, 0.5, 0.75), strict=True)
    inside = np.all([np.abs(one) <= half for one, half in pairs], axis=0)
    np.testing.assert_array_equal(found, every[inside])
    assert 0 < len(both) < len(found) < len(every)
    assert PointSource.of(tiles, IN_A_GRID, PointSelection(clip=(box,))).count == len(found)


def test_tiles_beside_a_clip_are_not_read(tiles):
    _, high = tiles.bounds_m
    far = (float(high[0]) + 30.0, 0.0, 0.0, 40.0, 1.0, 1.0, 45.0)
    source = PointSource.uncounted(tiles, OutputCrs(), PointSelection(clip=(far,)))

    assert not any(source.may_have(tile) for tile in tiles)


@pytest.mark.parametrize(
    ("clip", "says"),
    [
        (((0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0),), "edges above 0"),
        (((0.0, 0.0, np.nan, 1.0, 1.0, 1.0, 0.0),), "edges above 0"),
        (((0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 0.0),) * 9, "at most 8 boxes, got 9"),
    ],
)
def test_a_clip_that_cannot_be_is_refused(clip, says):
    with pytest.raises(ConfigError, match=says):
        ExportOptions(clip=clip).selection()
