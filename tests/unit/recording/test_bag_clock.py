"""Bags whose recorder was set back while it wrote, and those that are only in another order."""

import numpy as np
import pytest
from msgspec import structs

from recon4.recording.formats import bag_clock
from recon4.recording.formats.bag_clock import rows_going_on
from recon4.recording.info.describe import describe
from tests.builders import T0_NS, Bag, bag_path, room_cloud
from tests.unit.recording.point_bags import read
from tests.warned import K, kinds, warned

STEP_NS, FRAMES, AT = 100_000_000, 24, 12


def write(folder, kind, *, back_s, stamps_too, imu_hz=50):
    """Clouds at 10 Hz and an IMU; the clock goes back before the cloud ``AT``."""
    each = imu_hz // 10
    path = bag_path(folder, kind)
    with Bag(path, kind) as bag:
        bag.writer.chunk_threshold = 32 * 1024
        for k in range(FRAMES):
            back_ns = round(back_s * 1e9) if k >= AT else 0
            for j in range(each):
                t_ns = T0_NS + k * STEP_NS + j * STEP_NS // each
                bag.recorded_ns = t_ns - back_ns
                stamp_ns = t_ns - back_ns * stamps_too
                if not j:
                    cloud = room_cloud(columns_per_turn=36)
                    bag.cloud("/points", stamp_ns, cloud | {"intensity": cloud["ring"] * 0 + k})
                bag.imu("/imu", stamp_ns, (0.01, 0.02 * j, 0.3), (0.1, 0.01 * j, 9.8))
    return path


@pytest.mark.parametrize("stamps_too", [False, True], ids=["recorder", "both"])
@pytest.mark.parametrize(
    ("kind", "back_s", "whole"),
    [
        ("bag1", 1.7, True),
        ("bag1", 0.3, False),
        ("db3", 0.08, True),
        ("db3", 0.3, True),
        ("mcap", 0.08, True),
        ("mcap", 37.0, True),
    ],
)
def test_a_bag_goes_on_where_its_recorder_was_set_back(
    tmp_path, monkeypatch, kind, back_s, whole, stamps_too
):
    if not whole:
        small = structs.replace(bag_clock.RECORDER_STEPS, whole_bytes=0)
        monkeypatch.setattr(bag_clock, "RECORDER_STEPS", small)
    path = write(tmp_path, kind, back_s=back_s, stamps_too=stamps_too, imu_hz=200)

    _, shots, report = read(path)

    assert [int(np.median(one.intensity)) for one in shots] == list(range(FRAMES))
    starts = np.array([one.t_ns[0] for one in shots])
    assert np.allclose(np.diff(starts), STEP_NS, atol=1_000_000)
    assert report.counts["clock_jumps_back"] == 1
    assert not report.counts["clouds_late"] and not report.counts["imu_unsorted"]
    assert kinds(report).count(K.CLOCK_JUMP) == 1
    found = describe(path)
    assert warned(found, K.CLOCK_JUMP, whose="recorder", jump_s=-back_s)
    assert found.seconds == pytest.approx(2.395, abs=0.02)


@pytest.mark.parametrize("stamps_too", [False, True], ids=["recorder", "both"])
def test_a_large_file_goes_on_within_a_chunk(tmp_path, monkeypatch, stamps_too):
    small = structs.replace(bag_clock.RECORDER_STEPS, whole_bytes=0)
    monkeypatch.setattr(bag_clock, "RECORDER_STEPS", small)
    path = write(tmp_path, "mcap", back_s=0.08, stamps_too=stamps_too, imu_hz=200)

    _, shots, report = read(path)

    assert [int(np.median(one.intensity)) for one in shots] == list(range(FRAMES))
    starts = np.array([one.t_ns[0] for one in shots])
    assert np.allclose(np.diff(starts), STEP_NS, atol=1_000_000)
    assert warned(report, K.CLOCK_JUMP, whose="recorder", jump_s=-0.08)


def rows(*parts):
    """Times [ns] and topics of parts of a file: begin, end [s], topics."""
    t_ns, topic = [], []
    for begin, end, topics in parts:
        for t in np.arange(begin, end, 0.1):
            t_ns += [round(t * 1e9) + k for k in topics]
            topic += topics
    return np.array(t_ns, np.int64), np.array(topic, np.int64)


def test_a_recorder_that_is_set_back_twice_goes_on_twice():
    t_ns, steps = rows_going_on(*rows((100, 110, [1, 2]), (105, 115, [1, 2]), (20, 30, [1, 2])))

    assert [round(step.shift_ns / 1e9) for step in steps] == [5, 95]
    assert np.allclose(np.diff(t_ns[::2]), 1e8, atol=10)


def test_a_message_that_came_late_sets_no_recorder_back():
    t_ns, topic = rows((100, 110, [1, 2]))
    t_ns[20] -= 350_000_000

    went_on, steps = rows_going_on(t_ns, topic)

    assert not steps
    assert np.array_equal(went_on, t_ns)


@pytest.mark.parametrize(
    "parts",
    [
        [(0, 10, [1]), (0, 10, [2])],
        [(10, 20, [1, 2]), (0, 10, [1, 2])],
        [(0, 10, [1]), (5, 20, [2])],
        [(0, 10, [1, 2]), (10, 20, [1, 2])],
        [(0, 10, [1, 2]), (9.9, 20, [2])],
        [(0, 10, [1, 2]), (5, 6, [1]), (10, 20, [1, 2])],
    ],
    ids=["by topic", "swapped", "a topic begins", "in order", "late", "one topic late"],
)
def test_messages_in_another_order_are_no_recorder_that_was_set_back(parts):
    t_ns, topic = rows(*parts)

    assert not rows_going_on(t_ns, topic)[1]
    assert not len(rows_going_on(t_ns[:0], topic[:0])[1])


def test_times_near_the_end_of_all_times_are_not_moved_beyond_it():
    t_ns, topic = rows((0, 10, [1, 2]), (5, 15, [1, 2]))

    assert rows_going_on(t_ns + 2**61, topic)[1]
    assert not rows_going_on(t_ns + (2**62 - 16 * 10**9), topic)[1]
