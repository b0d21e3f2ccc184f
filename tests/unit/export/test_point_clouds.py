"""Exports of the map: LAZ and PLY."""

import re
import subprocess
import sys
from datetime import date

import laspy
import numpy as np
import pyproj
import pytest
from msgspec import structs

from recon4.errors import ConfigError, GeoreferenceError, StoreError
from recon4.export import account, laz
from recon4.export.laz import export_laz
from recon4.export.pcd import export_pcd, needed_offset
from recon4.export.ply import export_ply
from recon4.export.points import OutputCrs
from recon4.export.selection import EVERY_CLASS, PointSelection
from recon4.export.tuning import LAZ, POINT_EXPORT
from recon4.export.xyz import export_xyz
from recon4.intensity.normalize import learn_intensity
from recon4.intensity.tuning import IntensityTuning
from recon4.mapping.build import MapInputs, build_map
from recon4.mapping.map_notes import MapCrs
from recon4.mapping.tiles import TileSet
from recon4.model.gps_time import adjusted_gps_s
from recon4.model.trajectory import Trajectory
from recon4.settings import MapSettings
from tests.room_walks import T0_NS, Walk, room_walk

UTM = MapCrs(pyproj.CRS("EPSG:32633+5773").to_wkt(), (500_000.25, 5_400_000.5, 300.0))


def make(folder, *, crs=UTM, walk=None, normalize=True):
    folder.mkdir()
    walk = walk or room_walk(frames=10)
    table = None
    if normalize:
        table, _ = learn_intensity(walk, walk.trajectory, settings=IntensityTuning(min_count=10))
    return build_map(
        MapInputs(walk, walk.trajectory, table, crs), folder, settings=MapSettings(voxel_m=0.02)
    )


def column(tiles, name):
    return np.concatenate([t.read([name])[name][t.spatial_order()] for t in tiles])


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("export") / "map"
    make(folder)
    return folder


def test_laz_holds_every_point_with_all_that_is_known_of_it(folder, tmp_path):
    tiles = TileSet.open(folder)

    count = export_laz(folder, tmp_path / "map.laz")

    cloud = laspy.read(tmp_path / "map.laz")
    xyz = np.concatenate([t.xyz_m()[t.spatial_order()] for t in tiles]) + UTM.origin_m
    assert count == len(tiles) == len(cloud)
    assert (str(cloud.header.version), cloud.point_format.id) == ("1.4", 6)
    np.testing.assert_allclose(cloud.xyz, xyz, rtol=0, atol=0.000001)  # nothing is rounded twice
    np.testing.assert_array_equal(cloud.intensity, column(tiles, "intensity"))
    np.testing.assert_array_equal(cloud["ring"], column(tiles, "ring"))
    np.testing.assert_array_equal(cloud["frame_id"], column(tiles, "frame_id"))
    np.testing.assert_array_equal(cloud.point_source_id, column(tiles, "sensor") + 1)
    np.testing.assert_array_equal(np.asarray(cloud.return_number), column(tiles, "echo") + 1)
    np.testing.assert_allclose(
        cloud["intensity_normalized"], column(tiles, "intensity_normalized"), atol=1 / 32
    )
    expected_s = (column(tiles, "t_ns") - 315_964_800 * 10**9) / 1e9 + 18 - 1e9
    np.testing.assert_allclose(cloud.gps_time, expected_s, rtol=0, atol=1e-6)
    assert cloud.header.global_encoding.gps_time_type == laspy.header.GpsTimeType.STANDARD
    listed = cloud.header.vlrs.get("ExtraBytesVlr")[0].extra_bytes_structs
    assert not any(one.min_is_relevant() or one.max_is_relevant() for one in listed)
    assert cloud.header.global_encoding.wkt
    assert cloud.header.parse_crs().to_epsg() in {None, 32633}
    assert cloud.header.parse_crs().sub_crs_list[0].to_epsg() == 32633
    assert np.array_equal(cloud.header.offsets, np.round(cloud.header.offsets))
    assert cloud.header.creation_date == date(2023, 11, 14)


def test_the_same_map_gives_the_same_file(folder, tmp_path):
    for name in ("a.laz", "b.laz", "a.ply", "b.ply"):
        (export_laz if name.endswith("laz") else export_ply)(folder, tmp_path / name)

    assert (tmp_path / "a.laz").read_bytes() == (tmp_path / "b.laz").read_bytes()
    assert (tmp_path / "a.ply").read_bytes() == (tmp_path / "b.ply").read_bytes()


def test_how_many_points_are_compressed_at_once_changes_nothing(folder, tmp_path, monkeypatch):
    export_laz(folder, tmp_path / "a.laz")
    monkeypatch.setattr(laz, "LAZ", structs.replace(LAZ, together=1001))
    monkeypatch.setattr(account, "POINT_EXPORT", structs.replace(POINT_EXPORT, summed=300))

    export_laz(folder, tmp_path / "b.laz")

    assert (tmp_path / "a.laz").read_bytes() == (tmp_path / "b.laz").read_bytes()


