"""Files that say who approved them stay the files they were."""

import json
from dataclasses import replace

import laspy
import numpy as np
import pytest
from PIL import Image

from recon4.errors import StoreError
from recon4.review.stamp import Stamp, stamp_file

STAMP = Stamp(version=2, who="Žofie", role="reviewer", time="2026-11-21T08:00:00+00:00", hash="ab")


@pytest.mark.parametrize("evlr", [False, True])
def test_a_laz_file_keeps_its_points_and_all_its_records(tmp_path, evlr):
    header = laspy.LasHeader(version="1.4", point_format=6)
    header.offsets, header.scales = np.zeros(3), np.full(3, 1e-4)
    header.vlrs.append(laspy.VLR("someone", 7, "before", b"abc"))
    las = laspy.LasData(header)
    las.x, las.y, las.z = np.random.default_rng(1).uniform(0.0, 9.0, (3, 120_000))
    if evlr:
        las.evlrs = laspy.vlrs.vlrlist.VLRList([laspy.VLR("someone", 9, "behind", b"xyz" * 99)])
    las.write(tmp_path / "map.laz")

    stamp_file(tmp_path / "map.laz", tmp_path / "out.laz", STAMP)

    found = laspy.read(tmp_path / "out.laz")
    assert np.array_equal(found.points.array, las.points.array)
    records = {(one.user_id, one.record_id): one.record_data_bytes() for one in found.vlrs}
    assert records["someone", 7] == b"abc"
    assert json.loads(records["recon4", 1])["who"] == "Žofie"
    if evlr:
        assert [one.record_data_bytes() for one in found.evlrs] == [b"xyz" * 99]


@pytest.mark.parametrize(
    ("name", "text", "line"),
    [
        ("a.ply", "ply\nformat ascii 1.0\nend_header\n1 2 3\n", 2),
        ("a.g2o", "# recon4\nVERTEX\n", 1),
        ("a.pcd", "# .PCD v0.7\nVERSION 0.7\n", 1),
        ("a.xyz", "//X Y Z Intensity\n1 2 3 4\n", 1),
        ("a.csv", "# recon4 slice\nx,y\n", 1),
        ("a.tum", "1 0 0 0 0 0 0 1\n", 0),
        ("a.yaml", "image: map.png\n", 0),
    ],
)
def test_a_text_file_gets_one_line_more(tmp_path, name, text, line):
    (tmp_path / name).write_text(text)

    stamp_file(tmp_path / name, tmp_path / name, STAMP)

    lines = (tmp_path / name).read_text().splitlines()
    said = lines.pop(line)
    assert lines == text.splitlines()
    prefix, _, words = said.partition(" recon4 approval ")
    assert prefix in ("#", "comment", "//") and json.loads(words)["hash"] == "ab"


@pytest.mark.parametrize("why", ["ü" * 3000, "clear. " * 400, "😀" * 200])
def test_a_ply_whose_approval_has_a_long_reason_is_opened_by_other_programs(tmp_path, why):
    import open3d

    points = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(np.eye(3)))
    open3d.io.write_point_cloud(str(tmp_path / "map.ply"), points)

    stamp_file(tmp_path / "map.ply", tmp_path / "map.ply", replace(STAMP, why=why))

    assert len(open3d.io.read_point_cloud(str(tmp_path / "map.ply")).points) == 3
    line = (tmp_path / "map.ply").read_bytes().split(b"\n")[2]
    said = json.loads(line.partition(b" approval ")[2])["why"]
    assert said.endswith("…") and why.startswith(said[:-1]) and len(line) > 850


@pytest.mark.parametrize(
    ("name", "data"),
    [
        ("a.laz", b"LASF\x01\x02"),
        ("a.laz", b"LASF" + bytes(20) + b"\x01\x02" + bytes(400)),  # LAS 1.2
        ("a.json", b"[1]"),
        ("a.png", b"\xff\xd8\xff\xe0" + bytes(60)),  # JPEG
    ],
)
def test_a_file_that_is_something_else_is_refused(tmp_path, name, data):
    (tmp_path / name).write_bytes(data)

    with pytest.raises(StoreError, match="expected"):
        stamp_file(tmp_path / name, tmp_path / name, STAMP)

    assert (tmp_path / name).read_bytes() == data


def test_an_image_keeps_its_pixels_and_gets_a_text(tmp_path):
    pixels = np.arange(12, dtype=np.uint8).reshape(3, 4)
    Image.fromarray(pixels).save(tmp_path / "map.png")

    stamp_file(tmp_path / "map.png", tmp_path / "map.png", STAMP)

    with Image.open(tmp_path / "map.png") as image:
        image.verify()
    with Image.open(tmp_path / "map.png") as image:
        np.testing.assert_array_equal(np.asarray(image), pixels)
        assert json.loads(image.text["recon4 approval"])["hash"] == "ab"


def test_a_kind_that_cannot_carry_an_approval_is_refused(tmp_path):
    (tmp_path / "a.obj").write_text("v 0 0 0")

    with pytest.raises(StoreError, match="cannot carry an approval"):
        stamp_file(tmp_path / "a.obj", tmp_path / "b.obj", STAMP)
