"""Metadata files of Ouster sensors: all layouts of the firmware, and damaged ones."""

import json

import numpy as np
import pytest

from recon4.errors import ConfigError, CorruptFile
from recon4.model.finding_kinds import FindingKind
from recon4.recording.packets.family import Companion
from recon4.recording.packets.ouster.data_packets import ring_of_beams
from recon4.recording.packets.ouster.encode import encode_packets, metadata_json
from recon4.recording.packets.ouster.family import FAMILY as OUSTER
from recon4.recording.packets.ouster.metadata import read_metadata
from recon4.recording.packets.ouster.metadata_choice import choose, find_metadata
from tests.ouster_models import nominal_metadata
from tests.unit.recording.ouster_packets import companion, datagrams_of
from tests.unit.recording.packet_builders import sensor
from tests.unit.recording.test_ouster_packets import turn_of

FILES = {
    "metadata/1_12_os1-991913000010-64.json": ("OS1-64", "LEGACY", 64, 1024, 15.806, True),
    "metadata/1_12_os1-991937000062-64_legacy.json": ("OS1-64", "LEGACY", 64, 1024, 15.806, True),
    "metadata/1_13_os1-991937000062-16A0_legacy.json": ("OS1-16", "LEGACY", 64, 1024, 15.806, True),
    "metadata/1_14_6cccd_os-882002000138-128_legacy.json": (
        "OS0-128", "LEGACY", 128, 1024, 27.67, True,
    ),
    "metadata/2_0_0_os1-991913000010-64.json": ("OS1-64", "LEGACY", 64, 1024, 12.163, False),
    "metadata/2_0_0_os1-992008000494-128_col_win_legacy.json": (
        "OS1-128", "LEGACY", 128, 2048, 15.806, False,
    ),
    "metadata/2_2_os-992119000444-128.json": ("OS1-128", "LEGACY", 128, 1024, 15.806, False),
    "metadata/2_2_os-992119000444-128_legacy.json": ("OS1-128", "LEGACY", 128, 1024, 15.806, False),
    "metadata/2_4_0_os-992146000760-128.json": (
        "OS1-128", "RNG19_RFL8_SIG16_NIR16", 128, 1024, 15.806, False,
    ),
    "metadata/3_0_1_os-122246000293-128.json": (
        "OS1-128", "RNG19_RFL8_SIG16_NIR16_DUAL", 128, 1024, 16.721, False,
    ),
    "OS-1-64_sensor_config_reduced.json": ("OS1-64", "LEGACY", 64, 1024, 12.163, True),
    "imu_zm_no_lidar_0.json": (
        "OS0-128", "RNG19_RFL8_SIG16_NIR16_ZONE16", 128, 2048, 27.116, False,
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", FILES)
def test_every_layout_of_the_firmware_is_read(data, name):
    found = read_metadata(companion(data("packets/ouster") / name))

    model, profile, beams, columns, origin_mm, assumed = FILES[name]
    assert (found.model, found.layout.profile.name) == (model, profile)
    assert (found.layout.beams, found.columns_per_turn) == (beams, columns)
    assert 1e3 * found.p_lidar_beam_m[0] == pytest.approx(origin_mm)
    assert ("lidar_origin_to_beam_origin_mm" in found.assumed) == assumed
    assert found.T_sensor_lidar[2, 3] == pytest.approx(0.0375, abs=0.002)


def test_the_two_layouts_of_one_sensor_give_the_same_points(data):
    folder = data("packets/ouster/metadata")
    nested = read_metadata(companion(folder / "2_2_os-992119000444-128.json"))
    flat = read_metadata(companion(folder / "2_2_os-992119000444-128_legacy.json"))

    assert nested.same_geometry(flat)
    assert (nested.serial, nested.init_id) == (flat.serial, flat.init_id)


def test_silent_beams_of_an_os1_16_take_no_ring(data):
    folder = data("packets/ouster/metadata")
    found = read_metadata(companion(folder / "1_13_os1-991937000062-16A0_legacy.json"))

    rings = ring_of_beams(found)

    firing = found.elevation_rad != 0
    assert firing.sum() == 16
    assert len(set(rings[firing].tolist())) == 16
    assert rings.max() == 16


def test_metadata_that_is_written_is_read_back():
    for model in ("OS0-32", "OS1-128", "OS2-64", "OSDome-128"):
        for profile in ("LEGACY", "FUSA_RNG15_RFL8_NIR8_DUAL"):
            written = nominal_metadata(model, profile=profile, columns_per_turn=512)

            found = read_metadata(Companion("a.json", metadata_json(written)))

            assert (found.model, found.serial, found.assumed) == (model, written.serial, ())
            assert found.layout == written.layout
            for name in ("elevation_rad", "azimuth_rad", "p_lidar_beam_m", "T_sensor_lidar"):
                np.testing.assert_allclose(getattr(found, name), getattr(written, name), atol=1e-7)


def test_unknown_models_are_refused_with_those_that_are_known():
    with pytest.raises(ConfigError, match=r"no Ouster 'OS3-32'.*OS0-32.*OSDome-128"):
        nominal_metadata("OS3-32")


def _changed(*path_and_value):
    *path, value = path_and_value
    document = json.loads(metadata_json(nominal_metadata("OS1-32")))
    place = document
    for key in path[:-1]:
        place = place[key]
    place[path[-1]] = value
    return Companion("os.json", json.dumps(document).encode())


@pytest.mark.parametrize(
    ("change", "text"),
    [
        (("beam_intrinsics", "beam_altitude_angles", []), "expected 1 to 256 numbers, got 0"),
        (("beam_intrinsics", "beam_altitude_angles", "x"), "expected 1 to 256 numbers, got 0"),
        (("beam_intrinsics", "beam_altitude_angles", [[1.0]] * 32), "32 numbers of at most 180"),
        (("beam_intrinsics", "beam_azimuth_angles", [1.0] * 31), "32 numbers of at most 180"),
        (("beam_intrinsics", "beam_azimuth_angles", [1e9] * 32), "32 numbers of at most 180"),
        (("beam_intrinsics", "beam_azimuth_angles", None), "expected 32 numbers, got none"),
        (("lidar_intrinsics", "lidar_to_sensor_transform", [0] * 16), "are no rotation"),
        (("lidar_intrinsics", "lidar_to_sensor_transform", [1] * 15), "expected 16 numbers"),
        (("lidar_data_format", "columns_per_packet", 0), "a whole number from 1 to 4096, got '0'"),
        (("lidar_data_format", "columns_per_packet", 4096), "do not fit into a packet"),
        (("lidar_data_format", "columns_per_frame", 10**30), "a whole number from 1 to 4096"),
        (("lidar_data_format", "pixels_per_column", 64), "32 angles of beams, but 64 pixels"),
        (("lidar_data_format", "udp_profile_lidar", "NEW"), "'NEW' is not known; decoded: LEGACY"),
        (("sensor_info", "initialization_id", "x"), "initialization_id: expected a whole number"),
    ],
)
def test_damaged_metadata_says_what_was_expected(change, text):
    with pytest.raises(CorruptFile, match=text):
        read_metadata(_changed(*change))


@pytest.mark.parametrize(
    "content",
    [
        b'{"beam_altitude_angles": ',
        b'["beam_altitude_angles"]',
        b'{"beam_altitude_angles": [NaN]}',
        b"[" * 100_000 + b'"beam_altitude_angles"',
        b'{"beam_altitude_angles": [1e999], "beam_azimuth_angles": [1]}',
        b'\xff\xfe{"beam_altitude_angles": 1}',
    ],
)
def test_text_that_is_no_metadata_is_damaged(content):
    with pytest.raises(CorruptFile):
        read_metadata(Companion("os.json", content))


def test_files_of_other_things_are_passed_over():
    assert read_metadata(Companion("a.csv", b"laser,elevation\n1,2\n")) is None
    assert not OUSTER.describes(Companion("a.csv", b"laser,elevation\n1,2\n"))
    assert OUSTER.describes(Companion("a.json", metadata_json(nominal_metadata("OS1-32"))))


def _head(metadata):
    return datagrams_of(encode_packets(metadata, turn_of(metadata, 4)))


def _named(name, metadata, likeness=0):
    return Companion(name, metadata_json(metadata), likeness)


def test_the_serial_number_in_the_packets_chooses_the_file():
    one, other = nominal_metadata("OS1-32", serial="111"), nominal_metadata("OS0-32", serial="222")
    found = find_metadata([_named("a.json", one, 5), _named("b.json", other)])

    assert choose(_head(other), found).metadata.name == "b.json"
    assert choose(_head(one), found).doubts == ()


def test_a_file_of_another_serial_number_is_named():
    one, other = nominal_metadata("OS1-32", serial="111"), nominal_metadata("OS0-32", serial="222")

    fit = choose(_head(other), find_metadata([_named("a.json", one)]))

    (doubt,) = fit.doubts
    assert doubt.kind is FindingKind.METADATA_ELSEWHERE
    assert doubt.values == {"name": "a.json", "serial": "111", "packets": "222"}


def test_without_serial_numbers_names_decide_or_nobody():
    one, other = (nominal_metadata(name, profile="LEGACY") for name in ("OS1-32", "OS0-32"))
    head = _head(one)

    with pytest.raises(ConfigError, match=r"several metadata files: a\.json, b\.json; leave"):
        choose(head, find_metadata([_named("a.json", one), _named("b.json", other)]))
    alike = choose(head, find_metadata([_named("a.json", one), _named("b.json", other, 3)]))
    by_address = choose(
        head, find_metadata([_named("os_10.0.0.1.json", one), _named("b.json", other, 3)])
    )
    neighbor = choose(
        head, find_metadata([_named("os_10.0.0.12.json", one), _named("b.json", other, 3)])
    )
    assert (neighbor.metadata.name, neighbor.passed_over) == ("b.json", "os_10.0.0.12.json")
    assert (alike.metadata.name, alike.passed_over) == ("b.json", "a.json")
    assert (by_address.metadata.name, by_address.passed_over) == ("os_10.0.0.1.json", "")
    same = choose(head, find_metadata([_named("a.json", one), _named("c.json", one)]))
    assert (same.metadata.name, same.passed_over) == ("a.json", "")


def test_the_topic_of_the_packets_is_most_like_that_of_their_metadata():
    one, other = (nominal_metadata(name, profile="LEGACY") for name in ("OS1-32", "OS0-32"))
    head = datagrams_of(encode_packets(one, turn_of(one, 4)), port=0, source=0)
    found = find_metadata([_named("/os_left/metadata", one), _named("/os_right/metadata", other)])

    for side in ("left", "right"):
        fit = choose(head, found, sensor("x", topic=f"/os_{side}/lidar_packets"))
        assert fit.metadata.name == f"/os_{side}/metadata"
