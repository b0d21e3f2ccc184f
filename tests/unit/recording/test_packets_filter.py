"""What becomes of damaged, repeated, shuffled and foreign packets."""

import numpy as np
import pytest

from recon4.recording.packets.decoder import open_decoder
from recon4.recording.packets.family import PacketSensor
from recon4.recording.packets.packet_order import PacketOrder
from recon4.recording.packets.velodyne.sound_packets import as_packets
from recon4.recording.report import ImportReport
from recon4.settings import IngestSettings
from recon4.units import SECOND_NS
from tests.unit.recording.packet_builders import T0_NS, WIDE, decode_all, sensor, spin
from tests.warned import K, warned


@pytest.fixture(scope="module")
def clean():
    t_ns, payloads = spin(1500)
    shots, report = decode_all(t_ns, payloads)
    assert report.counts["points"] == len(shots["t_ns"]) == 1500 * 384
    return t_ns, payloads, shots


def assert_same_points(shots, clean_shots):
    for name, column in clean_shots.items():
        np.testing.assert_array_equal(shots[name], column, err_msg=name)


def test_ten_percent_garbage_is_dropped_and_counted(clean):
    t_ns, payloads, expected = clean
    rng = np.random.default_rng(1)
    places = np.sort(rng.integers(0, len(t_ns), 150))
    garbage = rng.integers(0, 256, (150, 1206), dtype=np.uint8)

    shots, report = decode_all(
        np.insert(t_ns, places, t_ns[places]), np.insert(payloads, places, garbage, axis=0)
    )

    assert_same_points(shots, expected)
    assert report.counts["packets_wrong_flag"] == 150


def test_garbage_with_sound_flags_does_not_spoil_the_rest(clean):
    t_ns, payloads, expected = clean
    rng = np.random.default_rng(2)
    places = np.sort(rng.choice(len(t_ns), 150, replace=False))
    garbage = rng.integers(0, 256, (150, 1206), dtype=np.uint8)
    for block in range(12):
        garbage[:, 100 * block : 100 * block + 2] = (0xFF, 0xEE)

    shots, report = decode_all(
        np.insert(t_ns, places, t_ns[places]), np.insert(payloads, places, garbage, axis=0)
    )

    assert_same_points(shots, expected)
    dropped = {k: v for k, v in report.counts.items() if k.startswith("packets_")}
    assert sum(dropped.values()) == 150


@pytest.mark.parametrize("apart", [1, 40, 300])
def test_a_packet_that_comes_twice_is_decoded_once(clean, apart):
    t_ns, payloads, expected = clean
    again = np.arange(0, len(t_ns) - apart, 5)
    order = np.argsort(np.concatenate([np.arange(len(t_ns)), again + apart + 0.5]), kind="stable")
    rows = np.concatenate([np.arange(len(t_ns)), again])[order]

    shots, report = decode_all(t_ns[rows], payloads[rows])

    assert_same_points(shots, expected)
    assert report.counts["packets_duplicate"] + report.counts["packets_late"] == len(again)
    assert report.counts["packets_late"] == 0


def test_packets_shuffled_within_the_window_are_put_in_order(clean):
    t_ns, payloads, expected = clean
    rng = np.random.default_rng(3)
    # 140 packets of 1.327 ms are 186 ms.
    rows = np.argsort(np.arange(len(t_ns)) + rng.uniform(0, 140, len(t_ns)), kind="stable")

    shots, report = decode_all(t_ns[rows], payloads[rows])

    assert_same_points(shots, expected)
    assert report.counts["packets_out_of_order"] > 500
    assert report.counts["packets_late"] == 0


def test_garbage_duplicates_and_shuffle_together_change_nothing(clean):
    t_ns, payloads, expected = clean
    rng = np.random.default_rng(4)
    rows = np.concatenate([np.arange(1500), rng.integers(0, 1500, 150)])
    rows = rows[np.argsort(rows + rng.uniform(0, 140, len(rows)), kind="stable")]
    places = np.sort(rng.integers(0, len(rows), 160))
    garbage = rng.integers(0, 256, (160, 1206), dtype=np.uint8)

    shots, _ = decode_all(
        np.insert(t_ns[rows], places, t_ns[rows[places]]),
        np.insert(payloads[rows], places, garbage, axis=0),
    )

    assert_same_points(shots, expected)


def test_a_packet_that_is_later_than_the_window_is_dropped_and_counted(clean):
    t_ns, payloads, expected = clean
    rows = np.concatenate([np.delete(np.arange(1000), 10), [10], np.arange(1000, 1500)])

    shots, report = decode_all(t_ns[rows], payloads[rows])

    assert report.counts["packets_late"] == 1
    assert len(shots["t_ns"]) == len(expected["t_ns"]) - 384
    assert np.all(np.diff(shots["t_ns"]) >= 0)


def test_lost_packets_are_counted(clean):
    t_ns, payloads, _ = clean
    rows = np.delete(np.arange(len(t_ns)), [100, 101, 102, 700])

    _, report = decode_all(t_ns[rows], payloads[rows])

    assert report.counts["packets_missing"] == 4
    assert sum(n for name, n in report.counts.items() if name.startswith("packets_missing_")) == 4


def in_view(payloads, *, first_deg, last_deg):
    """Rows of the packets that a sensor sends which is set to a field of view."""
    azimuth = as_packets(payloads)["blocks"]["azimuth_cdeg"][:, 0] / 100.0
    return np.flatnonzero((azimuth - first_deg) % 360 <= (last_deg - first_deg) % 360)


