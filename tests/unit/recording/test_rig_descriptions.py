"""Files beside a rig file describe its LiDARs: a live capture has no recording to lie beside."""

import json
from dataclasses import replace

import numpy as np
import pytest

from recon4.geometry.se3 import SE3
from recon4.model.imu_mounts import imu_mount
from recon4.model.lidars import lidar_model
from recon4.model.rig import format_rig, load_rig, parse_rig
from recon4.recording.packets.companions import described_in, with_descriptions
from recon4.recording.packets.families import FAMILIES
from recon4.recording.packets.ouster.encode import metadata_json
from recon4.recording.recipes.given_rig import rig_given
from recon4.recording.sources import Sources
from tests.ouster_models import nominal_metadata
from tests.unit.recording.hesai_mirrors import mirror_table

METADATA = metadata_json(nominal_metadata("OS0-32", profile="LEGACY")).decode()
FILES = {
    "OS0-32": ("sensor.json", METADATA),
    "XT32": (
        "correction.csv",
        "Channel,Elevation,Azimuth\n" + "".join(f"{k + 1},{15 - k}.1,0.2\n" for k in range(32)),
    ),
    "Airy": ("angles.csv", "".join(f"{e:.2f},0.10\n" for e in np.linspace(0.5, 89.5, 96))),
}


def rig_of(*sensors):
    rows = [
        f'[[sensor]]\nname = "{name}"\nmodel = "{model}"\naddress = "10.0.0.{k}"'
        for k, (name, model) in enumerate(sensors)
    ]
    return parse_rig("\n".join(['name = "r"', *rows]), where="rig.toml")


def by_library(recording, rig):
    return Sources.of(recording, rig=rig).rig


def by_command(recording, rig):
    return rig_given([recording], str(rig), "")


@pytest.mark.parametrize("model", FILES)
def test_a_file_beside_the_rig_file_describes_the_only_lidar_of_its_family(tmp_path, model):
    name, content = FILES[model]
    (tmp_path / name).write_text(content)
    (tmp_path / "notes.json").write_text("{}")

    rig, used = with_descriptions(
        rig_of(("front", model), ("top", "VLP-16")), sorted(tmp_path.iterdir())
    )

    assert used == {"front": name}
    assert [one.description for one in rig.sensors] == [content, ""]
    (kept,) = described_in(parse_rig(format_rig(rig), where="rig.toml"))
    (family,) = (one for one in FAMILIES if one.name == lidar_model(model).maker)
    assert family.describes(kept)


@pytest.mark.parametrize("read", [by_library, by_command])
def test_a_recording_elsewhere_is_read_with_the_files_beside_the_rig_file(tmp_path, read):
    name, content = FILES["OS0-32"]
    rigs, walks = tmp_path / "rigs", tmp_path / "walks"
    rigs.mkdir()
    (rigs / name).write_text(content)
    (rigs / "rig.toml").write_text(format_rig(rig_of(("front", "OS0-32"))))

    assert read(walks / "walk.pcap", rigs / "rig.toml").sensors[0].description == content
    assert read(walks / "walk.pcap", "4recon").name == "4RECON"


def test_of_two_lidars_of_a_family_the_names_of_the_files_decide(tmp_path):
    for name in ("left_1.json", "right_1.json", "spare.json"):
        (tmp_path / name).write_text(json.dumps(json.loads(METADATA) | {"prod_sn": name}))
    rig = rig_of(("left", "OS0-32"), ("right", "OS0-32"))

    _, used = with_descriptions(rig, sorted(tmp_path.iterdir()))
    _, unnamed = with_descriptions(rig, [tmp_path / "spare.json"])

    assert used == {"left": "left_1.json", "right": "right_1.json"}
    assert unnamed == {}


def test_two_binary_tables_of_angles_stay_byte_for_byte_in_a_rig_file_that_is_read(tmp_path):
    table = mirror_table().content
    for name in ("left.dat", "right.dat"):
        (tmp_path / name).write_bytes(table)
    rig = rig_of(("left", "AT128"), ("right", "AT128"))

    described, used = with_descriptions(rig, sorted(tmp_path.iterdir()))

    assert used == {"left": "left.dat", "right": "right.dat"}
    (tmp_path / "rig.toml").write_text(format_rig(described))
    kept = described_in(load_rig(tmp_path / "rig.toml"))
    assert [one.content for one in kept] == [table, table]


def test_a_damaged_binary_table_describes_nothing():
    damaged = "data:application/octet-stream;base64,7v8BBYA"
    rig = rig_of(("left", "AT128"))
    (kept,) = described_in(replace(rig, sensors=(replace(rig.sensors[0], description=damaged),)))

    assert not any(family.describes(kept) for family in FAMILIES)


def test_a_description_in_the_rig_file_stays(tmp_path):
    name, content = FILES["Airy"]
    (tmp_path / name).write_text(content)
    rig, _ = with_descriptions(rig_of(("front", "Airy")), [tmp_path / name])
    (tmp_path / name).write_text(content.replace("0.10", "0.20"))

    again, used = with_descriptions(rig, [tmp_path / name])

    assert used == {} and again.sensors[0].description == content


def test_the_rig_turns_the_imu_of_a_lidar_whose_axes_are_not_those_of_the_points():
    text = format_rig(rig_of(("front", "Airy"))).split("[imu]")[0]
    text += '[imu]\nsensor = "front"\nrpy_deg = [180.0, 0.0, -90.0]\n'

    rig = parse_rig(text, where="rig.toml")
    again = parse_rig(format_rig(rig), where="rig.toml")

    assert again.imu_sensor == "front"
    expected = np.array([[0.0, -1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, -1.0]])
    np.testing.assert_allclose(rig.T_body_imu.R, expected, atol=1e-12)
    np.testing.assert_allclose(again.T_body_imu.R, expected, atol=1e-9)


@pytest.mark.parametrize("model", ["JT128", "Airy"])
def test_a_stated_mount_of_an_imu_counts_and_one_of_zeros_is_that_of_the_data_sheet(model):
    text = format_rig(rig_of(("front", model))).split("[imu]")[0].replace("0.0, 1.0]", "1.0, 0.0]")
    text += '[imu]\nsensor = "front"\nrpy_deg = [0.0, 0.0, 0.0]\n'

    nowhere = parse_rig(text, where="rig.toml")
    stated = parse_rig(text.replace("[0.0, 0.0, 0.0]\n", "[0.0, 1.0, 0.0]\n"), where="rig.toml")
    again = parse_rig(format_rig(stated), where="rig.toml")

    holder = nowhere.sensors[0]
    np.testing.assert_allclose(nowhere.T_body_imu.R, imu_mount(holder).R, atol=1e-12)
    assert "xyz_m" not in format_rig(nowhere).split("[imu]")[1].split("[gnss]")[0]
    np.testing.assert_allclose(
        again.T_body_imu.R, SE3.from_rpy(0, np.deg2rad(1), 0, t=np.zeros(3)).R, atol=1e-9
    )
