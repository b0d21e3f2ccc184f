"""RoboSense packets of the own encoder: directions, times, returns, angles, recognition."""

import numpy as np
import pytest

from recon4.errors import ConfigError
from recon4.recording.formats.datagrams import NO_DATAGRAMS, datagrams_of
from recon4.recording.formats.message_limits import check_message
from recon4.recording.packets.families import FAMILIES
from recon4.recording.packets.family import Companion, PacketSensor
from recon4.recording.packets.robosense.angles import angles_of_csv
from recon4.recording.packets.robosense.encode import (
    SpinningBlocks,
    encode_device,
    encode_spinning,
)
from recon4.recording.packets.robosense.family import FAMILY as ROBOSENSE
from recon4.recording.packets.robosense.imu_packets import IMU_ID
from recon4.recording.packets.robosense.models import (
    AIRY_INSTALLED,
    IMU_PACKET,
    MODELS,
    of_two_returns,
)
from recon4.recording.packets.robosense.packets import packet_s
from recon4.recording.packets.sensor_clock import SensorClock
from recon4.recording.report import ImportReport
from tests.unit.recording.packet_builders import T0_NS, WIDE, sensor
from tests.warned import K, kinds

HZ = 10.0


def angles_of(model):
    """Elevations and azimuths of the factory, or made up where it has none."""
    if model.factory_cdeg is not None:
        return model.factory_cdeg
    laser = np.arange(model.lasers)
    return np.column_stack([-2000 + 4000 * laser // model.lasers, 300 - 200 * (laser % 4)])


def device_of(model, mode=4):
    return encode_device(angles_of(model), model, mode=mode)


def spin(model, count, *, dual=False):
    """Times [ns] and packets in front of a smooth wall; second returns 100 units further."""
    layout, returns = model.layout, 2 if dual else 1
    t_ns = T0_NS + np.rint(np.arange(count) * packet_s(model, dual=dual) * 1e9).astype(np.int64)
    t_ns -= t_ns % 1000
    block = np.arange(layout.blocks)
    firing = block // (model.rows * returns)
    since_s = (t_ns - T0_NS)[:, None] / 1e9 + 1e-6 * model.firing_us * firing
    azimuth = np.rint(since_s * HZ * 36000).astype(np.int64)
    channel = np.arange(layout.channels)
    distance = 2000 + (azimuth[:, :, None] // 7 + 31 * channel) % 1000
    second = (block // model.rows) % returns
    distance = distance + 100 * second[:, None]
    intensity = np.broadcast_to(200 - 50 * second[:, None], distance.shape)
    return t_ns, encode_spinning(t_ns, SpinningBlocks(azimuth, distance, intensity), model)


def datagrams(*payloads):
    rows = [row.tobytes() for part in payloads for row in part]
    return datagrams_of([T0_NS] * len(rows), rows)


def opened(name, *, report=None, **fields):
    of = PacketSensor(
        row=0,
        sensor=sensor(model=name),
        settings=WIDE,
        report=report or ImportReport(),
        **fields,
    )
    return ROBOSENSE.open(of)


def decoded(layout, payloads):
    payloads = payloads[layout.sound(payloads)]
    return layout.decode(layout.stamps_ns(payloads), payloads)


def expected(shots, model):
    """Where the equations of the manual put points of their ring, time and range."""
    table = angles_of(model)
    order = np.argsort(table[:, 0], kind="stable")
    laser = order[shots.ring]
    elevation, offset = np.deg2rad(table[laser].T / 100)
    head = np.deg2rad((shots.t_ns - T0_NS) / 1e9 * HZ * 360)
    azimuth = head + offset
    along = np.column_stack([np.cos(head), -np.sin(head), np.zeros(len(head))])
    ray = [np.cos(elevation) * np.cos(azimuth), -np.cos(elevation) * np.sin(azimuth)]
    origin = model.along_m * along + [0, 0, model.up_m]
    ray = np.column_stack([*ray, np.sin(elevation)])
    return origin, ray, np.linalg.norm(shots.xyz - origin, axis=1)


@pytest.mark.parametrize("dual", [False, True])
@pytest.mark.parametrize("name", [name for name in MODELS if name != "Ruby Plus"])
def test_points_of_every_model_agree_with_the_equations_of_the_manual(name, dual):
    model = MODELS[name]
    wire = of_two_returns(model) if dual and model.lasers == 16 else model
    t_ns, payloads = spin(wire, 12, dual=dual and wire is model)
    if wire is not model:  # both returns of a firing lie in one block
        t_ns, payloads = returns_in_one_block(model, 12)
    layout = opened(name, beside=datagrams(device_of(model, mode=0 if dual else 4)))

    shots = decoded(layout, payloads)

    each = wire.layout.blocks * wire.layout.channels
    assert len(shots) == len(payloads) * (each if wire is model else 384)
    origin, ray, range_m = expected(shots, model)
    # Azimuths on the wire are whole 0.01°, and so is the turn between two blocks.
    assert np.abs(shots.xyz - origin - range_m[:, None] * ray).max() < 0.0004 * range_m.max()
    units = range_m / model.unit_m
    assert np.abs(units - np.rint(units)).max() < 0.05
    assert np.array_equal(np.unique(shots.echo), [0, 1] if dual else [0])
    assert len(np.unique(shots.ring)) == model.lasers
    assert (shots.t_ns[0], shots.t_ns.max() < t_ns[-1] + 1e9 * layout.packet_s) == (t_ns[0], True)
    if dual:
        first, second = (np.sort(range_m[shots.echo == echo]) for echo in (0, 1))
        assert second - first == pytest.approx(100 * model.unit_m, abs=1e-3)
    assert layout.packet_s == pytest.approx((t_ns[-1] - t_ns[0]) / 11 / 1e9, rel=1e-2)


def returns_in_one_block(single, count):
    """Times and packets: 12 firings of 16 lasers, each with its two returns in one block."""
    firing_us = of_two_returns(single).firing_us
    t_ns = T0_NS + 1000 * np.rint(np.arange(count) * 12 * firing_us).astype(np.int64)
    since_s = (t_ns - T0_NS)[:, None] / 1e9 + 1e-6 * firing_us * np.arange(12)
    azimuth = np.rint(since_s * HZ * 36000).astype(np.int64)
    channel = np.arange(32)
    distance = 2000 + (azimuth[:, :, None] // 7 + 31 * (channel % 16)) % 1000 + channel // 16 * 100
    intensity = np.broadcast_to(200 - 50 * (channel // 16), distance.shape)
    return t_ns, encode_spinning(t_ns, SpinningBlocks(azimuth, distance, intensity), single)


def test_a_ruby_plus_of_two_returns_packs_three_blocks_as_they_come():
    model = MODELS["Ruby Plus"]
    t_ns = T0_NS + np.array([0, 111_120])
    azimuth = np.array([[1000, 1000, 1020], [1020, 1040, 1040]])
    distance = np.full((2, 3, 128), 2000) + 100 * np.array([[0, 1, 0], [1, 0, 1]])[:, :, None]
    payloads = encode_spinning(t_ns, SpinningBlocks(azimuth, distance, distance // 16), model)
    layout = opened("Ruby Plus", beside=datagrams(device_of(model)))

    shots = decoded(layout, payloads)

    firing = (shots.t_ns - T0_NS) // 55_560
    seen = {
        (int(f), int(e)): int(np.sum((firing == f) & (shots.echo == e)))
        for f in range(4)
        for e in (0, 1)
    }
    assert seen[0, 0] == seen[0, 1] == 128
    assert seen[1, 0] == 128
    assert len(shots) == 6 * 128


def test_a_single_return_that_is_sent_twice_is_one_point():
    model = MODELS["Bpearl"]
    _, payloads = spin(model, 3, dual=True)
    blocks = payloads[:, 42:1242].reshape(3, 12, 100)
    blocks[:, 1::2, 4:] = blocks[:, ::2, 4:]

    shots = decoded(opened("Bpearl"), payloads)

    assert len(shots) == 3 * 6 * 32
    assert not shots.echo.any()


def test_every_time_stamp_is_read_to_the_microsecond():
    for name in ("Bpearl", "Helios 5515", "Ruby Plus", "Airy"):
        model = MODELS[name]
        t_ns = np.array([T0_NS + 123_456_000, 951_782_399_999_999_000])  # the latter: 2000-02-28
        payloads = np.repeat(spin(model, 1)[1], 2, axis=0)
        written = encode_spinning(
            t_ns,
            SpinningBlocks(
                np.zeros((2, model.layout.blocks)),
                *[np.zeros((2, model.layout.blocks, model.layout.channels))] * 2,
            ),
            model,
        )
        payloads[:, model.stamp_at : model.stamp_at + 10] = written[
            :, model.stamp_at : model.stamp_at + 10
        ]
        layout = opened(name, beside=datagrams(device_of(model)))

        assert layout.stamps_ns(payloads).tolist() == t_ns.tolist(), name


def test_device_packets_overrule_a_file_and_a_file_the_factory():
    model = MODELS["Helios 5515"]
    text = "\n".join(f" {e / 100:.2f},{a / 100 + 1:.2f}\t" for e, a in angles_of(model))
    file = Companion("Helios5515.csv", text.encode())
    other = Companion("poses.csv", b"time,x,y\n1,2,3\n")
    _, payloads = spin(model, 2)
    mine = encode_device(angles_of(model) + np.array([0, 200]), model)

    def first_azimuth(**fields):
        report = ImportReport()
        shots = decoded(opened(model.name, report=report, **fields), payloads)
        x, y = shots.xyz[0, :2] - [model.along_m, 0]
        return np.rad2deg(np.arctan2(-y, x)), report

    factory, typical = first_azimuth()
    by_file, _ = first_azimuth(companions=[other, file])
    by_device, right = first_azimuth(companions=[file], beside=datagrams(mine))

    assert factory == pytest.approx(-4.07, abs=0.01)
    assert by_file == pytest.approx(-3.07, abs=0.01)
    assert by_device == pytest.approx(-2.07, abs=0.01)
    assert kinds(typical) == [K.ANGLES_TYPICAL]
    assert not right.findings


@pytest.mark.parametrize("installed", [0, 1, 2, 255])
def test_the_way_an_airy_is_installed_decides_when_its_lasers_fire(installed):
    model = AIRY_INSTALLED.get(installed, MODELS["Airy"])
    _, payloads = spin(model, 2)
    device = encode_device(angles_of(model), model, installed=installed)

    shots = decoded(opened("Airy", beside=datagrams(device)), payloads)

    since_us = (shots.t_ns[:384] - shots.t_ns[0]) / 1000 % model.firing_us
    wanted = np.unique(np.rint(model.time_us))
    assert np.unique(np.rint(since_us)).tolist() == wanted.tolist()


def test_other_packets_of_an_airy_with_the_same_first_bytes_hold_no_points():
    _, payloads = spin(MODELS["Airy"], 4)
    payloads[1, 16] = 1
    layout = opened("Airy", beside=datagrams(device_of(MODELS["Airy"])))

    assert layout.sound(payloads).tolist() == [True, False, True, True]


@pytest.mark.parametrize("unit_ns", [1, 1000])
def test_the_stamps_of_a_ruby_plus_are_ns_or_us_as_its_first_packets_show(unit_ns):
    model = MODELS["Ruby Plus"]
    t_ns, payloads = spin(model, 30)
    rest = ((t_ns % 1_000_000_000) // unit_ns).astype(">u4")
    payloads[:, 16:20] = rest[:, None].view(np.uint8)

    layout = opened("Ruby Plus", head=datagrams(payloads), beside=datagrams(device_of(model)))

    assert layout.stamps_ns(payloads).tolist() == t_ns.tolist()


def test_a_device_packet_among_the_data_is_read_and_no_fault():
    model = MODELS["Helios 5515"]
    _, payloads = spin(model, 4)
    mixed = np.concatenate([payloads[:2], device_of(model), payloads[2:]])
    report = ImportReport()
    layout = opened(model.name, report=report)

    assert layout.sound(mixed).tolist() == [True, True, False, True, True]
    assert report.counts["packets"] == 4
    assert not [name for name in report.counts if name.startswith("packets_")]


def test_without_angles_a_ruby_plus_is_refused_with_what_is_missing():
    with pytest.raises(ConfigError, match=r"angles of its 128 lasers: record its device packets"):
        opened("Ruby Plus")


def test_tables_with_and_without_a_header_are_read():
    plain = Companion("a.csv", b" 14.94,-4.07\t\n13.03,3.63\t\n")
    ring = Companion("b.csv", b"-11.75,5.92,4\n-10.36,2.54,5")
    header = Companion("c.csv", b"Laser ID,Elevation,Azimuth\n1,15,0\n2,13,-1\n")

    assert angles_of_csv(plain).tolist() == [[1494, -407], [1303, 363]]
    assert np.rint(angles_of_csv(ring)).tolist() == [[-1175, 592], [-1036, 254]]
    assert angles_of_csv(header).tolist() == [[1500, 0], [1300, -100]]
    assert angles_of_csv(Companion("d.csv", b"time,x\nnan,inf\n\xff\xfe")) is None


@pytest.mark.parametrize("name", [*MODELS])
def test_the_head_of_a_stream_tells_the_model(name):
    model = MODELS[name]
    _, payloads = spin(model, 10)
    head = datagrams(payloads, device_of(model))

    found = ROBOSENSE.recognize(head, ())

    assert (found.kind, found.model) == ("data", name)
    assert ROBOSENSE.recognize(datagrams(device_of(model)), ()).kind == "samples"
    assert [f.name for f in FAMILIES if f.recognize(head, ()) is not None] == ["RoboSense"]


def test_a_helios_whose_lasers_do_not_look_down_is_no_5515():
    model = MODELS["Helios 32"]
    table = np.column_stack([1600 - 100 * np.arange(32), np.zeros(32, int)])
    head = datagrams(spin(model, 10)[1], encode_device(table, model))

    assert ROBOSENSE.recognize(head, ()).model == "Helios 32"


def test_noise_of_the_right_size_is_not_taken_for_a_robosense():
    rng = np.random.default_rng(1)
    for size in (1248, 1210, 1200, 51):
        noise = rng.integers(0, 256, (50, size), dtype=np.uint8)
        assert ROBOSENSE.recognize(datagrams(noise), ()) is None
    assert ROBOSENSE.recognize(NO_DATAGRAMS, ()) is None


def test_each_reason_to_drop_a_packet_is_counted():
    model = MODELS["Helios 5515"]
    _, payloads = spin(model, 5)
    payloads[1, 0] ^= 1
    payloads[2, 42 + 300] ^= 1
    payloads[3, 44:46] = 0xFF
    payloads[4, 26] = 0xFF
    report = ImportReport()

    sound = opened(model.name, report=report).sound(payloads)

    assert sound.tolist() == [True, False, False, False, False]
    for reason in ("header", "flag", "azimuth", "stamp"):
        assert report.counts[f"packets_wrong_{reason}"] == 1


def test_the_inertial_unit_of_an_airy_is_read_in_si_units():
    packets = np.zeros(3, IMU_PACKET)
    packets["id"] = np.frombuffer(IMU_ID, np.uint8)
    stamp = encode_spinning(T0_NS + 5_000_000 * np.arange(3), empty_airy(3), MODELS["Airy"])[
        :, 20:30
    ]
    packets["stamp"] = stamp
    packets["accel"], packets["accel_range"] = [[0, 0, 8192]], 1
    packets["gyro"], packets["gyro_range"] = [[-16384, 0, 0]], 0
    arrival = T0_NS + 5_000_000 * np.arange(3)
    clock = SensorClock("airy", packet_s=0.000444, report=ImportReport())
    clock.past_hour = False
    clock.push_ns(arrival, arrival)
    layout = opened("Airy", beside=datagrams(device_of(MODELS["Airy"])))

    rows = [row.tobytes() for row in packets]
    found = layout.samples(datagrams_of(arrival.tolist(), rows), clock)

    assert found.imu.accel_m_s2[1] == pytest.approx([0, 0, 9.80665])
    assert found.imu.gyro_rad_s[1] == pytest.approx([np.deg2rad(-125), 0, 0])
    assert np.diff(found.imu.t_ns).tolist() == [5_000_000] * 2
    assert ROBOSENSE.recognize(datagrams_of(arrival.tolist(), rows), ()).kind == "samples"


def empty_airy(count):
    return SpinningBlocks(np.zeros((count, 8)), *[np.zeros((count, 8, 48))] * 2)


def test_an_airy_of_another_number_of_lines_is_refused_by_name():
    _, payloads = spin(MODELS["Airy"], 5)
    payloads[:, 32] = 3

    found = ROBOSENSE.recognize(datagrams(payloads), ())

    assert found.kind == "other"
    assert "48 or 192 lines" in found.refused


def test_a_revolution_of_packets_is_no_message_that_is_too_large():
    for kind in ROBOSENSE.messages:
        if kind.endswith("Scan"):
            check_message(kind, bytes(500_000), ros1=False)


def test_the_interval_of_the_packets_contradicts_a_wrong_model():
    assert opened("Helios 16P").likely_models(0.000667) == ("Helios 32", "Helios 5515")
    assert opened("Helios 16P").likely_models(0.001333) == ("Helios 16P",)
    assert opened("Helios 5515").likely_models(0.005) == ()
