"""What `recon4 info` says of a recording."""

import numpy as np
import pytest

from recon4.cli import main as commands
from recon4.errors import UnknownFormat
from recon4.locales.languages import ENVIRONMENT
from recon4.recording.info.describe import describe
from recon4.recording.kinds import RecordingKind, recognize
from tests.builders import T0_NS, Bag, bag_path, noisy, room_cloud, write_room_bag
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
    assert "derived   No rig given" in text


def test_info_of_a_pcap_says_what_is_missing(pcap):
    info = describe(pcap)

    assert info.sensors[0].count == 753
    assert any("IMU" in text for text in info.missing)
    assert "lidar     192.168.1.201:2368 VLP-16: 753 packets" in "\n".join(info.lines())


def test_info_asks_for_a_rig(tmp_path):
    info = describe(write_room_bag(tmp_path, "db3", seconds=0.3, topics=("/a", "/b")))

    assert len(info.sensors) == 2
    assert any("give a rig" in text for text in info.missing)


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


def _bag_with_imu(folder, gyro_scale=1.0, accel_scale=1.0, *, fix=(50.0, 14.0, 300.0), status=2):
    """A second of clouds, of an IMU in motion and of positions; returns what info says."""
    path = bag_path(folder, "db3")
    with Bag(path, "db3") as bag:
        for k in range(100):
            t_ns = T0_NS + k * 10_000_000
            if k % 10 == 0:
                bag.cloud("/points", t_ns, room_cloud())
                bag.fix("/fix", t_ns, fix[0] + 1e-7 * k, *fix[1:], status=status)
            turns, forces = noisy((0.0, 0.3, 0.4), k), noisy((0.0, 0.0, 9.81), k)
            gyro, accel = np.multiply(turns, gyro_scale), np.multiply(forces, accel_scale)
            bag.imu("/imu", t_ns, gyro, accel)
    return "\n".join(describe(path).lines())


def test_info_of_good_samples_says_nothing_of_them(tmp_path):
    text = _bag_with_imu(tmp_path)

    assert "warning" not in text.split("lidar:")[0]
    assert "acceler" not in text and "no usable" not in text and "lost" not in text


@pytest.mark.parametrize(
    ("scales", "said"),
    [
        ((1.0, 0.0), "The IMU has no accelerometer (all its values are 0)"),
        ((0.0, 1.0), "The IMU has no gyroscope (all its values are 0)"),
        ((57.3, 1.0), "100 of 100 IMU samples: angular rates in deg/s, stored in rad/s"),
        ((1.0, 3.0), "expected about 9.8 m/s²"),
        ((1.0, 1 / 9.81), "100 of 100 IMU samples: accelerations in another unit"),
    ],
)
def test_info_says_what_of_an_imu_will_not_be_used(tmp_path, scales, said):
    assert said in _bag_with_imu(tmp_path, *scales)


@pytest.mark.parametrize(
    ("fix", "status", "said"),
    [
        ((np.nan, np.nan, np.nan), -1, "No usable GNSS position of 10: 10 say that they are no"),
        ((np.nan, np.nan, np.nan), 0, "10 of 10 GNSS positions: no place on earth, dropped"),
        ((50.0, 14.0, 300.0), -1, "No usable GNSS position of 10: 10 say that they are no"),
    ],
)
def test_info_says_that_no_position_can_be_used(tmp_path, fix, status, said):
    text = _bag_with_imu(tmp_path, fix=fix, status=status)

    assert said in text
    assert ("lost" in text) == (status == 0)


def test_positions_without_heights_are_said_to_place_nothing(tmp_path):
    text = _bag_with_imu(tmp_path, fix=(50.0, 14.0, np.nan))

    assert "No GNSS position has a height: they cannot place the map" in text
    assert "No GNSS position has a height" not in _bag_with_imu(tmp_path / "b", fix=(50, 14.0, 0.5))


def test_samples_without_stamps_are_counted_as_repaired(tmp_path):
    path = bag_path(tmp_path, "db3")
    with Bag(path, "db3") as bag:
        header = bag.header
        for k in range(100):
            t_ns = T0_NS + k * 10_000_000
            bag.header = header
            if k % 10 == 0:
                bag.cloud("/points", t_ns, room_cloud())
            bag.header = lambda t_ns, frame=None: header(0, frame)
            bag.imu("/imu", t_ns, noisy((0.0, 0.3, 0.4), k), noisy((0.0, 0.0, 9.81), k))
            if k % 10 == 0:
                bag.fix("/fix", t_ns, 50.0 + 1e-7 * k, 14.0, 300.0)

    repaired = [one.text for one in describe(path).repaired]

    assert "100 of 100 IMU samples: without a stamp, the time of recording is used" in repaired
    assert "10 of 10 GNSS positions: without a stamp, the time of recording is used" in repaired


def test_the_command_speaks_the_language_that_its_confinement_forgets(pcap, monkeypatch, capsys):
    monkeypatch.setenv(ENVIRONMENT, "de")
    monkeypatch.setattr(commands, "confine_command", lambda **_: monkeypatch.delenv(ENVIRONMENT))

    assert commands.main(["info", str(pcap)]) == 0
    said = capsys.readouterr().out
    assert "gefolgert Kein Rig angegeben: ein VLP-16" in said
    assert " je Sekunde, " in said and "Umdrehungen je Sekunde\n" in said


def test_each_kind_of_recording_has_a_code_whose_english_text_is_its_value():
    assert [(kind.text, kind.text.code) for kind in RecordingKind] == [
        (kind.value, f"recording-{kind.name.lower()}") for kind in RecordingKind
    ]


def test_what_is_there_and_what_is_missing_is_said_in_a_language(tmp_path):
    said = describe(imu_csv(tmp_path / "imu.csv")).to_json("de")

    assert said["kind"] == "Messwerte einer IMU (CSV)"
    assert said["samples"] == ["100 IMU-Messwerte, 100,0 je Sekunde"]
