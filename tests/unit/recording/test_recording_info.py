"""What `recon4 info` says of a recording."""

import numpy as np
import pytest

from recon4.errors import UnknownFormat
from recon4.recording.info import describe
from recon4.recording.kinds import RecordingKind, recognize
from tests.builders import write_room_bag
from tests.unit.recording.ingested import frame_folder, imu_csv, run


@pytest.mark.parametrize("kind", ["bag1", "db3", "mcap"])
def test_info_of_a_bag_names_topics_rates_and_what_is_derived(tmp_path, kind):
    info = describe(write_room_bag(tmp_path, kind))

    (sensor,) = info.sensors
    assert (sensor.label, sensor.model, sensor.count) == ("/velodyne_packets", "VLP-16", 11)
    assert sensor.rotation_hz == pytest.approx(10.0, abs=0.02)
    text = "\n".join(info.lines())
    assert "/imu: IMU, 110" in text
    assert "/fix: GNSS positions, 6" in text
    assert "2023-11-14 22:13:20.000 UTC" in text
    assert "derived   no rig given" in text


def test_info_of_a_pcap_says_what_is_missing(pcap):
    info = describe(pcap)

    assert info.sensors[0].count == 753
    assert any("IMU" in text for text in info.missing)
    assert "lidar     192.168.1.201:2368 VLP-16: 753 packets" in "\n".join(info.lines())


def test_info_asks_for_a_rig(tmp_path):
    info = describe(write_room_bag(tmp_path, "db3", seconds=0.3, topics=("/a", "/b")))

    assert len(info.sensors) == 2
    assert any("give a rig file" in text for text in info.missing)


def test_info_of_frames_names_fields(tmp_path):
    info = describe(frame_folder(tmp_path / "f", ["1.pcd", "2.pcd"]))

    assert info.sensors[0].fields == ("x", "y", "z", "intensity", "ring", "time")
    assert "no absolute times" in "\n".join(info.lines())


def test_info_of_samples(tmp_path):
    info = describe(imu_csv(tmp_path / "imu.csv"))

    assert info.kind == RecordingKind.IMU_CSV
    assert info.samples == ("100 IMU samples, 100.0 a second",)


def test_poses_are_recognized_and_are_no_recording(tmp_path):
    path = tmp_path / "t.txt"
    path.write_text("1.0 0 0 0 0 0 0 1\n")

    assert recognize(path) is RecordingKind.POSES
    with pytest.raises(UnknownFormat, match="alone is no recording"):
        run(path, out=tmp_path / "o")


def test_the_rate_of_frames_is_that_of_their_times(tmp_path):
    folder = frame_folder(tmp_path / "f", [f"{k}.pcd" for k in range(4)])
    (folder / "times.txt").write_text("".join(f"{1000 + 0.5 * k}\n" for k in range(4)))

    (sensor,) = describe(folder).sensors

    assert sensor.rate_hz == pytest.approx(2.0)


def test_a_single_frame_has_no_rate(tmp_path):
    (sensor,) = describe(frame_folder(tmp_path / "f", ["0.pcd"])).sensors

    assert np.isnan(sensor.rate_hz)
