"""Livox packets of the own encoder, by the protocols of the maker, through the decoder and back."""

import gzip
import re
import sqlite3
from dataclasses import replace
from itertools import islice

import numpy as np
import pytest

from recon4.errors import ConfigError
from recon4.recording.formats.pcap import Datagrams, read_pcap
from recon4.recording.packets.family import PacketSensor
from recon4.recording.packets.livox.encode import ShotReturns, encode_imu, encode_points
from recon4.recording.packets.livox.family import FAMILY as LIVOX
from recon4.recording.packets.livox.models import LAYOUTS, MODELS
from recon4.recording.packets.livox.points import LivoxSource, decode_points
from recon4.recording.packets.livox.recognition import livox_of_points
from recon4.recording.packets.sensor_clock import SensorClock
from recon4.recording.report import ImportReport
from tests.unit.recording.packet_builders import T0_NS, WIDE, sensor
from tests.warned import derivations

NAMES = [f"SDK{layout.sdk} type {layout.data_type}" for layout in LAYOUTS]
MID360 = next(one for one in LAYOUTS if (one.sdk, one.data_type) == (2, 1))
AVIA = next(one for one in LAYOUTS if (one.sdk, one.data_type) == (1, 2))
DUAL = next(one for one in LAYOUTS if (one.sdk, one.data_type) == (1, 4))


def model_of(layout):
    if layout.sdk == 2:
        return MODELS["Mid-360"]
    return MODELS["Avia" if layout.data_type > 1 else "Mid-40"]


def datagrams(*groups, port=56301):
    """Datagrams of groups of payloads of one size, one group after the other."""
    length = np.concatenate([np.full(len(g), g.shape[1]) for g in groups])
    buffer = np.concatenate([*(g.ravel() for g in groups), np.zeros(2048, np.uint8)])
    count = len(length)
    return Datagrams(
        T0_NS + 1_000_000 * np.arange(count),
        np.full(count, 0xC0A80165, np.uint32),
        np.full(count, port, np.uint16),
        length.astype(np.int64),
        np.concatenate([[0], np.cumsum(length)[:-1]]).astype(np.int64),
        buffer,
    )


def walls(layout, packets, *, seed=0, view_deg=(30.0, 30.0)):
    """Returns in front of the sensor at 2 to 60 m; further ones of a shot lie behind the first."""
    rng = np.random.default_rng(seed)
    shape = packets, layout.shots
    azimuth, elevation = (np.deg2rad(rng.uniform(-limit, limit, shape)) for limit in view_deg)
    flat = np.cos(elevation)
    rays = np.stack([flat * np.cos(azimuth), flat * np.sin(azimuth), np.sin(elevation)], axis=-1)
    depth = rng.uniform(2.0, 60.0, shape)[..., None] + 3.0 * np.arange(layout.returns)
    xyz = rays[:, :, None] * depth[..., None]
    return ShotReturns(xyz, rng.integers(0, 256, xyz.shape[:3]))


def packets(layout, shots, *, time_type=1, t0_ns=T0_NS):
    step = round(1e9 * layout.shots * model_of(layout).shot_s)
    t_ns = t0_ns + step * np.arange(len(shots.xyz_m))
    return t_ns, encode_points(
        t_ns, shots, layout=layout, model=model_of(layout), time_type=time_type
    )


def opened(layout, head, *, report=None, model=None):
    device = sensor(model=model or model_of(layout).name)
    return LIVOX.open(
        PacketSensor(
            row=0,
            sensor=device,
            head=head,
            companions=(),
            settings=WIDE,
            report=report or ImportReport(),
        )
    )


