"""Hesai packets by the manuals: encoded, decoded, damaged, recognized."""

import numpy as np
import pytest

from recon4.errors import ConfigError
from recon4.recording.formats.datagrams import datagrams_of
from recon4.recording.packets.hesai import checksums, stamps
from recon4.recording.packets.hesai.encode import HesaiBlocks, HesaiMode, encode_packets
from recon4.recording.packets.hesai.family import FAMILY as HESAI
from recon4.recording.packets.hesai.firing import firing_mode, shot_times_us
from recon4.recording.packets.hesai.models import MODELS, RETURNS
from recon4.settings import IngestSettings
from tests.unit.recording.hesai_mirrors import mirror_table, mirrored
from tests.unit.recording.hesai_packets import datagrams, packet_sensor, table_of
from tests.warned import K, warned

T0_US = 1_700_000_000_000_000
NEEDS_TABLE = ("Pandar128", "AT128")
DUAL, TRIPLE = 0x39, 0x3D
MODES = [(name, 0x37) for name in MODELS] + [
    (name, DUAL) for name in MODELS if name not in ("JT16",)
]


def spin(model, packets=6, mode=0x37, *, rpm=600.0, sense=1, **fields):
    """Stamps [µs], blocks and payloads of a sensor in front of a smooth wall."""
    layout, returns = model.layout, int(RETURNS[mode])
    rounds = layout.blocks // returns
    times_us = round_starts_us(model, rounds, mode, **fields)
    step_us = rounds * model.round_us(high_resolution=fields.get("state", 2) == 0)
    stamp_us = T0_US + np.rint(np.arange(packets) * step_us).astype(np.int64)
    start_us = (stamp_us - T0_US)[:, None] + times_us
    unit = 256 if model.name == "AT128" else 1
    azimuth = 3000 + sense * start_us * 1e-6 * rpm / 60 * 36000
    azimuth = np.repeat(np.rint(azimuth * unit).astype(np.int64), returns, axis=1)
    blocks = np.arange(layout.blocks)[:, None]
    channel = np.arange(layout.channels)
    distance = 900 + (np.arange(packets)[:, None, None] * 7 + blocks * 131 + channel * 3) % 2000
    intensity = (blocks * 50 + channel) % 200 + np.zeros_like(distance)
    made = HesaiBlocks(azimuth, distance, intensity)
    mode = HesaiMode(return_mode=mode, rpm=rpm, **fields)
    return stamp_us, made, encode_packets(stamp_us, made, model=model, mode=mode)


def round_starts_us(model, rounds, mode, **fields):
    return model.start_us(rounds, high_resolution=fields.get("state", 2) == 0)


def opened(model, payloads, **kwargs):
    """Format and report for some payloads, with a table of angles where one is needed."""
    companions = {
        "Pandar128": (table_of(MODELS["OT128"].angles),),
        "AT128": (mirror_table(),),
    }.get(model.name, ())
    sensor = packet_sensor(model.name, head=datagrams(payloads), companions=companions, **kwargs)
    return HESAI.open(sensor), sensor


def decoded(model, payloads, **kwargs):
    made, sensor = opened(model, payloads, **kwargs)
    return decoded_with(made, payloads), sensor.report


def decoded_with(made, payloads):
    assert made.sound(payloads).all()
    return made.decode(made.stamps_ns(payloads), payloads)