def test_a_map_with_its_own_clock_and_no_crs_says_so(tmp_path):
    walk = room_walk(frames=5)
    shifted = Walk(
        [
            type(f)(
                f.frame_id,
                f.t_ns - T0_NS + 10**9,
                f.duration_ns,
                f.xyz,
                f.intensity,
                f.ring,
                f.sensor,
                f.echo,
                f.dt_ns,
            )
            for f in walk.frames
        ],
        walk.rig,
        Trajectory(walk.trajectory.t_ns - T0_NS + 10**9, walk.trajectory.T_a_b),
    )
    make(tmp_path / "map", crs=None, walk=shifted, normalize=False)

    export_laz(tmp_path / "map", tmp_path / "map.laz")

    cloud = laspy.read(tmp_path / "map.laz")
    assert cloud.header.global_encoding.gps_time_type == laspy.header.GpsTimeType.WEEK_TIME
    assert 1.0 <= cloud.gps_time.min() < cloud.gps_time.max() <= 1.5
    assert cloud.header.parse_crs() is None
    assert "intensity_normalized" not in list(cloud.point_format.dimension_names)


def test_another_crs_and_way_to_it_can_be_given(folder, tmp_path):
    export_laz(
        folder,
        tmp_path / "map.laz",
        OutputCrs("EPSG:5514", lambda xyz: xyz[:, [1, 0, 2]] - 700_000),
    )

    cloud = laspy.read(tmp_path / "map.laz")
    low = TileSet.open(folder).bounds_m[0][[1, 0, 2]] - 700_000
    np.testing.assert_allclose(cloud.header.mins, low, rtol=0, atol=0.0001)
    assert "Krovak" in cloud.header.parse_crs().name


def test_ply_holds_every_point_with_all_its_fields(folder, tmp_path):
    tiles = TileSet.open(folder)

    assert export_ply(folder, tmp_path / "map.ply") == len(tiles)

    head, _, body = (tmp_path / "map.ply").read_bytes().partition(b"end_header\n")
    kinds = {"double": "<f8", "float": "<f4", "uint": "<u4", "ushort": "<u2", "uchar": "u1"}
    lines = [line.split() for line in head.decode().splitlines()]
    row = np.dtype([(line[2], kinds[line[1]]) for line in lines if line[0] == "property"])
    assert ["element", "vertex", str(len(tiles))] in lines
    assert ["format", "binary_little_endian", "1.0"] in lines
    points = np.frombuffer(body, row)
    assert len(points) == len(tiles)
    xyz = np.concatenate([t.xyz_m()[t.spatial_order()] for t in tiles]) + UTM.origin_m
    np.testing.assert_allclose(np.stack([points[a] for a in "xyz"], 1), xyz, rtol=0, atol=1e-6)
    for name in ("intensity", "intensity_normalized", "ring", "sensor", "frame_id", "range_m"):
        np.testing.assert_array_equal(points[name], column(tiles, name))
    np.testing.assert_allclose(points["nz"], column(tiles, "normal")[:, 2], atol=1e-6)


def test_pcd_holds_every_point_relative_to_its_offset(folder, tmp_path):
    import open3d

    tiles = TileSet.open(folder)
    assert export_pcd(folder, tmp_path / "map.pcd") == len(tiles)

    head = (tmp_path / "map.pcd").read_bytes().partition(b"\nVERSION")[0].decode()
    offset = np.array(re.search(r"# offset (\S+) (\S+) (\S+)$", head).groups(), float)
    cloud = open3d.t.io.read_point_cloud(str(tmp_path / "map.pcd")).point
    xyz = np.concatenate([t.xyz_m()[t.spatial_order()] for t in tiles]) + UTM.origin_m
    np.testing.assert_allclose(cloud["positions"].numpy() + offset, xyz, rtol=0, atol=1e-5)
    normalized = column(tiles, "intensity_normalized")
    np.testing.assert_array_equal(cloud["intensity"].numpy()[:, 0], normalized)
    np.testing.assert_allclose(cloud["normals"].numpy(), column(tiles, "normal"), atol=1e-6)


def test_pcd_of_a_map_near_its_origin_lies_where_its_other_files_do():
    assert needed_offset(np.array([12.0, -240.0, 1.0])).tolist() == [0.0, 0.0, 0.0]
    assert needed_offset(np.array([12.0, -260.0, 1.0])).tolist() == [12.0, -260.0, 1.0]


