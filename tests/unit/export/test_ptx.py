"""PTX: the map as scans of text with poses, read by arithmetic."""

import numpy as np
import pytest

from recon4.errors import ConfigError, StoreError
from recon4.export import ptx
from recon4.export.map_files import SCANS
from recon4.export.points import CRS_OF_MAP, PointSource
from recon4.export.ptx import export_ptx
from recon4.export.selection import EVERY_CLASS, PointSelection
from recon4.progress import Silent
from tests.unit.export.test_point_clouds import UTM, column


def scans_of(path):
    """Scanner, axes, transformation and points of each scan, as the format says."""
    lines = path.read_text("ascii").splitlines()
    while lines:
        columns, rows = int(lines[0]), int(lines[1])
        head = [np.array(line.split(), float) for line in lines[2:10]]
        points = np.loadtxt(lines[10 : 10 + columns * rows], ndmin=2)
        yield head[0], np.stack(head[1:4]), np.stack(head[4:8]), points
        lines = lines[10 + columns * rows :]


def test_every_point_is_in_place_by_the_transformation_of_its_scan(made, tmp_path):
    tiles, scans = made
    path = tmp_path / "map.ptx"

    count = export_ptx(PointSource.of(tiles, CRS_OF_MAP), path, scans, progress=Silent())

    xyz = np.concatenate([t.xyz_m()[t.spatial_order()] for t in tiles]) + UTM.origin_m
    frames, intensity = column(tiles, "frame_id"), column(tiles, "intensity_normalized")
    first = np.r_[0, scans.frame_ids[1:], frames.max() + 1]
    read = list(scans_of(path))
    assert len(read) == len(scans.frame_ids)
    assert count == len(tiles) == sum(len(points) for *_, points in read)
    for k, (place, axes, matrix, points) in enumerate(read):
        expected = (frames >= first[k]) & (frames < first[k + 1])
        p_file = np.column_stack([points[:, :3], np.ones(len(points))]) @ matrix
        np.testing.assert_allclose(p_file[:, :3], xyz[expected], rtol=0, atol=2e-5)
        np.testing.assert_allclose(points[:, 3], intensity[expected] / 255.0, atol=1e-6)
        np.testing.assert_allclose(place, scans.T_map_body[k].t + UTM.origin_m, atol=1e-6)
        np.testing.assert_allclose(axes @ scans.T_map_body[k].R, np.eye(3), atol=1e-9)
        np.testing.assert_array_equal(matrix[:3, :3], axes)
    assert [one.name for one in tmp_path.iterdir()] == ["map.ptx"]


@pytest.mark.parametrize(("end", "what"), [("1 2 3 0.5\n", "more than"), ("", "points of scan 2")])
def test_a_file_that_reads_back_wrong_is_refused(made, tmp_path, monkeypatch, end, what):
    tiles, scans = made
    check = ptx._check

    def changed(path, scans, progress):
        text = path.read_text("ascii")
        path.write_text(text + end if end else text[: text.rindex(" ")] + "\n", "ascii")
        check(path, scans, progress)

    monkeypatch.setattr(ptx, "_check", changed)
    with pytest.raises(StoreError, match=f"reads back wrong: {what}"):
        export_ptx(PointSource.of(tiles, CRS_OF_MAP), tmp_path / "a.ptx", scans, progress=Silent())


@pytest.mark.parametrize("write", SCANS.values(), ids=SCANS)
def test_a_format_without_classes_holds_nothing_that_the_map_leaves_out(made, tmp_path, write):
    tiles, scans = made
    every = PointSource.of(tiles, CRS_OF_MAP, PointSelection(classes=EVERY_CLASS))

    with pytest.raises(ConfigError, match="has no classes"):
        write(every, tmp_path / "a.ptx", scans, progress=Silent())
