"""Samples that came as datagrams, on the clock of the points."""

from functools import reduce
from operator import xor

import numpy as np
import pytest

from recon4.recording.report import ImportReport
from recon4.recording.samples.datagrams import SampleDecoder
from tests.warned import derivations

NOON_NS = 1_790_000_000_000_000_000 // 86_400_000_000_000 * 86_400_000_000_000 + 43_200 * 10**9
_GGA = b"GPGGA,120000.00,4912.0,N,01636.0,E,4,12,0.8,250.0,M,44.0,M,1.0,0001"
GGA = b"$%s*%02X\r\n" % (_GGA, reduce(xor, _GGA))
_NOWHERE = _GGA.replace(b"4912.0", b"9912.0")
NOWHERE = b"$%s*%02X\r\n" % (_NOWHERE, reduce(xor, _NOWHERE))
IMU = b'{"gx_rad_s": 0.1, "gy_rad_s": 0, "gz_rad_s": 0.5}\n'


def pushed(arrival_ns, *texts, utc_ahead_ns=0):
    report = ImportReport(utc_ahead_ns=utc_ahead_ns)
    return SampleDecoder(report).push([arrival_ns] * len(texts), list(texts)), report


def test_without_gps_the_time_of_arrival_counts():
    (imu, _), _ = pushed(NOON_NS, IMU)

    assert imu.t_ns.tolist() == [NOON_NS]


@pytest.mark.parametrize("wrong_s", [60, -3600])
def test_where_gps_drives_a_lidar_samples_are_on_utc_whatever_the_laptop_says(wrong_s):
    arrival_ns = NOON_NS + 50_000_000 + wrong_s * 10**9

    (imu, gnss), report = pushed(arrival_ns, IMU, GGA, utc_ahead_ns=-wrong_s * 10**9)

    assert imu.t_ns.tolist() == [NOON_NS + 50_000_000]
    assert gnss.t_ns.tolist() == [NOON_NS]
    assert gnss.quality.tolist() == [4]
    assert not derivations(report)


def test_an_absolute_time_is_left_alone():
    line = b'{"t_ns": 1790000000000000000, "lat_deg": 49.2, "lon_deg": 16.6}'

    (_, gnss), _ = pushed(NOON_NS, line, utc_ahead_ns=10**9)

    assert gnss.t_ns.tolist() == [1_790_000_000_000_000_000]
    np.testing.assert_allclose(np.rad2deg(gnss.lat_rad), 49.2)


def test_what_is_no_sample_is_counted():
    lines = b'{"lat_deg": 49.2}\n[1]\n{"gx_rad_s": 1, "gy_rad_s": 2, "gz_rad_s": NaN}\nhello\n'
    lines += b'{"lat_deg": 1e300, "lon_deg": 16.6}\n{"lat_deg": 49.2, "lon_deg": -361}\n'

    (imu, gnss), report = pushed(NOON_NS, lines, b"\xff\xfe", b"$GPGGA,broken*00\r\n", NOWHERE)

    assert imu is gnss is None
    assert report.counts["samples_damaged"] == 7
    assert report.counts["nmea_damaged"] == 2


def test_one_sample_with_an_absurd_time_does_not_block_those_after_it():
    report = ImportReport()
    arrival_ns = [NOON_NS + k * 10_000_000 for k in range(20)]
    stamps_ns = [t + (k == 7) * 10**17 for k, t in enumerate(arrival_ns)]
    texts = [b'{"t_ns": %d, %s' % (t, IMU[1:]) for t in stamps_ns]

    imu, _ = SampleDecoder(report).push(arrival_ns, texts)

    assert len(imu) == 19 and report.counts["samples_damaged"] == 1
    assert report.counts["samples_out_of_order"] == 0


def test_a_datagram_that_comes_twice_is_no_loss():
    """As of a network that doubles packets; an earlier sample, or another of that time, is one."""
    arrival_ns = [NOON_NS + k * 10_000_000 for k in range(6)]
    texts = [b'{"t_ns": %d, %s' % (t, IMU[1:]) for t in arrival_ns]
    other = texts[5].replace(b"0.1", b"0.7", 1)
    report = ImportReport()
    decoder = SampleDecoder(report)

    sent = [*texts[:3], texts[2], *texts[3:], texts[4], other]
    parts = [decoder.push([arrival_ns[-1]], [text])[0] for text in sent]

    assert sum(len(part) for part in parts if part is not None) == 6
    assert report.counts["imu_copies"] == 1
    assert report.counts["samples_out_of_order"] == 2


def test_a_fix_that_comes_twice_is_no_loss():
    (_, gnss), report = pushed(NOON_NS, GGA, GGA)

    assert len(gnss) == 1
    assert report.counts["gnss_copies"] == 1 and not report.lost()


@pytest.mark.parametrize("first", ["GGA", "RMC"])
def test_of_the_sentences_of_one_fix_the_one_with_the_height_is_used(first):
    """As receivers send them by default, also RMC before GGA."""
    decoder, heights_m = SampleDecoder(report := ImportReport()), []
    for second in range(5):
        time = b"1200%02d.00" % second
        rmc = b"GPRMC,%s,A,4912.0,N,01636.0,E,0.1,90.0,210926,,,R" % time
        bodies = [_GGA.replace(b"120000.00", time), rmc]
        for body in bodies if first == "GGA" else bodies[::-1]:
            text = b"$%s*%02X\r\n" % (body, reduce(xor, body))
            _, gnss = decoder.push([NOON_NS + second * 10**9 + 50_000_000], [text])
            heights_m += [] if gnss is None else gnss.height_m.tolist()

    without = np.flatnonzero(np.isnan(heights_m)).tolist()
    assert len(heights_m) == 5 and without == ([] if first == "GGA" else [0])
    assert not report.lost()
