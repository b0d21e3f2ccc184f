"""Status files of MANDEYE devices: models of LiDARs, written and read."""

import json

import pytest

from recon4.recording.mandeye.folder import list_walk
from recon4.recording.mandeye.read import walk_streams
from recon4.recording.report import ImportReport
from recon4.recording.rigs.choice import Stream, rig_to_complete
from tests.unit.recording.test_mandeye import write_walk
from tests.warned import derivations

DEVICE = {
    "name": "Mandeye",
    "version": "v0.8",
    "hardware": "mandeye-pro",
    "state": "SCANNING",
    "livox": {
        "is_synced": False,
        "LivoxLidarInfo": {"dev_type": 7, "lidar_ip": "192.168.1.3", "sn": "47MDL1"},
        "multi": {
            "LivoxLidarInfo": [
                {"dev_type": 7, "lidar_ip": "192.168.1.3", "sn": "47MDL1"},
                {"dev_type": 15, "lidar_ip": "192.168.1.4", "sn": "47MDL2"},
            ],
            "sn": ["47MDL1", "47MDL2"],
        },
    },
}
"""Status of a device, with the keys of its program."""


@pytest.fixture
def copy(tmp_path):
    write_walk(tmp_path / "walk", seconds=1.0)
    return tmp_path / "walk"


def stated(folder, state):
    for path in folder.glob("status*.json"):
        path.unlink()
    text = state if isinstance(state, str) else json.dumps(state)
    (folder / "status0000.json").write_text(text, "utf-8")
    report = ImportReport()
    return [stream.model for stream in walk_streams(list_walk(folder, report))], report


def test_models_are_those_that_the_device_states(copy):
    models, report = stated(copy, DEVICE)

    assert models == ["Avia", "HAP"]  # which nothing but the status says
    assert "Recorded by Mandeye v0.8 mandeye-pro." in derivations(report)
    assert any("no common source of time" in text for text in derivations(report))


def test_the_model_of_any_make_is_written_and_read_again(tmp_path):
    rig = rig_to_complete([Stream("a", "XT32"), Stream("b", "generic")])
    write_walk(tmp_path / "walk", rig, seconds=1.0)
    report = ImportReport()
    models = [stream.model for stream in walk_streams(list_walk(tmp_path / "walk", report))]

    assert models == ["XT32", "Mid-360"]  # a generic one is known by its view
    assert "Recorded by recon4." in derivations(report)


@pytest.mark.parametrize(
    "state",
    [
        {"livox": {"LivoxLidarInfo": {"dev_type": "null", "sn": "null"}}},
        {"livox": None, "lidar": [], "name": 7},
        {"livox": {"multi": {"LivoxLidarInfo": [{"dev_type": True, "sn": "47MDL1"}, 5]}}},
        {"livox": {"multi": {"LivoxLidarInfo": [{"dev_type": 99, "sn": "47MDL1"}]}}},
    ],
)
def test_a_status_that_states_no_model_leaves_it_to_the_view(state, copy):
    models, report = stated(copy, state)

    assert models == ["Mid-360", "Mid-360"]
    assert not report.counts["status_files_damaged"]


@pytest.mark.parametrize("text", ["", "[]", '{"livox": ', "[" * 5000])
def test_a_damaged_status_is_counted_and_the_walk_is_read(text, copy):
    models, report = stated(copy, text)

    assert models == ["Mid-360", "Mid-360"]
    assert report.counts["status_files_damaged"] == 1 and report.outcome != "lossy"