def test_xyz_has_a_line_for_every_point(folder, tmp_path):
    tiles = TileSet.open(folder)
    assert export_xyz(folder, tmp_path / "map.xyz") == len(tiles)

    first = (tmp_path / "map.xyz").read_text().partition("\n")[0]
    rows = np.loadtxt(tmp_path / "map.xyz", comments="//")
    xyz = np.concatenate([t.xyz_m()[t.spatial_order()] for t in tiles]) + UTM.origin_m
    assert first == "//X Y Z Intensity Classification"
    np.testing.assert_allclose(rows[:, :3], xyz, rtol=0, atol=5.1e-5)
    np.testing.assert_allclose(rows[:, 3], column(tiles, "intensity_normalized"), atol=0.051)


def test_ply_names_the_crs_of_its_coordinates(folder, tmp_path):
    export_ply(folder, tmp_path / "map.ply", OutputCrs("EPSG:32632", lambda xyz: xyz))

    assert b"comment crs EPSG:32632\n" in (tmp_path / "map.ply").read_bytes()[:400]


@pytest.mark.parametrize("export", [export_laz, export_ply, export_pcd, export_xyz])
def test_an_empty_map_and_a_wrong_name_are_refused(export, folder, tmp_path):
    walk = room_walk(frames=2)
    empty = Walk([f.take(slice(0, 0)) for f in walk.frames], walk.rig, walk.trajectory)
    make(tmp_path / "empty", walk=empty, normalize=False)
    suffix = export.__name__.removeprefix("export_")

    with pytest.raises(ConfigError, match="no points"):
        export(tmp_path / "empty", tmp_path / f"map.{suffix}")
    with pytest.raises(ConfigError, match=f"must be named .{suffix}"):
        export(folder, tmp_path / "map.bin")
    with pytest.raises(StoreError, match="not the list"):
        export(tmp_path, tmp_path / f"map.{suffix}")
    assert not list(tmp_path.glob(f"*.{suffix}"))


def test_a_crs_that_is_none_and_coordinates_that_do_not_fit_are_refused(folder, tmp_path):
    with pytest.raises(GeoreferenceError, match="not a CRS"):
        export_laz(folder, tmp_path / "map.laz", OutputCrs("EPSG:0"))
    with pytest.raises(GeoreferenceError, match="400 km"):
        export_laz(folder, tmp_path / "map.laz", OutputCrs(map_to_crs=lambda xyz: xyz * 1e7))
    assert list(tmp_path.iterdir()) == []


def test_a_file_that_reads_back_wrong_never_gets_its_name(folder, tmp_path, monkeypatch):
    check = laz._check

    def lose_a_point(path, meant, *args, **named):
        meant.count += 1
        check(path, meant, *args, **named)

    (tmp_path / "map.laz").write_text("the one before")
    monkeypatch.setattr(laz, "_check", lose_a_point)

    with pytest.raises(StoreError):
        export_laz(folder, tmp_path / "map.laz")

    assert [path.name for path in tmp_path.iterdir()] == ["map.laz"]
    assert (tmp_path / "map.laz").read_text() == "the one before"


FULL = """
import resource, signal, sys
from pathlib import Path
from recon4.errors import NoSpace
from recon4.export.map_files import cloud_writer
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, 100_000))
try:
    cloud_writer(Path(sys.argv[2]))(Path(sys.argv[1]), Path(sys.argv[2]))
except NoSpace as error:
    sys.exit(f"NoSpace: {error}")
"""


@pytest.mark.parametrize("name", ["map.laz", "map.copc.laz", "map.ply"])
def test_a_full_disk_is_named_and_leaves_nothing(name, folder, tmp_path):
    ran = subprocess.run(
        [sys.executable, "-c", FULL, str(folder), str(tmp_path / name)],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )

    assert "NoSpace: no space left" in ran.stderr, ran.stderr[-2000:]
    assert list(tmp_path.iterdir()) == []


def test_gps_time_counts_the_leap_seconds():
    # 2017-01-01 00:00:00 UTC is GPS 1167264018; a second before, GPS was 17 s ahead.
    t_ns = np.array([1483228800, 1483228799, 315_964_800], dtype=np.int64) * 10**9

    gps_s = adjusted_gps_s(t_ns) + 1e9

    np.testing.assert_allclose(gps_s, [1167264018, 1167264016, 0], rtol=0, atol=1e-6)


def test_stray_returns_are_classes_of_their_own(tmp_path):
    walk = room_walk(frames=30, points=20_000, noise_m=0.01)
    walk.frames[3].xyz[7] = [1.0, 0.5, 0.3]  # in the middle of the room
    tiles = make(tmp_path / "map", walk=walk, normalize=False)

    count = export_laz(tiles, tmp_path / "map.laz", selection=PointSelection(classes=EVERY_CLASS))

    found = laspy.read(tmp_path / "map.laz")
    kinds = np.asarray(found.classification)
    assert count == len(tiles) + tiles.strays == len(found)
    assert (kinds[: len(tiles)] == 1).all()
    alone = ~column(tiles.only_strays(), "normal").any(axis=1)
    np.testing.assert_array_equal(kinds[len(tiles) :], np.where(alone, 18, 7))
    assert 0 < alone.sum() < len(alone)
