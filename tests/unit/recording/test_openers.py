"""A kind of recording is a row of a table: its openers are asked in order."""

import pytest

from recon4.errors import UnknownFormat
from recon4.model.rig import load_rig
from recon4.recording.assembly.shots import Shots
from recon4.recording.kinds import PLANAR, RecordingKind
from recon4.recording.open import KINDS, KindRow, open_recording
from recon4.recording.openers.captures import open_lidar_capture
from recon4.recording.openers.request import OpenRequest, Recording
from recon4.recording.report import ImportReport
from recon4.settings import IngestSettings


def request(path):
    return OpenRequest((path,), None, IngestSettings(), ImportReport())


def open_other_family(given):
    """As the opener of a sensor family whose packets say 'other' would."""
    if b"other" not in given.paths[0].read_bytes():
        return None
    return Recording(load_rig("4recon"), lambda: iter(()), kind="packets of another family")


def with_family(*openers):
    return {**KINDS, RecordingKind.PCAP: KindRow(openers)}


def test_a_sensor_family_is_added_by_one_opener_in_one_row(tmp_path, pcap):
    other = tmp_path / "other.pcap"
    other.write_bytes(pcap.read_bytes()[:24] + b"other")
    kinds = with_family(open_other_family, open_lidar_capture)

    assert open_recording(request(other), kinds).kind == "packets of another family"
    velodyne = open_recording(request(pcap), kinds)
    assert velodyne.kind == RecordingKind.PCAP
    assert sum(len(item) for item in velodyne.read() if isinstance(item, Shots)) > 0


def test_contents_that_no_opener_takes_are_refused_with_their_kind(pcap):
    with pytest.raises(
        UnknownFormat, match=r"packets of LiDARs .pcap.: no reader knows the sensor"
    ):
        open_recording(request(pcap), with_family(open_other_family))


def test_every_kind_is_opened_or_refused_with_what_it_is():
    alone = {
        *(RecordingKind.IMU_CSV, RecordingKind.GNSS_FILE, RecordingKind.POSES),
        RecordingKind.LIDAR_FILE,
    }

    assert {*KINDS, *PLANAR, *alone} == set(RecordingKind)
    assert all(row.openers for row in KINDS.values())
