"""Small or sparse files that would fill the memory: rejected within 10 s and 1 GiB, with a message.

The readers run in a child that may take 1 GiB beyond its imports. Each refusal must be an error
of ours, at most 10 s after the call, with at most 1 GiB of resident memory more than before.
"""

from __future__ import annotations

import json
import os
import struct
import zipfile
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from recon4.evaluation.markers import read_markers
from recon4.evaluation.reference_mesh import read_mesh
from recon4.evaluation.trajectories import find_trajectory
from recon4.georeference.crs_file import read_crs
from recon4.mapping.tiles import TileSet
from recon4.model.rig import load_rig, parse_rig
from recon4.recording.formats.cloud_files import read_cloud
from recon4.recording.formats.reference_clouds import read_points
from recon4.recording.info.describe import describe
from recon4.recording.samples.csv_files import IMU_HEADER, read_gnss_csv, read_imu_csv
from recon4.slices.control_points import read_control
from recon4.slices.reference import read_facts
from recon4.slices.reference_import import import_reference
from recon4.store.arrays import load_trajectory
from recon4.store.frames import INDEX, FrameStore
from tests.security.fuzz import seeds_clouds as clouds
from tests.security.fuzz import seeds_tables as tables
from tests.security.measured import (
    DEADLINE_S,
    LIMIT_BYTES,
    MeasuredChild,
    assert_refused,
    measured_child,
)

SPARSE = 7 << 30
_PCD = """VERSION 0.7
FIELDS x y z
SIZE 4 4 4
TYPE F F F
COUNT 1 1 1
WIDTH {count}
HEIGHT 1
POINTS {count}
DATA {data}
"""
_PLY = """ply
format {format} 1.0
element vertex {count}
property float x
property float y
property float z
{more}end_header
"""


@pytest.fixture(scope="module")
def child(tmp_path_factory: pytest.TempPathFactory) -> Iterator[MeasuredChild]:
    folder = tmp_path_factory.mktemp("warm")
    (folder / "a.pcd").write_bytes(clouds.pcd()[2])
    (folder / "a.laz").write_bytes(clouds.las(compressed=True)[1])
    with measured_child(
        (read_points, (folder / "a.pcd",)), (read_points, (folder / "a.laz",))
    ) as made:
        yield made


def sparse(path: Path, head: bytes | str, size: int = SPARSE) -> Path:
    with path.open("wb") as file:
        file.write(head.encode() if isinstance(head, str) else head)
        file.truncate(size)
    return path


