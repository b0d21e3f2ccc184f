"""COPC: a map as an octree of points, read by another program."""

import json
import shutil
from pathlib import Path

import laspy
import numpy as np
import pytest
from msgspec import structs

from recon4.errors import ConfigError, StoreError
from recon4.export import copc, octree
from recon4.export.copc import export_copc
from recon4.export.laz import export_laz
from recon4.export.points import OutputCrs
from recon4.export.tuning import OCTREE
from recon4.mapping.tiles import TileSet
from recon4.review.stamp import Stamp, stamp_file
from tests.unit.export.test_point_clouds import UTM, make


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("copc") / "map"
    make(folder)
    return folder


SPLIT = "split files"
SMALL = structs.replace(OCTREE, bucket_bits=15, points_in_memory=700, points_of_leaf=150)


@pytest.fixture(scope="module", params=["one file", SPLIT])
def path(request, folder, tmp_path_factory):
    """A map as COPC, made in memory, or in many files that are split once more."""
    out = tmp_path_factory.mktemp("copc-file")
    with pytest.MonkeyPatch.context() as patch:
        if request.param == SPLIT:
            patch.setattr(octree, "OCTREE", SMALL)
        assert export_copc(folder, out / "map.copc.laz") == len(TileSet.open(folder))
    assert [one.name for one in out.iterdir()] == ["map.copc.laz"]
    return out / "map.copc.laz"


def nodes(path):
    with laspy.CopcReader.open(str(path)) as read:
        yield from ((entry.key, entry) for entry in read.root_page.entries.values())


def xyz_m(points):
    return np.stack([points.x, points.y, points.z], axis=1)


def in_order(points):
    exact = ("intensity_normalized", "intensity", "return_number", "ring", "gps_time")
    return np.lexsort([np.asarray(points[name]) for name in exact])


def test_every_point_is_there_once_with_all_its_fields(path, folder, tmp_path):
    export_laz(folder, tmp_path / "plain.laz")
    plain, found = laspy.read(tmp_path / "plain.laz"), laspy.read(path)

    order, expected = in_order(found), in_order(plain)
    np.testing.assert_allclose(found.xyz[order], plain.xyz[expected], rtol=0, atol=0.00056)
    for name in plain.point_format.dimension_names:
        if name not in "XYZ":
            np.testing.assert_array_equal(found[name][order], plain[name][expected], name)
    assert found.header.parse_crs() == plain.header.parse_crs()


def test_a_copc_reader_finds_the_points_of_a_box_and_of_coarse_levels(path):
    with laspy.CopcReader.open(str(path)) as read:
        every = read.query()
        coarse = read.query(level=0)
        middle = xyz_m(every)[0]
        box = laspy.copc.Bounds(middle - 1.0, middle + 1.0)
        inside = read.query(bounds=box)
        spacing = read.copc_info.spacing
        low = read.copc_info.center - read.copc_info.halfsize

    assert len(every) == read.header.point_count
    assert len(inside) == np.sum(np.all(np.abs(xyz_m(every) - middle) <= 1.0, axis=1)) > 0
    cells = np.floor((xyz_m(coarse) - low) / spacing + 1e-6).astype(int)
    assert len(np.unique(cells, axis=0)) == len(coarse) > 100 or len(every) == len(coarse)


def test_points_lie_in_their_nodes_and_each_node_has_one_above_it(path):
    keys = {(key.level, key.x, key.y, key.z) for key, _ in nodes(path)}
    assert {(level - 1, x // 2, y // 2, z // 2) for level, x, y, z in keys if level} <= keys
    with laspy.CopcReader.open(str(path)) as read:
        info = read.copc_info
        for key, entry in nodes(path):
            if entry.point_count == 0:
                continue
            edge = 2.0 * info.halfsize / 2**key.level
            low = info.center - info.halfsize + edge * np.array([key.x, key.y, key.z])
            xyz = xyz_m(read._fetch_and_decompress_points_of_nodes([entry]))
            assert ((xyz >= low - 1e-5) & (xyz < low + edge)).all()


@pytest.mark.parametrize("path", [SPLIT], indirect=True)
def test_split_files_make_a_deep_tree_of_small_nodes(path):
    assert max(key.level for key, _ in nodes(path)) >= 4


def test_the_info_record_comes_first_as_the_format_says(path):
    head = path.read_bytes()[:589]
    assert head[377:381] == b"copc"
    assert int.from_bytes(head[393:395], "little") == 1
    assert int.from_bytes(head[395:397], "little") == 160


def test_coordinates_of_another_crs_are_kept(folder, tmp_path):
    shift = np.array([1.0, 2.0, 3.0])
    output = OutputCrs("EPSG:32632", lambda xyz: xyz + UTM.origin_m + shift)
    export_copc(folder, tmp_path / "map.copc.laz", output)

    found = laspy.read(tmp_path / "map.copc.laz")
    low, high = TileSet.open(folder).bounds_m
    np.testing.assert_allclose(found.header.mins, low + UTM.origin_m + shift, atol=1e-3)
    np.testing.assert_allclose(found.header.maxs, high + UTM.origin_m + shift, atol=1e-3)
    assert found.header.parse_crs().to_epsg() == 32632


def test_an_approval_is_added_without_moving_a_node(path, tmp_path):
    path = Path(shutil.copy(path, tmp_path))
    before = [(entry.offset, entry.byte_size) for _, entry in nodes(path)]
    stamp = Stamp(version=2, who="Žofie", role="reviewer", time="2026-11-21T08:00Z", hash="ab")
    stamp_file(path, path, stamp)

    with laspy.CopcReader.open(str(path)) as read:
        assert len(read.query()) == read.header.point_count
    assert [(entry.offset, entry.byte_size) for _, entry in nodes(path)] == before
    last = laspy.read(path).evlrs[-1]
    assert (last.user_id, json.loads(last.record_data_bytes())["who"]) == ("recon4", "Žofie")


def test_a_file_that_reads_back_wrong_is_not_kept(folder, tmp_path, monkeypatch):
    write = copc._write

    def damage(file, *arguments, **named):
        chunks = write(file, *arguments, **named)
        file.seek(chunks[0].offset + chunks[0].size // 2)
        file.write(b"\xff\x00\xff")
        file.flush()
        return chunks

    monkeypatch.setattr(copc, "_write", damage)
    with pytest.raises(StoreError, match=r"reads back wrong|cannot write"):
        export_copc(folder, tmp_path / "map.copc.laz")
    assert list(tmp_path.iterdir()) == []


def test_a_name_that_does_not_promise_copc_is_refused(folder, tmp_path):
    with pytest.raises(ConfigError, match=r"must be named \.copc\.laz"):
        export_copc(folder, tmp_path / "map.laz")