@pytest.mark.parametrize("view", [(270, 90), (0, 330), (45, 60)])
def test_a_field_of_view_is_no_loss_of_packets(clean, view):
    t_ns, payloads, _ = clean
    rows = in_view(payloads, first_deg=view[0], last_deg=view[1])

    _, report = decode_all(t_ns[rows], payloads[rows])

    assert report.counts["packets_missing"] == 0


def test_losses_within_a_field_of_view_are_counted(clean):
    t_ns, payloads, _ = clean
    rows = in_view(payloads, first_deg=270, last_deg=90)
    kept = np.delete(rows, [250, 251, 400])

    _, report = decode_all(t_ns[kept], payloads[kept])

    assert report.counts["packets_missing"] == 3


def test_a_loss_of_every_other_packet_is_no_field_of_view(clean):
    t_ns, payloads, _ = clean

    _, report = decode_all(t_ns[::2], payloads[::2])

    assert report.counts["packets_missing"] == len(t_ns) // 2 - 1


def test_packets_of_another_length_are_dropped_and_counted():
    report = ImportReport()
    decoder = open_decoder(
        PacketSensor(row=0, sensor=sensor(), settings=IngestSettings(), report=report)
    )

    shots = decoder.push(np.arange(5), np.zeros((5, 1248), np.uint8))

    assert len(shots) == 0
    assert report.counts == {"packets": 5, "packets_wrong_length": 5}


def test_packets_of_an_hdl64_are_named_as_such():
    t_ns, payloads = spin(3)
    for block in range(1, 12, 2):
        payloads[:, 100 * block + 1] = 0xDD

    _, report = decode_all(t_ns, payloads)

    assert report.counts["packets_hdl64"] == 3


def test_a_stranger_among_the_packets_is_dropped_by_its_product_byte(clean):
    t_ns, payloads, _ = clean
    payloads = payloads[:200].copy()
    payloads[50:60, -1] = 0x28

    shots, report = decode_all(t_ns[:200], payloads)

    assert report.counts["packets_other_product"] == 10
    assert len(shots["t_ns"]) == 190 * 384


def test_a_wrong_product_byte_does_not_change_the_points_but_is_reported(clean):
    t_ns, payloads, expected = clean
    payloads = payloads.copy()
    payloads[:, -1] = 0x21

    shots, report = decode_all(t_ns, payloads)

    assert_same_points(shots, expected)
    assert warned(report, K.MODEL_CONTRADICTED, says="HDL-32E (0x21)", model="VLP-16")


def test_a_model_that_the_firing_pattern_contradicts_is_warned_of(clean):
    t_ns, payloads, _ = clean

    _, report = decode_all(t_ns, payloads, model="HDL-32E")

    assert warned(report, K.MODEL_UNLIKELY, likely="VLP-16")


def test_the_order_gives_nothing_before_the_window_has_passed():
    order = PacketOrder(200_000_000, ImportReport())
    payload = np.zeros((1, 1206), np.uint8)

    early, _ = order.push(np.array([T0_NS]), payload)
    later, _ = order.push(np.array([T0_NS + 200_000_001]), payload)

    assert (early.tolist(), later.tolist()) == ([], [T0_NS])
    assert order.flush()[0].tolist() == [T0_NS + 200_000_001]


@pytest.mark.parametrize("batch", [1, 40, 75, 1500])
def test_clocks_set_back_together_lose_no_packet(clean, batch):
    t_ns, payloads, _ = clean
    back_ns = np.where(np.arange(len(t_ns)) < 700, 0, 30 * SECOND_NS)
    order = PacketOrder(window_ns=SECOND_NS // 5, report=ImportReport())

    parts = [
        order.push((t_ns - back_ns)[first : first + batch], payloads[first : first + batch])
        for first in range(0, len(t_ns), batch)
    ]
    found = np.concatenate([t for t, _ in [*parts, order.flush()]])

    lost = order.report.counts["packets_late"]
    assert lost == (7 if batch == 1 else 0)
    assert len(found) == len(t_ns) - lost
    assert np.count_nonzero(np.diff(found) < 0) == 1


def test_packets_that_follow_each_other_wait_for_nobody_and_a_hole_is_waited_for():
    step_ns, report = 1_327_104, ImportReport()
    order = PacketOrder(200_000_000, report, step_ns=step_ns)

    def given(*numbers):
        t_ns = step_ns * np.array(numbers, dtype=np.int64)
        payloads = np.zeros((len(t_ns), 1206), np.uint8)
        return (order.push(t_ns, payloads)[0] // step_ns).tolist()

    given(*range(100))
    flowing = given(*range(100, 175)) + given(*range(175, 250))
    holed = given(*range(250, 300), *range(301, 325))
    filled = given(300, *range(325, 330))
    never = given(*range(331, 350))
    much_later = given(*range(350, 510))

    assert flowing[-1] == 249
    assert holed == list(range(250, 300))
    assert filled == list(range(300, 330))
    assert never == []
    assert much_later[0] == 331
    assert given(510)[-1] == 510
    assert report.counts["packets_out_of_order"] == 1
    assert report.counts["packets_late"] == 0


def test_many_packets_are_decoded_in_parts_of_a_tenth_of_a_second(clean):
    t_ns, payloads, expected = clean
    of = PacketSensor(row=0, sensor=sensor(), settings=WIDE, report=ImportReport())
    decoder = open_decoder(of)

    parts = list(decoder.push_in_parts(t_ns, payloads))

    assert len(parts) > 10 and max(map(len, parts)) <= 76 * 384
    assert sum(map(len, parts)) + len(decoder.flush()) == len(expected["t_ns"])
