"""Packets to points: cases worked out on paper, laws, empty and refused input."""

import numpy as np
import pytest

from recon4.errors import ConfigError
from recon4.recording.packets.decoder import open_decoder
from recon4.recording.packets.family import PacketSensor
from recon4.recording.packets.velodyne.data_packets import (
    PacketSource,
    decode_packets,
)
from recon4.recording.packets.velodyne.encode import PacketBlocks, encode_packets
from recon4.recording.packets.velodyne.models import DUAL, MODELS, STRONGEST
from recon4.recording.report import ImportReport
from recon4.settings import IngestSettings
from tests.unit.recording.packet_builders import LATENCY_NS, T0_NS, WIDE, decode_all, sensor, spin


def one_packet(model="VLP-16", *, azimuth=0, step=40, mode=STRONGEST):
    """Azimuths of one packet and empty returns."""
    block = np.arange(12) // (2 if mode == DUAL else 1)
    return (azimuth + step * block)[None], np.zeros((1, 12, 32), int), np.zeros((1, 12, 32), int)


def decoded(azimuth, distance, intensity, *, model="VLP-16", mode=STRONGEST, settings=WIDE):
    report = ImportReport()
    payloads = encode_packets(
        np.array([0]),
        PacketBlocks(azimuth, distance, intensity),
        model=MODELS[model],
        return_mode=mode,
    )
    shots = decode_packets(
        np.array([0]),
        payloads,
        PacketSource(3, MODELS[model], settings),
        report=report,
    )
    return shots, report


def test_the_top_laser_of_a_vlp16_at_10_m_lies_where_paper_says():
    azimuth, distance, intensity = one_packet(azimuth=9000)
    distance[0, 0, 15], intensity[0, 0, 15] = 5000, 77

    shots, _ = decoded(azimuth, distance, intensity)

    # 15 * 2.304 µs after the block's start; of 0.4° in 110.592 µs that is 0.125° more than 90°:
    # clockwise from above, so the point is to the right (-y) and a little behind.
    assert shots.t_ns.tolist() == [34560]
    flat = 10 * np.cos(np.deg2rad(15))
    off = np.deg2rad(0.125)
    expected = [-flat * np.sin(off), -flat * np.cos(off), 10 * np.sin(np.deg2rad(15)) - 0.0112]
    assert shots.xyz[0] == pytest.approx(expected, abs=2e-6)
    assert (shots.ring[0], shots.intensity[0], shots.echo[0], shots.sensor) == (15, 77, 0, 3)


def test_the_top_laser_of_a_hi_res_puck_looks_up_by_10_degrees():
    azimuth, distance, intensity = one_packet(step=0)
    distance[0, 0, [0, 1, 15]] = 5000

    shots, _ = decoded(azimuth, distance, intensity, model="VLP-16 Hi-Res")

    # Manual, table of the Hi-Res: lasers 0, 1 and 15 at -10, +0.667 and +10 degrees, 7.4 mm off.
    elevation = np.deg2rad([-10.0, 2.0 / 3.0, 10.0])
    height = 10 * np.sin(elevation) + np.array([7.4, -0.5, -7.4]) * 1e-3
    assert shots.xyz[:, 2] == pytest.approx(height, abs=1e-4)
    assert shots.ring.tolist() == [0, 8, 15]


def test_the_second_sequence_of_a_vlp16_block_fires_half_a_block_later():
    azimuth, distance, intensity = one_packet(azimuth=35990)
    distance[0, 11, 16] = 1000

    shots, _ = decoded(azimuth, distance, intensity)

    assert shots.t_ns.tolist() == [(11 * 110592 + 55296)]
    # Block 11 is at 35990 + 440 = 430 (4.30°), no later block: its turn is that of block 10.
    angle = -np.arctan2(shots.xyz[0, 1], shots.xyz[0, 0])
    assert np.rad2deg(angle) == pytest.approx(4.30 + 0.20, abs=1e-4)
    assert shots.ring[0] == 0


def test_two_lasers_of_a_vlp32c_fire_together_with_their_own_azimuth():
    azimuth, distance, intensity = one_packet(step=20)
    distance[0, 2, 2:4] = 2500

    shots, _ = decoded(azimuth, distance, intensity, model="VLP-32C")

    assert shots.t_ns.tolist() == [(2 * 55296 + 2304)] * 2
    angles = -np.rad2deg(np.arctan2(shots.xyz[:, 1], shots.xyz[:, 0]))
    moved = 0.4 + 0.2 * 2.304 / 55.296
    assert angles == pytest.approx([moved + 1.4, moved - 1.4], abs=1e-4)
    assert np.linalg.norm(shots.xyz[0, :2]) == pytest.approx(10 * np.cos(np.deg2rad(1.667)))
    assert shots.ring.tolist() == [15, 1]


