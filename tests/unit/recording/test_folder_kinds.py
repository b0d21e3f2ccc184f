"""Folders with files of several kinds, and samples beside a recording."""

import pytest

from recon4.errors import UnknownFormat
from recon4.recording.nearby_samples import unread_samples
from recon4.recording.open import RecordingKind, recognize
from recon4.recording.sources import Sources
from tests.builders import room_cloud, write_pcd
from tests.unit.recording.ingested import frame_folder, imu_csv


def test_a_folder_with_recordings_of_two_kinds_is_refused_and_both_are_named(tmp_path, pcap):
    folder = frame_folder(tmp_path / "walk", ["model.pcd"])
    (folder / "recording.pcap").write_bytes(pcap.read_bytes())

    with pytest.raises(UnknownFormat) as caught:
        recognize(folder)

    assert "model.pcd (frames" in str(caught.value)
    assert "recording.pcap (Velodyne pcap)" in str(caught.value)


def test_samples_in_a_folder_of_frames_leave_its_kind(tmp_path):
    folder = frame_folder(tmp_path / "walk", ["0.pcd", "1.pcd"])
    imu_csv(folder / "imu.csv")

    assert recognize(folder) is RecordingKind.FRAMES


def test_samples_beside_a_recording_that_nobody_named_are_mentioned(tmp_path):
    cloud = tmp_path / "0.pcd"
    write_pcd(cloud, room_cloud())
    imu = imu_csv(tmp_path / "imu.csv")
    (tmp_path / "notes.csv").write_text("anything\n")

    [text] = unread_samples(Sources((cloud,)))

    assert f"--imu {imu}" in text
    assert unread_samples(Sources((cloud,), imu=imu)) == []
    assert unread_samples(Sources((cloud, imu))) == []
