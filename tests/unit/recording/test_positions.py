"""Position packets: sentences to positions, words to inertial samples."""

import numpy as np
import pytest

from recon4.model.samples import GnssQuality
from recon4.recording.packets.sensor_clock import SensorClock
from recon4.recording.packets.velodyne.encode import encode_position, rmc_sentence
from recon4.recording.packets.velodyne.position_packets import (
    PositionDecoder,
    parse_fix,
    utc_offset_ns,
)
from recon4.recording.report import ImportReport
from tests.unit.recording.packet_builders import T0_NS, sensor
from tests.warned import derivations

GGA = "GPGGA,221320.50,4912.0000,N,01636.0000,E,4,12,0.8,250.000,M,44.500,M,1.0,0000"


def packet(t_ns, nmea=""):
    return encode_position(t_ns // 1000, nmea)


def decoder(report=None, *, utc_offset_ns=None):
    report = report or ImportReport()
    clock = SensorClock("lidar", packet_s=1e-3, report=report, utc_offset_ns=utc_offset_ns)
    return PositionDecoder(sensor(), clock=clock, report=report)


def with_words(payload, words):
    payload[14:38] = np.array(words, dtype="<u2").view(np.uint8)
    return payload


def test_an_rmc_sentence_gives_time_and_place():
    payload = packet(T0_NS + 300_000_000, rmc_sentence(T0_NS, lat_deg=-49.2, lon_deg=-16.6125))
    t_arrival = np.array([T0_NS + 300_200_000])

    gnss = decoder(utc_offset_ns=-200_000).push(t_arrival, payload[None]).gnss

    assert gnss.t_ns.tolist() == [T0_NS]
    assert np.rad2deg(gnss.lat_rad) == pytest.approx([-49.2], abs=1e-9)
    assert np.rad2deg(gnss.lon_rad) == pytest.approx([-16.6125], abs=1e-7)
    assert np.isnan(gnss.height_m).all()
    assert gnss.quality.tolist() == [GnssQuality.SINGLE]


def test_a_gga_sentence_gives_the_ellipsoidal_height_and_the_kind_of_fix():
    payload = packet(T0_NS + 700_000_000, GGA)

    gnss = decoder(utc_offset_ns=0).push(np.array([T0_NS + 700_000_000]), payload[None]).gnss

    assert gnss.t_ns.tolist() == [T0_NS + 500_000_000]
    assert gnss.height_m == pytest.approx([294.5])
    assert gnss.quality.tolist() == [GnssQuality.RTK_FIXED]


def test_a_repeated_sentence_is_one_sample():
    t_ns = T0_NS + 5_000_000 * np.arange(500)
    payloads = [
        packet(t, rmc_sentence(t // 10**9 * 10**9, lat_deg=49.2, lon_deg=16.6))
        for t in t_ns.tolist()
    ]
    report = ImportReport()
    positions = decoder(report, utc_offset_ns=0)

    parts = [
        positions.push(t_ns[k : k + 90], np.stack(payloads[k : k + 90])) for k in range(0, 500, 90)
    ]

    times = np.concatenate([part.gnss.t_ns for part in parts if part.gnss])
    assert times.tolist() == [T0_NS, T0_NS + 10**9, T0_NS + 2 * 10**9]
    assert report.counts == {"positions": 500, "gnss_samples": 3}


@pytest.mark.parametrize(
    ("damage", "counter"),
    [
        (lambda text: text.replace("4912", "4913"), "nmea_damaged"),
        (lambda text: text[:30], "nmea_damaged"),
        (lambda text: "$GPXXX," + text[7:], "nmea_damaged"),
    ],
)
def test_a_damaged_sentence_is_counted_and_left_out(damage, counter):
    payload = packet(T0_NS, rmc_sentence(T0_NS, lat_deg=49.2, lon_deg=16.6))
    text = bytes(payload[206:]).split(b"\r")[0].decode()
    report = ImportReport()

    fix = parse_fix(damage(text).encode(), T0_NS, report)

    assert fix is None
    assert report.counts == {counter: 1}


def test_a_receiver_without_a_fix_gives_no_position():
    void = rmc_sentence(T0_NS, lat_deg=0, lon_deg=0, valid=False)
    report = ImportReport()

    samples = decoder(report).push(np.array([T0_NS]), packet(T0_NS, void)[None])

    assert (samples.gnss, samples.imu) == (None, None)
    assert report.counts == {"positions": 1, "nmea_no_fix": 1}


def test_without_gps_on_the_clock_a_position_is_timed_by_its_packet():
    sentence = rmc_sentence(T0_NS + 86_400 * 10**9, lat_deg=49.2, lon_deg=16.6)
    report = ImportReport()

    gnss = decoder(report).push(np.array([T0_NS]), packet(T0_NS, sentence)[None]).gnss

    assert gnss.t_ns.tolist() == [T0_NS]
    assert any("GPS does not drive its clock" in text for text in derivations(report))


@pytest.mark.parametrize(
    ("age_ms", "hours", "expected"),
    [(300, 0, True), (1900, 0, True), (300, 3, True), (2600, 0, False), (-50, 0, False)],
)
def test_gps_drives_the_clock_if_the_stamp_follows_the_sentence(age_ms, hours, expected):
    stamp = T0_NS + age_ms * 1_000_000
    payload = packet(stamp, rmc_sentence(T0_NS, lat_deg=49.2, lon_deg=16.6))
    arrival = stamp + 1000 + hours * 3_600_000_000_000

    offset = utc_offset_ns(np.array([arrival]), payload[None])

    assert offset == ((stamp - arrival) if expected else None)


def test_the_words_of_an_hdl32e_become_turns_and_accelerations():
    g = 1 / 0.001221
    words = [
        100, 0x1000, 0x2000 + round(g), 0x3000 + 41,
        4096 - 50, 0x1000, 0x2000 + round(g), 0x3000 + 4096 - 82,
        10, 0x1000, 0x2000 + 4096 - 41, 0x3000 + 4096 - 82,
    ]  # fmt: skip
    payload = with_words(packet(T0_NS), words)

    imu = decoder().push(np.array([T0_NS]), payload[None]).imu

    assert np.rad2deg(imu.gyro_rad_s[0]) == pytest.approx([9.766, -4.883, 0.9766])
    assert imu.accel_m_s2[0] == pytest.approx([82 * 0.011974, 41 * 0.011974, 9.807], abs=2e-3)


def test_inertial_samples_come_in_strict_order_whatever_the_packets_do():
    t_ns = T0_NS + 5_000_000 * np.array([0, 1, 3, 2, 3, 4])
    payloads = np.stack([with_words(packet(t), range(1, 13)) for t in t_ns.tolist()])
    report = ImportReport()
    positions = decoder(report)

    first = positions.push(t_ns, payloads).imu
    again = positions.push(t_ns[-1:], payloads[-1:]).imu

    assert ((first.t_ns - T0_NS) // 5_000_000).tolist() == [0, 1, 3, 4]
    assert again is None
    assert report.counts["positions_out_of_order"] == 1
    assert report.counts["positions_duplicate"] == 2


def test_single_damaged_stamps_are_counted_and_left_out():
    t_ns = T0_NS + 5_000_000 * np.arange(40)
    payloads = np.stack([with_words(packet(t), range(1, 13)) for t in t_ns.tolist()])
    payloads[[7, 20], 198:202] = 255
    report = ImportReport()

    imu = decoder(report).push(t_ns, payloads).imu

    assert len(imu) == 38
    assert report.counts["positions_wrong_time"] == 2
    assert report.counts["positions_out_of_order"] == 0


def test_one_damaged_stamp_does_not_take_gps_from_the_clock():
    t_ns = T0_NS + 1_000_000_000 * np.arange(5)
    texts = [rmc_sentence(t, lat_deg=49.2, lon_deg=16.6) for t in t_ns.tolist()]
    payloads = np.stack([packet(t, text) for t, text in zip(t_ns.tolist(), texts, strict=True)])
    payloads[0, 198:202] = (0, 0, 0, 1)

    assert utc_offset_ns(t_ns, payloads) == 0