def test_ring_zero_of_an_hdl32e_is_its_lowest_beam():
    azimuth, distance, intensity = one_packet(step=17)
    distance[0, 0, :] = 5000

    shots, _ = decoded(azimuth, distance, intensity, model="HDL-32E")

    assert shots.t_ns[:3].tolist() == [0, 1152, 2304]
    order = np.argsort(shots.ring)
    assert np.all(np.diff(shots.xyz[order, 2]) > 0)
    lowest = np.deg2rad(-92 / 3)
    height = 10 * np.sin(lowest) - 0.02896 * np.tan(lowest)
    assert shots.xyz[order[0], 2] == pytest.approx(height, abs=1e-6)


@pytest.mark.parametrize("model", sorted(MODELS))
@pytest.mark.parametrize("mode", [STRONGEST, DUAL])
def test_points_of_a_whole_turn_agree_with_the_equations_in_double_precision(model, mode):
    t_ns, payloads = spin(80, model=model, return_mode=mode)

    shots, _ = decode_all(t_ns, payloads, model=model)

    table = MODELS[model]
    since_s = (shots["t_ns"] - T0_NS) / 1e9
    laser = np.argsort(table.ring)[shots["ring"]]
    azimuth = np.deg2rad(since_s * 3600 + table.azimuth_offset_cdeg[laser] / 100)
    elevation = table.elevation_rad[laser]
    centered = shots["xyz"] - np.array([0, 0, 1]) * table.height_m[laser][:, None]
    ray = [np.cos(elevation) * np.cos(azimuth), -np.cos(elevation) * np.sin(azimuth)]
    ray = np.column_stack([*ray, np.sin(elevation)])
    across = np.linalg.norm(np.cross(ray, centered), axis=1) / np.linalg.norm(centered, axis=1)
    # Azimuths on the wire are rounded to 0.01°, the step between two blocks to twice that.
    assert np.rad2deg(across.max()) < 0.016
    counts = np.linalg.norm(centered, axis=1) / table.distance_unit_m
    assert np.abs(counts - np.rint(counts)).max() < 0.01


def test_a_quarter_turn_of_the_sensor_turns_the_cloud():
    azimuth, distance, intensity = one_packet(azimuth=27123)
    distance[:] = 3000

    here, _ = decoded(azimuth, distance, intensity)
    there, _ = decoded((azimuth + 9000) % 36000, distance, intensity)

    turned = np.column_stack([here.xyz[:, 1], -here.xyz[:, 0], here.xyz[:, 2]])
    np.testing.assert_allclose(there.xyz, turned, atol=2e-6)


def test_shots_without_an_echo_are_no_points_and_no_fault():
    azimuth, distance, intensity = one_packet()

    shots, report = decoded(azimuth, distance, intensity)

    assert len(shots) == 0
    assert report.counts == {"points_no_return": 384}


def test_returns_outside_the_limits_are_dropped_and_counted():
    azimuth, distance, intensity = one_packet()
    distance[0, 0, :4] = [349, 350, 50000, 50001]

    limits = IngestSettings(min_range_m=0.7, max_range_m=100.0)
    shots, report = decoded(azimuth, distance, intensity, settings=limits)

    assert len(shots) == 2
    assert (report.counts["points_near"], report.counts["points_far"]) == (1, 1)
    assert report.counts["points"] == 2


def test_the_same_return_sent_twice_in_dual_mode_is_one_point():
    azimuth, distance, intensity = one_packet(mode=DUAL)
    distance[0, :2, 5], intensity[0, :2, 5] = 4000, 50

    shots, _ = decoded(azimuth, distance, intensity, mode=DUAL)

    assert (len(shots), shots.echo[0]) == (1, 0)


