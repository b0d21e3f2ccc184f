"""A first rig file of the sensors in a recording, and the rigs that are shipped for each make."""

from shutil import copy

import numpy as np
import pytest

from recon4.cli.main import main
from recon4.model.imu_mounts import imu_mount
from recon4.model.lidars import lidar_model
from recon4.model.rig import load_rig, parse_rig, rig_presets
from recon4.recording.info.describe import describe

TWO_LIDARS = "packets/ouster/same_ports_legacy.pcap"


def test_a_recording_of_two_lidars_gives_a_rig_to_complete(data):
    found = describe(data(TWO_LIDARS))

    rig = parse_rig(found.first_rig, where="first rig")
    assert [(s.name, s.model) for s in rig.sensors] == [("lidar0", "OS1-64"), ("lidar1", "OS0-128")]
    assert {s.address for s in rig.sensors} == {"169.254.238.111", "169.254.92.158"}
    assert rig.imu_sensor == "lidar0"
    assert "Measure xyz_m [m] and rpy_deg" in found.first_rig


def test_it_holds_the_description_beside_the_recording_for_a_live_capture(data, tmp_path):
    name = "OS-1-128_v2.3.0_1024x10"
    pcap = data(f"packets/ouster/{name}_lb_n3.pcap")
    for file in (pcap, *(pcap.with_name(f"{one}.json") for one in (name, "duplicate_id"))):
        copy(file, tmp_path)

    (lidar,) = parse_rig(describe(tmp_path / pcap.name).first_rig, where="first rig").sensors

    assert lidar.description == pcap.with_name(f"{name}.json").read_text()


def test_info_writes_it_to_a_new_file_only(data, tmp_path, capsys):
    out = tmp_path / "rig.toml"

    assert main(["info", str(data(TWO_LIDARS)), "--rig-out", str(out)]) == 0
    assert len(load_rig(out).sensors) == 2
    assert main(["info", str(data(TWO_LIDARS)), "--rig-out", str(out)]) == 1
    assert "exists" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("name", "models"),
    [
        ("mid360-handheld", ["Mid-360"]),
        ("two-mid360", ["Mid-360", "Mid-360"]),
        ("os0-backpack", ["OS0-128"]),
        ("os1-backpack", ["OS1-64"]),
        ("xt32-hilti", ["XT32"]),
        ("jt128-avia-backpack", ["JT128", "Avia"]),
        ("airy-handheld", ["Airy"]),
    ],
)
def test_a_rig_is_shipped_for_each_make(name, models):
    rig = load_rig(name)

    assert name in rig_presets()
    assert [sensor.model for sensor in rig.sensors] == models
    assert len({(sensor.address, sensor.port) for sensor in rig.sensors}) == len(models)
    holder = next((s for s in rig.sensors if s.name == rig.imu_sensor), None)
    if holder is not None:
        assert lidar_model(holder.model).has_imu
        np.testing.assert_array_equal(rig.T_body_imu.R, imu_mount(holder).R)
