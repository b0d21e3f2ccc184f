"""Made-up packets of Ouster sensors: written by the encoder and read back, damaged, foreign."""

from dataclasses import replace

import numpy as np
import pytest

from recon4.kernels.ouster import CHECKSUM_TABLES
from recon4.recording.packets.family import Companion
from recon4.recording.packets.ouster.columns import column_step_ns, columns_of
from recon4.recording.packets.ouster.data_packets import checksums
from recon4.recording.packets.ouster.encode import (
    ColumnReturns,
    encode_packets,
    metadata_json,
)
from recon4.recording.packets.ouster.family import FAMILY as OUSTER
from recon4.recording.packets.ouster.layouts import PROFILES, PacketLayout
from recon4.recording.report import ImportReport
from recon4.settings import IngestSettings
from tests.ouster_models import beams_in_turn, nominal_metadata
from tests.unit.recording.ouster_packets import companion, datagrams_of, of_port, opened
from tests.warned import K, warned

T0_NS = 987_654_321_000
profiles = pytest.mark.parametrize("profile", PROFILES)


def turn_of(metadata, packets, *, first=0, t0_ns=T0_NS, seed=3):
    """Packets that follow each other from a column on, with returns in random distances."""
    columns, beams = metadata.layout.columns, metadata.layout.beams
    echoes = len(metadata.layout.profile.echoes)
    rng = np.random.default_rng(seed)
    place = first + np.arange(packets * columns).reshape(packets, columns)
    step_ns = round(1e9 / (metadata.columns_per_turn * metadata.rotation_hz))
    unit = metadata.layout.profile.unit_mm
    range_mm = unit * rng.integers(2000 // unit, 60_000 // unit, (echoes, packets, columns, beams))
    range_mm[:, rng.random((packets, columns, beams)) < 0.2] = 0
    intensity = rng.integers(1, 256, range_mm.shape)
    return ColumnReturns(
        t0_ns + step_ns * (place - first), place % metadata.columns_per_turn, range_mm, intensity
    )


def beside(metadata, name="os.json"):
    return Companion(name, metadata_json(metadata))


def decoded(metadata, returns, report=None):
    payloads = encode_packets(metadata, returns)
    packets = opened(datagrams_of(payloads), beside(metadata), report=report)
    sound = packets.sound(payloads)
    return packets.decode(packets.stamps_ns(payloads[sound]), payloads[sound]), sound


@profiles
def test_what_the_encoder_writes_is_read_back_to_the_unit(profile):
    metadata = nominal_metadata("OS1-32", profile=profile)
    returns = turn_of(metadata, 5, first=1000)
    shots, sound = decoded(metadata, returns)

    first = returns.range_mm[0]
    packet, column, beam = np.nonzero(first)
    number = returns.number[packet, column]
    origin, direction = beams_in_turn(metadata)
    wanted = (
        origin[number, beam] + 1e-3 * first[packet, column, beam, None] * direction[number, beam]
    )
    order = np.lexsort((31 - beam, returns.t_ns[packet, column]))
    found = np.full((len(wanted), 3), np.inf)
    for echo in (0, 1):
        rows = np.flatnonzero(shots.echo == echo)
        rows = rows[np.lexsort((shots.ring[rows], shots.t_ns[rows]))]
        if len(rows) != len(wanted):
            continue
        off = np.abs(shots.xyz[rows] - wanted[order]).max(axis=1)
        better = off < np.abs(found - wanted[order]).max(axis=1)
        found[better] = shots.xyz[rows][better]
        np.testing.assert_array_equal(shots.t_ns[rows], returns.t_ns[packet, column][order])
        np.testing.assert_array_equal(shots.ring[rows], 31 - beam[order])
    assert sound.all()
    assert np.abs(found - wanted[order]).max() < 1e-4


def test_the_stronger_of_two_returns_is_the_first_and_an_equal_one_is_dropped():
    metadata = nominal_metadata("OS0-32", profile="RNG19_RFL8_SIG16_NIR16_DUAL")
    returns = turn_of(metadata, 1)
    range_mm, intensity = np.zeros_like(returns.range_mm), np.zeros_like(returns.intensity)
    range_mm[:, 0, 0, 0], intensity[:, 0, 0, 0] = (5000, 9000), (10, 300)
    range_mm[:, 0, 0, 1], intensity[:, 0, 0, 1] = (5000, 5000), (10, 300)
    range_mm[:, 0, 0, 2], intensity[:, 0, 0, 2] = (0, 7000), (0, 60_000)

    shots, _ = decoded(metadata, replace_returns(returns, range_mm, intensity))

    assert shots.intensity.tolist() == [300, 10, 300, 60_000]
    assert shots.echo.tolist() == [0, 1, 0, 0]
    assert shots.ring.tolist() == [31, 31, 30, 29]


def replace_returns(returns, range_mm, intensity):
    return ColumnReturns(returns.t_ns, returns.number, range_mm, intensity)


def test_ranges_outside_of_the_limits_are_counted():
    metadata = nominal_metadata("OS1-32")
    returns = turn_of(metadata, 1)
    range_mm = np.zeros_like(returns.range_mm)
    range_mm[0, 0, 0, :4] = 500, 800, 900_000 // 2, 30_000
    payloads = encode_packets(metadata, replace_returns(returns, range_mm, returns.intensity))
    report = ImportReport()
    settings = IngestSettings(min_range_m=0.7, max_range_m=120.0)
    packets = opened(datagrams_of(payloads), beside(metadata), settings=settings, report=report)

    shots = packets.decode(packets.stamps_ns(payloads), payloads)

    assert len(shots) == report.counts["points"] == 2
    assert (report.counts["points_near"], report.counts["points_far"]) == (1, 1)
    assert report.counts["points_no_return"] == 16 * 32 - 4


def test_columns_that_were_not_measured_are_left_out():
    metadata = nominal_metadata("OS1-32")
    returns = turn_of(metadata, 3)
    payloads = encode_packets(metadata, returns)
    records = metadata.layout.records(payloads)
    records["columns"]["status"][0, :5] = 0
    records["columns"]["status"][1] = 0
    records["crc"] = 0
    report = ImportReport()
    packets = opened(datagrams_of(payloads), beside(metadata), report=report)

    sound = packets.sound(payloads)
    shots = packets.decode(packets.stamps_ns(payloads[sound]), payloads[sound])

    assert sound.tolist() == [True, False, True]
    assert report.counts["packets_without_columns"] == 1
    assert packets.stamps_ns(payloads)[0] == returns.t_ns[0, 5]
    measured = returns.t_ns[[0] * 11 + [2] * 16, [*range(5, 16), *range(16)]]
    assert set(shots.t_ns.tolist()) == set(measured.tolist())


@pytest.mark.parametrize(
    ("damage", "count"),
    [
        (lambda r: r["header"]["type"].__setitem__(2, 3), "packets_wrong_header"),
        (lambda r: r["header"]["serial"].__setitem__((2, 0), 99), "packets_of_another_sensor"),
        (lambda r: r["columns"]["pixels"].__setitem__((2, 4, 7), 77), "packets_wrong_crc"),
        (lambda r: r["columns"]["number"].__setitem__((2, 4), 77), "packets_wrong_columns"),
        (lambda r: r["columns"]["number"].__setitem__(2, 2000), "packets_wrong_columns"),
        (lambda r: r["columns"]["stamp_ns"].__setitem__((2, 4), 7), "packets_wrong_stamp"),
        (lambda r: r["columns"]["stamp_ns"].__setitem__(2, 1 << 63), "packets_wrong_stamp"),
    ],
)
def test_damaged_packets_are_dropped_with_the_reason(damage, count):
    metadata = nominal_metadata("OS1-32")
    payloads = encode_packets(metadata, turn_of(metadata, 6))
    records = metadata.layout.records(payloads)
    damage(records)
    if count != "packets_wrong_crc":
        records["crc"] = checksums(payloads)
    report = ImportReport()
    packets = opened(datagrams_of(payloads), beside(metadata), report=report)

    sound = packets.sound(payloads)

    assert sound.tolist() == [True, True, False, True, True, True]
    assert {name for name in report.counts if name.startswith("packets_")} == {count}


def test_sums_are_not_checked_where_older_firmware_sends_none():
    metadata = nominal_metadata("OS1-32")
    payloads = encode_packets(metadata, turn_of(metadata, 6))
    payloads[:, -8:] = np.frombuffer(b"\x00\x00\x00\x00\xef\xbe\xad\xde", dtype=np.uint8)
    report = ImportReport()

    assert opened(datagrams_of(payloads), beside(metadata), report=report).sound(payloads).all()


def test_the_sum_is_that_of_real_packets(data):
    head = of_port(data("packets/ouster/imu_zm_no_lidar.pcap"), 7513)
    payloads = head.payloads(np.arange(len(head)), 452)
    stated = np.ascontiguousarray(payloads[:, -8:]).view("<u8")[:, 0]

    np.testing.assert_array_equal(checksums(payloads), stated)


def test_the_sum_of_a_packet_does_not_depend_on_those_beside_it():
    packets = np.random.default_rng(5).integers(0, 256, (7, 61), dtype=np.uint8)
    alone = [checksums(packet[None])[0] for packet in packets]

    for count in range(len(packets) + 1):
        assert checksums(packets[:count]).tolist() == alone[:count]


@pytest.mark.parametrize("size", [8, 15, 967, 968, 969, 1937, 8456])
def test_the_sum_of_long_packets_is_that_of_each_byte_in_turn(size):
    packets = np.random.default_rng(size).integers(0, 256, (6, size + 8), dtype=np.uint8)
    table = CHECKSUM_TABLES[0]

    total = np.full(len(packets), 2**64 - 1, np.uint64)
    for byte in packets[:, :size].T:
        total = total >> np.uint64(8) ^ table[(total ^ byte) & np.uint64(0xFF)]

    np.testing.assert_array_equal(checksums(packets), ~total)


def test_of_two_sensors_behind_one_address_the_one_of_the_rig_is_read():
    one, other = (nominal_metadata("OS1-32", serial=serial) for serial in ("111", "222"))
    payloads = np.concatenate(
        [encode_packets(one, turn_of(one, 4)), encode_packets(other, turn_of(other, 3))]
    )
    companions = beside(one, "a.json"), beside(other, "b.json")
    report = ImportReport()

    usual = opened(datagrams_of(payloads), *companions, report=report).sound(payloads)
    named = opened(datagrams_of(payloads), *companions, serial="222").sound(payloads)

    assert usual.tolist() == [True] * 4 + [False] * 3
    assert named.tolist() == [False] * 4 + [True] * 3
    assert report.counts["packets_of_another_sensor"] == 3
    assert warned(report, K.PACKETS_MIXED, others="222", read="111")


def test_a_mode_that_was_changed_after_the_metadata_was_stored_is_seen():
    stored = nominal_metadata("OS1-32", columns_per_turn=2048)
    sent = replace(stored, columns_per_turn=512)
    returns = turn_of(sent, 20, first=300)
    payloads = encode_packets(sent, returns)
    report = ImportReport()
    packets = opened(datagrams_of(payloads), beside(stored), report=report)

    turned = packets.azimuth_cdeg(payloads)

    assert packets.packet_s == pytest.approx(16 / 512 / 10, rel=1e-3)
    np.testing.assert_array_equal(turned, (36000 * returns.number[:, 0] // 512 - 18000) % 36000)
    assert warned(report, K.METADATA_COLUMNS, stated=2048, columns=512)


def test_every_size_of_packets_is_recognized_without_metadata():
    for profile in PROFILES:
        metadata = nominal_metadata("OS0-64", profile=profile)
        head = datagrams_of(encode_packets(metadata, turn_of(metadata, 4)))

        found = OUSTER.recognize(head, ())

        assert (found.kind, found.model, found.size) == ("data", "Ouster", metadata.layout.size)
        assert [one.kind for one in found.findings] == [K.METADATA_NEEDED]


def test_an_even_motor_is_not_needed_for_the_step_of_columns():
    metadata = nominal_metadata("OS1-32")
    returns = turn_of(metadata, 8)
    uneven = returns.t_ns + np.where(np.arange(16) % 2, 3000, 0)
    payloads = encode_packets(
        metadata, ColumnReturns(uneven, returns.number, returns.range_mm, returns.intensity)
    )

    step_ns = column_step_ns(columns_of(metadata.layout, payloads))

    assert step_ns == pytest.approx(97_656 + 3000 / 15, abs=1)


def test_noise_of_the_sizes_of_packets_is_not_recognized():
    rng = np.random.default_rng(5)
    sizes = {PacketLayout(p, b).size for p in PROFILES.values() for b in (32, 128)} | {48, 452, 680}
    for size in sizes:
        noise = rng.integers(0, 256, (40, size), dtype=np.uint8)
        zeros = np.zeros((40, size), dtype=np.uint8)

        assert OUSTER.recognize(datagrams_of(noise), ()) is None
        assert OUSTER.recognize(datagrams_of(zeros), ()) is None


def test_packets_of_others_are_not_recognized(data):
    root = data("packets")
    for name, port in (
        ("veloview/vlp-16-test-90deg-1-50-frames.pcap", 2368),
        ("mrpt/sample_velodyne_hdl32.pcap", 2368),
        ("mrpt/sample_velodyne_vlp16_gps.pcap", 8308),
    ):
        head = of_port(root / name, port)
        beside_it = companion(root / "ouster" / "OS-1-128_v2.3.0_1024x10.json")
        assert len(head) > 0
        assert OUSTER.recognize(head, [beside_it]) is None