@pytest.mark.parametrize(
    ("last", "strongest", "expected"),
    [
        ((6000, 20), (4000, 90), [(8.0, 90), (12.0, 20)]),
        ((6000, 90), (4000, 20), [(12.0, 90), (8.0, 20)]),
        ((6000, 20), (0, 0), [(12.0, 20)]),
        ((0, 0), (4000, 90), [(8.0, 90)]),
    ],
)
def test_the_strongest_echo_comes_first_in_dual_mode(last, strongest, expected):
    azimuth, distance, intensity = one_packet(mode=DUAL)
    for block, (units, value) in enumerate((last, strongest)):
        distance[0, 2 + block, 16], intensity[0, 2 + block, 16] = units, value

    shots, _ = decoded(azimuth, distance, intensity, mode=DUAL)

    ranges = np.linalg.norm(shots.xyz - [0, 0, 0.0112], axis=1)
    assert ranges == pytest.approx([r for r, _ in expected], abs=1e-5)
    assert shots.intensity.tolist() == [value for _, value in expected]
    assert shots.echo.tolist() == list(range(len(expected)))
    assert set(shots.t_ns.tolist()) == {(110592 + 55296)}


def test_a_jump_of_azimuth_does_not_smear_the_firing_before_it():
    azimuth, distance, intensity = one_packet()
    azimuth[0, 6:] += 18000
    distance[0, 5, 31] = 5000

    shots, report = decoded(azimuth, distance, intensity)

    angle = -np.rad2deg(np.arctan2(shots.xyz[0, 1], shots.xyz[0, 0]))
    assert angle == pytest.approx(2.0 + 0.4 * 89.856 / 110.592, abs=1e-4)
    assert report.counts["azimuth_jumps"] == 1


def test_a_change_of_the_return_mode_inside_a_batch_is_followed():
    first, second = spin(10), spin(10, return_mode=DUAL, t0_ns=T0_NS + 13_271_040)
    t_ns, payloads = (np.concatenate(both) for both in zip(first, second, strict=True))

    shots, _ = decode_all(t_ns, payloads)

    # Both blocks of a pair of the second part hold the same returns.
    assert len(shots["t_ns"]) == 10 * 384 + 10 * 192
    assert np.all(np.diff(shots["t_ns"]) >= 0)


def test_an_azimuth_of_exactly_360_degrees_is_zero():
    azimuth, distance, intensity = one_packet()
    distance[0, 0, 0] = 500
    blocks = PacketBlocks(azimuth, distance, intensity)
    payloads = encode_packets(np.array([0]), blocks, model=MODELS["VLP-16"])
    payloads.view("<u2")[0, 1] = 36000

    shots = decode_packets(
        np.array([0]),
        payloads,
        PacketSource(0, MODELS["VLP-16"], WIDE),
        report=ImportReport(),
    )

    assert shots.xyz[0] == pytest.approx(
        [np.cos(np.deg2rad(15)), 0, -np.sin(np.deg2rad(15)) + 0.0112], abs=1e-6
    )


def test_no_packets_give_no_shots():
    decoder = open_decoder(
        PacketSensor(row=0, sensor=sensor(), settings=WIDE, report=ImportReport())
    )

    shots = decoder.push(np.zeros(0, np.int64), np.zeros((0, 1206), np.uint8))

    assert len(shots) == 0
    assert len(decoder.flush()) == 0
    assert np.isnan(decoder.rotation_hz)


@pytest.mark.parametrize(
    ("model", "words"),
    [
        ("HDL-64E", "need the calibration of the very sensor"),
        ("generic", "decoded: VLP-16, VLP-16 Hi-Res, VLP-32C, HDL-32E"),
    ],
)
def test_a_model_without_tables_is_refused_in_words(model, words):
    with pytest.raises(ConfigError, match=words):
        open_decoder(
            PacketSensor(row=0, sensor=sensor(model=model), settings=WIDE, report=ImportReport())
        )


@pytest.mark.parametrize("hz", [5.0, 10.0, 20.0])
def test_the_rotation_rate_is_measured(hz):
    report = ImportReport()
    decoder = open_decoder(PacketSensor(row=0, sensor=sensor(), settings=WIDE, report=report))

    decoder.push(*spin(300, hz=hz))

    assert decoder.rotation_hz == pytest.approx(hz, rel=1e-3)


def test_times_are_those_of_the_sensor_plus_the_offset_of_the_rig():
    report = ImportReport()
    decoder = open_decoder(
        PacketSensor(row=0, sensor=sensor(time_offset_s=0.25), settings=WIDE, report=report)
    )

    t_ns, payloads = spin(50)
    decoder.push(t_ns, payloads)
    shots = decoder.flush()

    assert shots.t_ns[0] == T0_NS + 250_000_000
    assert shots.t_ns[-1] <= t_ns[-1] - LATENCY_NS + 250_000_000 + 1_327_104
    assert np.all(np.diff(shots.t_ns) >= 0)