def expected(model, stamp_us, blocks, mode, key, *, rpm=600.0, sense=1):
    """Time [ns] and position of each return, (P, B, C)."""
    layout, returns = model.layout, int(RETURNS[mode])
    firing = firing_mode(key, layout.blocks)
    times_us = np.repeat(shot_times_us(model, layout.blocks, firing), returns, axis=0)
    starts_us = np.repeat(
        model.start_us(layout.blocks // returns, high_resolution=firing.high_resolution), returns
    )
    t_ns = 1000 * stamp_us[:, None, None] + np.rint(1e3 * times_us).astype(np.int64)
    if model.name == "AT128":
        azimuth, elevation = mirrored(blocks.azimuth)
    else:
        angles = MODELS["OT128"].angles if model.name == "Pandar128" else model.angles
        turn = sense * (times_us - starts_us[:, None]) * 1e-6 * rpm / 60 * 2 * np.pi
        azimuth = np.deg2rad(blocks.azimuth / 100)[:, :, None] + angles.azimuth_rad + turn
        elevation = np.broadcast_to(angles.elevation_rad, azimuth.shape)
    r = 0.004 * blocks.distance
    flat = r * np.cos(elevation)
    xyz = np.stack([flat * np.sin(azimuth), flat * np.cos(azimuth), r * np.sin(elevation)], -1)
    return t_ns, xyz


def in_order(t_ns, xyz):
    """Rows by time, distance and height."""
    return np.lexsort((xyz[:, 2], np.rint(np.linalg.norm(xyz, axis=1) / 0.004), t_ns))


def assert_same(shots, t_ns, xyz):
    """The shots are these, in order of time; shots of one time may stand in any order."""
    t_ns, xyz = t_ns.ravel(), xyz.reshape(-1, 3)
    order, ours = in_order(t_ns, xyz), in_order(shots.t_ns, shots.xyz)
    assert (np.diff(shots.t_ns) >= 0).all()
    np.testing.assert_array_equal(shots.t_ns[ours], t_ns[order])
    np.testing.assert_allclose(shots.xyz[ours], xyz[order], atol=2e-4)


@pytest.mark.parametrize(("name", "mode"), MODES)
def test_each_model_decodes_what_the_manual_encodes(name, mode):
    model = MODELS[name]
    stamp_us, blocks, payloads = spin(model, mode=mode)

    shots, report = decoded(model, payloads)

    key = int(RETURNS[mode]) + (4 if name == "QT128" else 0)
    key += 64 if name in ("Pandar128", "OT128", "JT128") else 0
    assert_same(shots, *expected(model, stamp_us, blocks, mode, key))
    assert report.counts["points"] == blocks.distance.size
    assert (np.bincount(shots.echo).min() == len(shots) // 2) == (mode == DUAL)


@pytest.mark.parametrize("sense", [1, -1])
def test_a_sensor_may_spin_either_way_round(sense):
    model = MODELS["XT32"]
    stamp_us, blocks, payloads = spin(model, sense=sense, rpm=1200.0)

    shots, _ = decoded(model, payloads)

    assert_same(shots, *expected(model, stamp_us, blocks, 0x37, 1, rpm=1200.0, sense=sense))


@pytest.mark.parametrize("sequence", [0, 1])
def test_the_mode_flag_of_a_qt128_tells_which_lasers_fire(sequence):
    model = MODELS["QT128"]
    stamp_us, blocks, payloads = spin(model, mode=DUAL, sequence=sequence)

    shots, _ = decoded(model, payloads)

    assert_same(shots, *expected(model, stamp_us, blocks, DUAL, 2 + 4 * sequence))
    silent = model.firing_us[1 - sequence] == 0
    assert silent.sum() == 32


@pytest.mark.parametrize("name", ["Pandar128", "OT128"])
@pytest.mark.parametrize("flag", [0b0000, 0b0100, 0b0001])
@pytest.mark.parametrize("state", [0, 2])
def test_state_and_azimuth_flags_of_128_beams_select_the_firing_times(name, flag, state):
    model = MODELS[name]
    stamp_us, blocks, payloads = spin(model, state=state, azimuth_flag=flag << 12)

    shots, _ = decoded(model, payloads)

    key = 1 + 4 * flag + (64 if state else 0)
    assert_same(shots, *expected(model, stamp_us, blocks, 0x37, key))


def test_equal_returns_of_a_shot_are_one_point_and_the_more_intense_comes_first():
    model = MODELS["XT32"]
    stamp_us, blocks, _ = spin(model, mode=DUAL)
    blocks.distance[:, 1::2] = blocks.distance[:, ::2]
    blocks.distance[:, 1::2, 5] += 100
    blocks.intensity[:, ::2, 5], blocks.intensity[:, 1::2, 5] = 10, 20
    mode = HesaiMode(return_mode=DUAL)
    payloads = encode_packets(stamp_us, blocks, model=model, mode=mode)

    shots, _ = decoded(model, payloads)

    rounds = len(payloads) * 4
    assert len(shots) == rounds * 33
    of_two = shots.ring == 31 - 5
    assert shots.echo[of_two].tolist() == [0, 1] * rounds
    assert shots.intensity[of_two].tolist() == [20, 10] * rounds


def test_a_third_return_is_a_further_one_unless_it_repeats_another():
    model = MODELS["XT32M2X"]
    stamp_us, blocks, _ = spin(model, mode=TRIPLE)
    for part in range(3):
        blocks.distance[:, part::3] = 1000 + 100 * part
    blocks.distance[:, 2::3, 16:] = 1100
    mode = HesaiMode(return_mode=TRIPLE)
    payloads = encode_packets(stamp_us, blocks, model=model, mode=mode)

    shots, report = decoded(model, payloads)

    rounds = len(payloads) * 2
    assert len(shots) == report.counts["points"] == rounds * (16 * 3 + 16 * 2)
    assert (np.diff(shots.t_ns) >= 0).all()
    assert np.bincount(shots.echo).tolist() == [rounds * 32, rounds * 48]


def test_empty_near_and_far_returns_are_counted():
    model = MODELS["XT32"]
    stamp_us, blocks, _ = spin(model)
    blocks.distance[:, :, 0], blocks.distance[:, :, 1], blocks.distance[:, :, 2] = 0, 10, 50000
    payloads = encode_packets(stamp_us, blocks, model=model)

    settings = IngestSettings(min_range_m=0.4, max_range_m=100.0)
    shots, report = decoded(model, payloads, settings=settings)

    of_channel = len(payloads) * 8
    assert len(shots) == 29 * of_channel
    for name in ("points_no_return", "points_near", "points_far"):
        assert report.counts[name] == of_channel


def test_ring_0_is_the_lowest_beam_and_azimuth_0_looks_along_y():
    model = MODELS["XT32"]
    stamp_us, blocks, _ = spin(model)
    blocks.azimuth[:] = 0
    payloads = encode_packets(stamp_us, blocks, model=model, mode=HesaiMode(rpm=0.0))

    shots, _ = decoded(model, payloads)

    assert (shots.xyz[:, 1] > 3.0).all()
    assert np.abs(shots.xyz[:, 0]).max() < 1e-4
    assert shots.xyz[shots.ring == 0][0, 2] < shots.xyz[shots.ring == 31][0, 2]
    assert shots.xyz[shots.ring == 31][0, 2] > 0


@pytest.mark.parametrize("name", MODELS)
def test_damaged_packets_are_dropped_and_counted_by_their_reason(name):
    model = MODELS[name]
    _, _, clean = spin(model, packets=8)
    layout, tail = model.layout, model.layout.tail
    made, sensor = opened(model, clean)
    payloads = clean.copy()
    payloads[0, layout.blocks_at if name == "Pandar40P" else 0] ^= 0xFF
    azimuth = layout.blocks_at + layout.azimuth_at
    payloads[1, azimuth : azimuth + 2] = 0xFF
    payloads[2, layout.tail_at + tail.date : layout.tail_at + tail.date + 6] = (120, 13, 1, 0, 0, 0)
    payloads[3, layout.tail_at + tail.micros + 3] = 0xFF
    checksums.write(payloads, layout)
    counts = {"packets_wrong_header": 1, "packets_wrong_azimuth": 1, "packets_wrong_stamp": 2}
    if tail.speed >= 0:
        payloads[4, layout.tail_at + tail.speed : layout.tail_at + tail.speed + 2] = 0xFF
        checksums.write(payloads, layout)
        counts["packets_wrong_speed"] = 1
    if layout.crc_at >= 0:
        payloads[5, layout.crc_at] ^= 1
        counts["packets_wrong_crc"] = 1

    sound = made.sound(payloads)

    found = {key: n for key, n in sensor.report.counts.items() if key != "packets"}
    assert found == counts
    assert sound.sum() == len(payloads) - sum(counts.values())


def test_a_stamp_is_a_date_or_seconds_since_1970():
    seconds = np.array([1_504_728_000, 1_700_000_000, 3_000_000_000])
    date = stamps.date_of(seconds)
    counted = np.zeros((3, 6), dtype=np.uint8)
    counted[:, 1:] = [list(int(s).to_bytes(5, "big")) for s in seconds]
    from_2000 = date.copy()
    from_2000[:, 0] -= 100
    micros = np.array([0, 5, 999_999], dtype=np.uint32)

    for form in (date, counted, from_2000):
        assert stamps.is_date(form, micros).all()
        expected_ns = seconds * 1_000_000_000 + micros.astype(np.int64) * 1000
        np.testing.assert_array_equal(stamps.time_ns(form, micros), expected_ns)


def test_the_usual_time_between_packets_follows_the_mode():
    model = MODELS["Pandar128"]
    made, _ = opened(model, spin(model)[2])
    assert made.packet_s == pytest.approx(111.112e-6)

    made.sound(spin(model, state=0)[2])
    assert made.packet_s == pytest.approx(55.556e-6)

    made.sound(spin(model, mode=DUAL)[2])
    assert made.packet_s == pytest.approx(55.556e-6)


@pytest.mark.parametrize("name", MODELS)
def test_each_model_is_recognized_by_its_packets(name):
    model = MODELS[name]
    payloads = spin(model, packets=20)[2]

    found = HESAI.recognize(datagrams(payloads), ())

    assert (found.kind, found.model, found.size) == ("data", name, model.layout.size)
    assert found.packet_s == pytest.approx(np.diff(spin(model)[0]).mean() * 1e-6, rel=0.02)
    if name not in ("AT128", "JT16"):
        assert found.rotation_hz == pytest.approx(10.0)


@pytest.mark.parametrize("name", MODELS)
def test_noise_of_the_size_of_a_packet_is_none(name):
    rng = np.random.default_rng(3)
    model = MODELS[name]
    noise = rng.integers(0, 256, (50, model.layout.size), dtype=np.uint8)
    assert HESAI.recognize(datagrams(noise), ()) is None

    noise[:, : len(model.header)] = np.frombuffer(model.header, np.uint8)
    assert HESAI.recognize(datagrams(noise), ()) is None
    assert HESAI.recognize(datagrams_of([], []), ()) is None


def test_packets_of_another_shape_than_the_model_are_refused():
    payloads = spin(MODELS["XT16"])[2]

    with pytest.raises(ConfigError, match=r"16 channels \(XT16\), a XT32 has 32"):
        HESAI.open(packet_sensor("XT32", head=datagrams(payloads)))


def test_packets_of_another_model_of_the_same_shape_are_a_warning():
    payloads = spin(MODELS["XT32M2X"])[2]
    sensor = packet_sensor("XT32", head=datagrams(payloads))

    HESAI.open(sensor)

    assert warned(sensor.report, K.MODEL_CONTRADICTED, says="XT32M2X", model="XT32")


@pytest.mark.parametrize("name", NEEDS_TABLE)
def test_a_model_without_typical_angles_needs_its_file(name):
    payloads = spin(MODELS[name])[2]

    with pytest.raises(ConfigError, match="needs its angle correction file"):
        HESAI.open(packet_sensor(name, head=datagrams(payloads)))
