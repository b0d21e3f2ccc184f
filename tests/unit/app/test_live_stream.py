"""Each phone gets the part of the state it lacks, no more."""

import numpy as np
from msgspec import UNSET

from recon4.live.protocol import Mark, Points
from recon4_app.live.stream_state import Cursor, StreamState
from tests import live_messages

SECOND_NS = 1_000_000_000


def pose(t_s, x):
    return live_messages.pose(t_ns=int(t_s * SECOND_NS), p=[x, 0.0, 1.0])


def points(start, count, generation=0):
    voxels = np.full((count, 3), start, np.int16).tobytes()
    return Points(generation, start, count, 0.1, voxels, bytes(count))


def mark(t_s, text, what="point"):
    return Mark(int(t_s * SECOND_NS), what, text, "Eva")


def marks_of(stream):
    part = stream.lacking(Cursor())[0].marks
    return part.marks if part else []


def test_a_phone_that_reconnects_gets_only_what_it_lacks():
    stream = StreamState()
    stream.take(points(0, 1000))
    cursor = Cursor(generation=0, points=1000)

    message, data = stream.lacking(cursor)
    assert message.points is UNSET and data == b""
    stream.take(points(1000, 10))
    message, data = stream.lacking(cursor)

    assert (message.points.start, message.points.count, len(data)) == (1000, 10, 70)


def test_a_phone_with_points_of_larger_number_or_other_generation_gets_all_points():
    stream = StreamState()
    stream.take(points(0, 50, generation=1))

    for cursor in (Cursor(generation=0, points=1000), Cursor(generation=1, points=51)):
        assert stream.lacking(cursor)[0].points.start == 0


def test_a_mark_gets_the_position_of_its_time_although_the_mapping_is_late():
    stream = StreamState()
    stream.take(pose(1.0, 10.0))
    stream.take(mark(3.0, "crack"))
    assert marks_of(stream) == []

    stream.take(pose(2.0, 20.0))
    assert marks_of(stream) == []
    stream.take(pose(3.0, 30.0))

    assert [(one.text, one.p[0]) for one in marks_of(stream)] == [("crack", 30.0)]


def test_a_mark_appears_without_mapping_too_and_a_place_name_at_once():
    stream = StreamState()
    stream.take(mark(3.0, "town hall", what="place"))
    assert [one.text for one in marks_of(stream)] == ["town hall"]
    stream.take(mark(3.0, "crack"))
    stream.take(live_messages.status(t_ns=14 * SECOND_NS))

    assert [(one.text, one.p) for one in marks_of(stream)] == [
        ("town hall", None),
        ("crack", None),
    ]


def test_an_hour_of_standing_is_one_place_of_the_path():
    stream = StreamState()
    for k in range(1000):
        stream.take(pose(k * 0.1, 0.001 * (k % 2)))
    stream.take(pose(101.0, 5.0))

    assert stream.lacking(Cursor())[0].path.points == [[0.0, 0.0, 1.0], [5.0, 0.0, 1.0]]


def test_a_mark_gets_the_position_of_the_touch_not_of_the_finished_note():
    stream = StreamState()
    for second in range(1, 9):
        stream.take(pose(second, 10.0 * second))

    stream.take(mark(3.0, "crack"))
    stream.take(pose(9.0, 90.0))

    assert [one.p[0] for one in marks_of(stream)] == [30.0]


def test_marks_of_an_earlier_server_are_not_sent_twice_and_later_ones_come():
    stream = StreamState()
    stream.restore_marks([mark(1.0, "town hall", what="place"), mark(2.0, "crack")])
    there, new = Cursor(marks=2), Cursor()
    stream.take(pose(3.0, 1.0))

    assert stream.lacking(there)[0].marks is UNSET
    assert [one.text for one in stream.lacking(new)[0].marks.marks] == [
        "town hall",
        "crack",
    ]
    stream.take(mark(3.0, "door"))
    stream.take(pose(4.0, 2.0))
    assert stream.lacking(there)[0].marks.start == 2


def test_a_phone_with_more_marks_than_there_are_gets_all():
    stream = StreamState()
    stream.restore_marks([mark(1.0, "crack")])

    assert stream.lacking(Cursor(marks=3))[0].marks.start == 0


def test_a_phone_gets_each_stretch_of_a_finding_once_and_the_last_while_it_grows():
    stream, cursor = StreamState(), Cursor()

    def walked(*seconds, lost):
        for second in seconds:
            stream.take(
                live_messages.pose(t_ns=second * SECOND_NS, p=[second, 0.0, 1.0], lost=lost)
            )
        part = stream.lacking(cursor)[0].stretches
        return (
            UNSET if part is UNSET else (part.start, [[p[0] for p in s.p] for s in part.stretches])
        )

    assert walked(1, lost=False) is UNSET
    assert walked(2, 3, lost=True) == (0, [[2, 3]])
    assert walked(lost=True) is UNSET
    assert walked(4, lost=True) == (0, [[2, 3, 4]])
    walked(5, lost=False)
    assert walked(6, lost=True) == (0, [[2, 3, 4], [6]])
    assert walked(7, lost=True) == (1, [[6, 7]])
    again = stream.lacking(Cursor())[0].stretches
    assert (again.start, len(again.stretches)) == (0, 2)