@pytest.mark.parametrize("layout", LAYOUTS, ids=NAMES)
def test_points_come_back_to_a_unit_of_the_data_type(layout):
    shots = walls(layout, 20)
    t_ns, payloads = packets(layout, shots)
    report = ImportReport()
    device = opened(layout, datagrams(payloads), report=report)

    assert device.size == payloads.shape[1] == layout.size
    assert device.sound(payloads).all()
    np.testing.assert_array_equal(device.stamps_ns(payloads), t_ns)
    found = device.decode(device.stamps_ns(payloads), payloads)

    assert len(found) == shots.reflectivity.size == report.counts["points"]
    off_m = np.linalg.norm(found.xyz - shots.xyz_m.reshape(-1, 3), axis=1)
    angle_m = np.deg2rad(0.01) * 70.0 if layout.is_spherical else 0.0
    assert off_m.max() < layout.unit_m + angle_m
    np.testing.assert_array_equal(found.intensity, shots.reflectivity.ravel())
    np.testing.assert_array_equal(
        found.echo, np.tile(np.arange(layout.returns) > 0, len(found) // layout.returns)
    )


@pytest.mark.parametrize("layout", LAYOUTS, ids=NAMES)
def test_every_shot_has_its_own_time_and_line(layout):
    model = model_of(layout)
    t_ns, payloads = packets(layout, walls(layout, 3))
    found = opened(layout, datagrams(payloads)).decode(t_ns, payloads)

    shot = np.repeat(np.arange(layout.shots), layout.returns)
    expected = t_ns[:, None] + np.rint(shot * 1e9 / model.shots_hz).astype(np.int64)
    assert np.abs(found.t_ns - expected.ravel()).max() <= 50
    np.testing.assert_array_equal(found.ring, np.tile(shot % model.lines, 3))


def test_a_packet_of_sdk2_says_how_long_its_shots_take():
    t_ns, payloads = packets(MID360, walls(MID360, 1))
    payloads[0, 3:5] = np.array([9600], "<u2").view(np.uint8)  # twice the usual time
    found = opened(MID360, datagrams(payloads)).decode(t_ns, payloads)

    np.testing.assert_array_equal(np.diff(found.t_ns), 10_000)


def test_stamps_may_be_dates():
    t_ns = np.array([T0_NS, T0_NS + 86_400_000_000_000 * 60])
    payloads = encode_points(t_ns, walls(AVIA, 2), layout=AVIA, model=MODELS["Avia"], time_type=3)

    np.testing.assert_array_equal(opened(AVIA, datagrams(payloads)).stamps_ns(payloads), t_ns)


def test_shots_without_return_equal_returns_and_the_range_are_counted():
    shots = walls(DUAL, 2)
    xyz = shots.xyz_m.copy()
    xyz[0, :5] = 0.0
    xyz[0, 5:9, 1] = xyz[0, 5:9, 0]
    xyz[0, 9, 0], xyz[0, 10, 0] = (0.1, 0.0, 0.0), (300.0, 0.0, 0.0)
    xyz[1, 3, 0] = 0.0
    t_ns, payloads = packets(DUAL, replace(shots, xyz_m=xyz))
    report = ImportReport()
    source = LivoxSource(0, MODELS["Avia"], DUAL, replace(WIDE, min_range_m=0.5))
    found = decode_points(t_ns, payloads, source, report=report)

    assert report.counts["points_no_return"] == 5
    assert (report.counts["points_near"], report.counts["points_far"]) == (1, 1)
    assert len(found) == 2 * 96 - 10 - 4 - 1 - 1 - 1
    alone = np.flatnonzero(found.t_ns == t_ns[1] + round(3e9 / 240_000))
    np.testing.assert_array_equal(found.echo[alone], [0])


def test_noise_by_tag_is_left_out_where_the_manual_calls_it_noise():
    tags = np.zeros((1, 96, 1), np.uint8)
    tags[0, :6, 0] = 0x01, 0x04, 0x02, 0x03, 0x08, 0x20
    counts = {}
    for layout in (AVIA, MID360):
        t_ns, payloads = packets(layout, replace(walls(layout, 1), tag=tags))
        report = ImportReport()
        found = opened(layout, datagrams(payloads), report=report).decode(t_ns, payloads)
        first = found.ring[:6].tolist()
        counts[layout.sdk] = (
            first,
            report.counts["points_noise"],
            np.flatnonzero(found.echo).tolist(),
        )

    assert counts == {1: ([2, 3, 4, 5, 0, 1], 2, [3]), 2: ([0, 1, 2, 3, 0, 1], 0, [])}


def test_damaged_packets_are_dropped_with_the_reason():
    _, payloads = packets(MID360, walls(MID360, 60))
    report = ImportReport()
    device = opened(MID360, datagrams(payloads), report=report)
    payloads[0, 0] = 3
    payloads[1, 5] = 90
    payloads[2, 11] = 7
    payloads[3, 35] = 255
    payloads[4, 700] ^= 1
    sound = device.sound(payloads)

    np.testing.assert_array_equal(np.flatnonzero(~sound), np.arange(5))
    counted = {name: report.counts[name] for name in report.counts}
    assert counted == {
        "packets": 60,
        "packets_wrong_header": 3,
        "packets_wrong_stamp": 1,
        "packets_wrong_crc": 1,
    }


def test_sums_that_are_never_right_are_not_checked_and_wrong_ones_are_announced():
    _, payloads = packets(MID360, walls(MID360, 20))
    for value, said in ((0, 0), (7, 1)):
        payloads[:, 24:28] = value
        report = ImportReport()

        assert opened(MID360, datagrams(payloads), report=report).sound(payloads).all()
        assert ["CRC" in text for text in derivations(report)] == [True] * said


@pytest.mark.parametrize("sdk", [1, 2])
def test_the_imu_is_in_meters_per_second_squared_on_the_clock_of_the_points(sdk):
    layout = MID360 if sdk == 2 else AVIA
    _, payloads = packets(layout, walls(layout, 5))
    t_ns = T0_NS + 5_000_000 * np.arange(4)
    gyro, accel = np.full((4, 3), [0.1, -0.2, 0.3]), np.full((4, 3), [0.0, 0.5, 9.80665])
    imu = encode_imu(t_ns, gyro, accel, sdk=sdk)
    damaged = imu[:1].copy()
    damaged[0, -4:] = np.array([np.nan], "<f4").view(np.uint8)
    device = opened(layout, datagrams(payloads))

    clock = SensorClock("livox", packet_s=0.0, report=ImportReport())
    clock.past_hour = False
    clock.push_ns(t_ns, t_ns)

    found = device.samples(datagrams(imu, damaged, payloads), clock).imu

    np.testing.assert_array_equal(found.t_ns, t_ns)
    np.testing.assert_allclose(found.gyro_rad_s, gyro, atol=1e-6)
    np.testing.assert_allclose(found.accel_m_s2, accel, atol=1e-5)
    assert device.samples(datagrams(payloads), clock) is None


@pytest.mark.parametrize(
    ("name", "data_type", "view_deg"),
    [
        ("Mid-40", 0, (19.0, 19.0)),
        ("Mid-70", 2, (35.0, 35.0)),
        ("Avia", 2, (35.0, 38.0)),
        ("Avia", 4, (35.0, 38.0)),
        ("Horizon", 2, (40.8, 12.5)),
        ("Tele-15", 3, (7.2, 8.1)),
        ("Mid-360", 1, (180.0, 50.0)),
        ("HAP", 1, (60.0, 12.0)),
    ],
)
def test_models_are_told_apart_by_their_rate_and_their_view(name, data_type, view_deg):
    model = MODELS[name]
    layout = next(one for one in LAYOUTS if (one.sdk, one.data_type) == (model.sdk, data_type))
    count = 30_000 // layout.shots
    t_ns = T0_NS + np.rint(np.arange(count) * layout.shots * 1e9 / model.shots_hz).astype(np.int64)
    shots = walls(layout, count, view_deg=view_deg)
    payloads = encode_points(t_ns, shots, layout=layout, model=model)
    found = LIVOX.recognize(datagrams(payloads), ())

    assert (found.kind, found.model, found.findings) == ("data", name, ())
    assert found.packet_s == pytest.approx(layout.shots / model.shots_hz)


def test_imu_packets_alone_are_samples_and_noise_is_nothing():
    zeros = np.zeros((9, 3))
    imu = encode_imu(T0_NS + np.arange(9), zeros, zeros, sdk=2)
    noise = np.random.default_rng(1).integers(0, 256, (300, MID360.size), np.uint8)
    noise[:, 0] = 0

    assert LIVOX.recognize(datagrams(imu, port=56401), ()).kind == "samples"
    assert LIVOX.recognize(datagrams(noise), ()) is None
    _, payloads = packets(MID360, walls(MID360, 20))
    assert LIVOX.recognize(datagrams(payloads, noise), ()) is None


def test_a_rig_that_names_a_model_of_the_other_protocol_is_refused():
    _, payloads = packets(MID360, walls(MID360, 2))

    with pytest.raises(ConfigError, match=r"SDK2 .*Mid-360.*the rig says Avia"):
        opened(MID360, datagrams(payloads), model="Avia")
    with pytest.raises(ConfigError, match="head of the recording"):
        opened(MID360, datagrams(np.zeros((3, 100), np.uint8)))


@pytest.mark.parametrize("folder", ["mrpt", "veloview", "ouster"])
def test_captures_of_other_makers_are_not_taken(folder, data):
    for file in sorted(data(f"packets/{folder}").glob("*.pcap")):
        for batch in islice(read_pcap(file, ImportReport()), 2):
            for port in set(batch.port.tolist()):
                rows = batch.port == port
                columns = (getattr(batch, key)[rows] for key in batch.__slots__[:-1])
                assert LIVOX.recognize(Datagrams(*columns, batch.buffer), ()) is None


@pytest.mark.parametrize(
    ("folder", "flag", "size"),
    [
        ("hesai/xt32", b"\xee\xff", 1080),
        ("hesai/40p", b"\xff\xee", 1262),
        ("hesai/qt128", b"\xee\xff", 1127),
        ("robosense/helios16P", b"\x55\xaa\x05\x5a", 1248),
        ("velodyne/vls128", b"\xff\xee", 1206),
    ],
)
def test_packets_of_other_makers_in_bags_are_not_taken(folder, flag, size, data):
    file = next(data(f"packets/nebula/{folder}").rglob("*.db3"))
    with sqlite3.connect(file) as base:
        blob = base.execute("select data from messages").fetchone()[0]
    starts = [at.start() for at in re.finditer(re.escape(flag), blob)][:200]
    rows = [np.frombuffer(blob[at : at + size], np.uint8) for at in starts]
    whole = np.stack([row for row in rows if len(row) == size])

    assert len(whole) > 20
    assert LIVOX.recognize(datagrams(whole), ()) is None


@pytest.mark.parametrize(
    ("name", "lines", "view_deg"),
    [
        ("Mid-40", 1, (19.0, 19.0)),
        ("Mid-70", 1, (35.0, 35.0)),
        ("Avia", 6, (35.0, 38.0)),
        ("Horizon", 6, (40.8, 12.5)),
        ("Tele-15", 6, (7.2, 8.1)),
        ("HAP", 6, (60.0, 12.0)),
        ("Mid-360", 4, (180.0, 50.0)),
        ("generic", 3, (20.0, 20.0)),
    ],
)
def test_models_are_known_from_the_points_of_a_driver_too(name, lines, view_deg):
    xyz = walls(AVIA, 300, view_deg=view_deg).xyz_m.reshape(-1, 3).astype(np.float32)

    assert livox_of_points(xyz, lines) == name


def test_a_real_stream_in_firing_order_is_that_of_a_mid_40(data):
    file = data("livox/mid100-multi/scene1-pose10-L1.f32xyz.gz")
    raw = gzip.decompress(file.read_bytes())
    xyz = np.frombuffer(raw, "<f4").reshape(-1, 3)[:50_000].reshape(500, 100, 1, 3)
    layout = LAYOUTS[0]
    shots = ShotReturns(xyz.astype(np.float64), np.full(xyz.shape[:3], 40))
    t_ns, payloads = packets(layout, shots)
    found = opened(layout, datagrams(payloads)).decode(t_ns, payloads)
    there = xyz.reshape(-1, 3)[np.abs(xyz.reshape(-1, 3)).max(axis=1) >= 0.0005]

    assert LIVOX.recognize(datagrams(payloads), ()).model == "Mid-40"
    np.testing.assert_allclose(found.xyz, there, atol=0.0006)
    assert livox_of_points(there, 1) == "Mid-40"
