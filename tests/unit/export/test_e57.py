"""E57: the map as scans with poses, read by another program."""

import numpy as np
import pye57
import pytest

from recon4.errors import ConfigError, StoreError
from recon4.export import e57
from recon4.export.e57 import export_e57
from recon4.export.points import CRS_OF_MAP, PointSource
from recon4.progress import Silent
from tests.full_disk import files_end_at
from tests.room_walks import Walk, room_walk
from tests.unit.export.test_point_clouds import UTM, column, make


@pytest.fixture
def path(made, tmp_path):
    tiles, scans = made
    source = PointSource.of(tiles, CRS_OF_MAP)
    count = export_e57(source, tmp_path / "map.e57", scans, progress=Silent())
    assert count == len(tiles)
    assert [one.name for one in tmp_path.iterdir()] == ["map.e57"]
    return tmp_path / "map.e57"


def test_every_point_is_in_the_scan_of_its_node_and_in_place(made, path):
    tiles, scans = made
    xyz = np.concatenate([t.xyz_m()[t.spatial_order()] for t in tiles]) + UTM.origin_m
    frames, intensity = column(tiles, "frame_id"), column(tiles, "intensity_normalized")
    first = np.r_[0, scans.frame_ids[1:], frames.max() + 1]

    with pye57.E57(str(path)) as file:
        assert file.scan_count == len(scans.frame_ids)
        for k in range(file.scan_count):
            found = file.read_scan(k, intensity=True, ignore_missing_fields=True)
            expected = (frames >= first[k]) & (frames < first[k + 1])
            p_file = np.stack([found[f"cartesian{axis}"] for axis in "XYZ"], axis=1)
            np.testing.assert_allclose(p_file, xyz[expected], rtol=0, atol=1e-5)
            np.testing.assert_allclose(found["intensity"], intensity[expected], rtol=1e-6)


def test_scans_have_the_poses_and_times_of_their_nodes(made, path):
    _, scans = made
    with pye57.E57(str(path)) as file:
        for k in range(file.scan_count):
            head = file.get_header(k)
            T = scans.T_map_body[k]
            np.testing.assert_allclose(head.translation, T.t + UTM.origin_m, atol=1e-9)
            np.testing.assert_allclose(head.rotation_matrix, T.R, atol=1e-12)
            gps_s = head["acquisitionStart"]["dateTimeValue"].value()
            assert gps_s == pytest.approx(scans.t_ns[k] / 1e9 - 315_964_800 + 18, abs=1e-5)
            assert head["description"].value() == scans.note


def test_the_file_names_its_crs_and_is_the_same_each_time(made, path, tmp_path):
    tiles, scans = made
    with pye57.E57(str(path)) as file:
        assert file.root["coordinateMetadata"].value() == UTM.wkt
    source = PointSource.of(tiles, CRS_OF_MAP)
    export_e57(source, tmp_path / "b.e57", scans, progress=Silent())
    assert (tmp_path / "b.e57").read_bytes() == path.read_bytes()


def test_a_file_that_reads_back_wrong_is_refused(made, tmp_path, monkeypatch):
    tiles, scans = made
    source = PointSource.of(tiles, CRS_OF_MAP)
    write = e57._write_scan

    def another(image, data, scan):
        scan.rows["cartesianX"][0] += 1.0
        write(image, data, scan)

    monkeypatch.setattr(e57, "_write_scan", another)
    with pytest.raises(StoreError, match="reads back wrong: cartesianX of scan 0"):
        export_e57(source, tmp_path / "x.e57", scans, progress=Silent())


def test_a_disk_that_fills_while_it_is_written_is_said_in_one_line(made, tmp_path):
    tiles, scans = made
    source = PointSource.of(tiles, CRS_OF_MAP)
    with (
        files_end_at(350_000),  # more than a scan, less than all
        pytest.raises(StoreError, match="is the disk full") as raised,
    ):
        export_e57(source, tmp_path / "x.e57", scans, progress=Silent())
    assert "\n" not in str(raised.value) and len(str(raised.value)) < 200


def test_an_empty_map_is_refused(made, tmp_path):
    walk = room_walk(frames=2)
    empty = Walk([f.take(slice(0, 0)) for f in walk.frames], walk.rig, walk.trajectory)
    make(tmp_path / "empty", walk=empty, normalize=False)
    with pytest.raises(ConfigError, match="no points"):
        PointSource.of(tmp_path / "empty", CRS_OF_MAP)