SPARSE_FILES = {
    "pcd": ("a.pcd", _PCD.format(count=SPARSE // 12, data="binary"), read_points, "400000000"),
    "pcd-frame": ("a.pcd", _PCD.format(count=SPARSE // 13, data="binary"), read_cloud, "frame"),
    "pcd-info": ("a.pcd", _PCD.format(count=SPARSE // 12, data="binary"), describe, "frame"),
    "pcd-ascii": ("a.pcd", _PCD.format(count=100, data="ascii"), read_points, "lines of at most"),
    "pcd-packed": (
        "a.pcd",
        _PCD.format(count=1 << 26, data="binary_compressed").encode()
        + struct.pack("<II", 0xFFFFFFFF, 12 << 26),
        read_points,
        "compressed block",
    ),
    "ply": (
        "a.ply",
        _PLY.format(format="binary_little_endian", count=SPARSE // 12, more=""),
        read_points,
        "400000000",
    ),
    "ply-ascii": ("a.ply", _PLY.format(format="ascii", count=9, more=""), read_points, "lines of"),
    "ply-mesh": (
        "a.ply",
        _PLY.format(
            format="binary_little_endian",
            count=3,
            more="element face 500000000\nproperty list uchar int vertex_indices\n",
        ),
        read_mesh,
        "20000000 triangles",
    ),
    "bin": ("a.bin", "", read_cloud, "frame"),
    "obj": ("a.obj", "v 0 0 0\n", read_mesh, "expected at most 4294967296 bytes"),
    "obj-4-gib": ("a.obj", "v 0 0 0\n", read_mesh, "line 2"),
    "stl": (
        "a.stl",
        bytes(80) + struct.pack("<I", (SPARSE - 84) // 50),
        read_mesh,
        "triangles",
    ),
    "stl-ascii": ("a.stl", "solid a\n", read_mesh, "triangles"),
    "xyz": ("a.xyz", "1 2 3\n", read_points, "line 2: expected text, got a NUL byte"),
    "csv-imu": ("imu.csv", ",".join(IMU_HEADER) + "\n1", read_imu_csv, "at most 1073741824 bytes"),
    "csv-imu-line": (
        "imu.csv",
        ",".join(IMU_HEADER) + "\n" + "1" * 20_000,
        read_imu_csv,
        "line 2: expected at most 16384 bytes",
    ),
    "csv-gnss": ("g.csv", "t_ns,lat_deg,lon_deg\n1", read_gnss_csv, "at most 1073741824 bytes"),
    "csv-info": ("imu.csv", ",".join(IMU_HEADER) + "\n1", describe, "at most 1073741824 bytes"),
    "markers": ("m.csv", "name,x_m,y_m,z_m\n", read_markers, "at most 16777216 bytes"),
    "tum": ("a.tum", "1 0 0 0 0 0 0 1\n", find_trajectory, "at most 1073741824 bytes"),
    "tum-line": ("a.tum", "1 0 0 0 0 0 0 1\n", find_trajectory, "line 2"),
    "rig": ("rig.toml", 'name = "a"\n', load_rig, "expected at most 131072 bytes, got 7516192768"),
}
SIZES = {"obj-4-gib": 3 << 30, "csv-imu-line": 1 << 30, "tum-line": 1 << 30}


@pytest.mark.parametrize("name", SPARSE_FILES)
def test_a_sparse_file_is_refused(name: str, tmp_path: Path, child: MeasuredChild) -> None:
    file_name, head, read, words = SPARSE_FILES[name]
    path = sparse(tmp_path / file_name, head, SIZES.get(name, SPARSE))
    outcome = child.call(read, path)
    if name == "pcd-info":  # info goes on after a refusal: its memory and time are what counts
        assert outcome.seconds <= DEADLINE_S
        assert outcome.peak_bytes <= LIMIT_BYTES
    else:
        assert_refused(outcome, words)


# -- headers that lie


def test_a_layer_of_laz_that_asks_for_gigabytes_is_refused(tmp_path, child):
    data = bytearray(clouds.las(compressed=True)[1])
    at = struct.unpack_from("<I", data, 96)[0] + 8 + 31 + 4
    for layer in range(10):
        struct.pack_into("<I", data, at + 4 * layer, 0xFFFFFFF0)
    (tmp_path / "a.laz").write_bytes(data)
    assert_refused(child.call(read_points, tmp_path / "a.laz"), "the layers of chunk 0 reach")


@pytest.mark.parametrize("seed", [0, 1])
def test_a_chunk_table_of_laz_that_asks_for_gigabytes_is_refused(seed, tmp_path, child):
    data = bytearray(clouds.las(compressed=True)[seed])
    table = struct.unpack_from("<q", data, struct.unpack_from("<I", data, 96)[0])[0]
    struct.pack_into("<I", data, table + 4, 0xFFFFFFFF)
    (tmp_path / "a.laz").write_bytes(data)
    assert_refused(child.call(read_points, tmp_path / "a.laz"), "4294967295 chunks")


@pytest.mark.parametrize("compressed", [False, True])
def test_more_points_than_32_bits_count_are_refused(compressed, tmp_path, child):
    data = bytearray(clouds.las(compressed=compressed)[1])
    struct.pack_into("<Q", data, 247, 2**32 + 1)
    path = sparse(tmp_path / "a.las", bytes(data), SPARSE)
    outcome = child.call(read_points, path)
    assert_refused(outcome, "4294967297 points")


def test_records_of_las_that_are_not_there_are_refused(tmp_path, child):
    data = bytearray(clouds.las(compressed=False)[1])
    struct.pack_into("<I", data, 100, 0xFFFFFFFF)
    (tmp_path / "a.las").write_bytes(data)
    assert_refused(child.call(read_points, tmp_path / "a.las"), "4294967295 variable length")


@pytest.mark.parametrize(
    ("packed", "unpacked", "words"),
    [
        (10, 12 << 24, "the compressed block of 10 bytes says"),
        (0xFFFFFF00, 12 << 20, "bytes, got"),
        (1000, 100, "12582912 bytes"),
    ],
)
def test_sizes_of_a_compressed_pcd_that_lie_are_refused(packed, unpacked, words, tmp_path, child):
    count = (12 << 20) // 12 if unpacked <= 12 << 20 else unpacked // 12
    head = _PCD.format(count=count, data="binary_compressed").encode()
    (tmp_path / "a.pcd").write_bytes(head + struct.pack("<II", packed, unpacked) + bytes(1000))
    assert_refused(child.call(read_points, tmp_path / "a.pcd"), words)


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("property list uint int x", "got the list 'x'"),
        ("element vertex 99999999999999999999", "a count"),
        ("element vertex 999999999999999999", "400000000 points"),
        ("element vertex 4", "need 48 bytes"),
        ("element vertex -5", "a count"),
    ],
)
def test_a_ply_header_that_lies_is_refused(line, words, tmp_path, child):
    text = _PLY.format(format="binary_little_endian", count=3, more="")
    old = "property float x" if line.startswith("property") else "element vertex 3"
    (tmp_path / "a.ply").write_bytes(text.replace(old, line).encode() + bytes(36))
    assert_refused(child.call(read_points, tmp_path / "a.ply"), words)


def test_a_reference_of_scattered_points_opens_no_million_files(tmp_path, child):
    rng = np.random.default_rng(1)
    points = rng.uniform(-1e7, 1e7, (150_000, 3))
    text = "\n".join(" ".join(f"{v:.1f}" for v in p) for p in points.tolist())
    (tmp_path / "a.xyz").write_text(text)
    outcome = child.call(partial(import_reference), tmp_path / "a.xyz", tmp_path / "out")
    assert_refused(outcome, "cubes of 5 m")
    assert not (tmp_path / "out").exists()


# -- arrays


def npy(shape: str, dtype: str = "'<f8'") -> bytes:
    text = f"{{'descr': {dtype}, 'fortran_order': False, 'shape': {shape}, }}\n".encode()
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(text)) + text


def test_an_npy_header_of_a_terabyte_is_refused(tmp_path, child):
    tables.frame_store(tmp_path)
    (tmp_path / "index.npy").write_bytes(npy("(12500000000,)", str(INDEX.descr)) + bytes(560))
    outcome = child.call(FrameStore.open, tmp_path)
    assert_refused(outcome, "needs 700000000000 bytes, got 560")


def test_a_sparse_npy_is_refused(tmp_path, child):
    tables.frame_store(tmp_path)
    sparse(tmp_path / "index.npy", npy(f"({SPARSE // INDEX.itemsize},)", str(INDEX.descr)))
    assert_refused(child.call(FrameStore.open, tmp_path), "expected at most 1073741824 bytes")


@pytest.mark.parametrize("header", ["(" * 5000, "'" * 999, "[" * 9000 + "]" * 9000])
def test_an_npy_header_that_is_no_header_is_refused(header, tmp_path, child):
    tables.frame_store(tmp_path)
    (tmp_path / "index.npy").write_bytes(npy(header))
    assert_refused(child.call(FrameStore.open, tmp_path), "frame store")


def test_an_npz_that_unpacks_a_thousandfold_is_refused(tmp_path, child):
    rows = 25_000_000
    with zipfile.ZipFile(tmp_path / "trajectory.npz", "w", zipfile.ZIP_DEFLATED) as archive:
        for name in ("t_ns", "quat_xyzw", "t_m"):
            with archive.open(f"{name}.npy", "w", force_zip64=True) as member:
                member.write(npy(f"({rows},)"))
                for _ in range(8 * rows // 1_000_000):
                    member.write(bytes(1_000_000))
    packed = (tmp_path / "trajectory.npz").stat().st_size
    assert packed < 1 << 20
    outcome = child.call(load_trajectory, tmp_path / "trajectory.npz")
    assert_refused(outcome, "times the packed size")
    assert outcome.peak_bytes < 64 << 20


def test_an_npz_whose_arrays_ask_for_more_than_they_have_is_refused(tmp_path, child):
    with zipfile.ZipFile(tmp_path / "trajectory.npz", "w") as archive:
        for name in ("t_ns", "quat_xyzw", "t_m"):
            archive.writestr(f"{name}.npy", npy("(125000000000,)") + bytes(800))
    outcome = child.call(load_trajectory, tmp_path / "trajectory.npz")
    assert_refused(outcome, "needs 1000000000000 bytes, got 800")


# -- JSON and TOML

DEEP = "[" * 100_000
JSON_FILES: dict[str, tuple[str, Callable[[Path], object]]] = {
    "tiles": ("tiles.json", TileSet.open),
    "reference": ("reference.json", read_facts),
    "import report": ("report.json", FrameStore.open),
    "georeference": ("georeference.json", read_crs),
}


@pytest.mark.parametrize("name", JSON_FILES)
@pytest.mark.parametrize(
    "content", [DEEP, '{"a": "\\ud800"}', "", "[1]", '{"a":' * 300 + "1" + "}" * 300, "sparse"]
)
def test_json_that_is_deep_or_endless_or_no_object_is_refused(name, content, tmp_path, child):
    file_name, read = JSON_FILES[name]
    tables.frame_store(tmp_path)
    path = tmp_path / file_name
    sparse(path, "{") if content == "sparse" else path.write_text(content)
    assert_refused(child.call(read, tmp_path), "")


@pytest.mark.parametrize(
    "text",
    [
        "a = " + DEEP[:60_000],
        "a" + ".a" * 60_000 + " = 1",
        "[" + "a." * 50_000 + "a]",
        "a = { b = " * 5_000,
        "a = " + "9" * 100_000,
        '[[sensor]]\nname = "a"\n' * 5000,
        "sensor = 5",
        "[sensor]\nname = 5",
        "imu = 1\n[[sensor]]\nname = 'a'",
        "[[sensor]]\nname = 'a'\ntime_offset_s = " + "9" * 400,
        "[[sensor]]\nname = 'a'\nxyz_m = [1e300, 0, 0]",
        "x" * 200_000,
    ],
)
def test_a_rig_that_would_keep_the_parser_busy_is_refused(text, child):
    outcome = child.call(partial(parse_rig, where="rig.toml"), text)
    assert_refused(outcome, "rig.toml")
    assert outcome.seconds < 2.0


def test_control_points_without_end_are_refused(child):
    assert_refused(child.call(read_control, b"P1,1,2,3\n" * 10**6), "at most 4194304 bytes")


def test_a_device_or_pipe_is_not_read(tmp_path, child):
    os.mkfifo(tmp_path / "a.tum")
    assert_refused(child.call(find_trajectory, tmp_path / "a.tum"), "expected a trajectory file")
    os.mkfifo(tmp_path / "rig.toml")
    assert_refused(child.call(load_rig, tmp_path / "rig.toml"), "expected a regular file")
    (tmp_path / "z.toml").symlink_to("/dev/zero")
    assert_refused(child.call(load_rig, tmp_path / "z.toml"), "expected a regular file")


def test_the_readers_still_take_what_is_whole(tmp_path, child):
    (tmp_path / "a.laz").write_bytes(clouds.las(compressed=True)[1])
    (tmp_path / "t.tum").write_bytes(tables.tum()[0])
    tables.frame_store(tmp_path)
    for read, path in (
        (read_points, tmp_path / "a.laz"),
        (find_trajectory, tmp_path / "t.tum"),
        (FrameStore.open, tmp_path),
    ):
        outcome = child.call(read, path)
        assert not outcome.error, outcome.words
    assert json.loads((tmp_path / "report.json").read_text())["outcome"] == "complete"
