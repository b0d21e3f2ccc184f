"""What the phones are shown: each gets what it lacks, no more."""

import base64

import numpy as np

from app.live.stream_state import Cursor, StreamState

SECOND_NS = 1_000_000_000


def pose(t_s, x, lost=False):
    return {"kind": "pose", "t_ns": int(t_s * SECOND_NS), "p": [x, 0.0, 1.0], "lost": lost}


def points(start, count, generation=0):
    return {
        "kind": "points",
        "generation": generation,
        "start": start,
        "voxel_m": 0.1,
        "voxels": base64.b64encode(np.full((count, 3), start, np.int16).tobytes()).decode(),
        "values": base64.b64encode(np.zeros(count, np.uint8).tobytes()).decode(),
    }


def mark(t_s, text, what="point"):
    return {"kind": "mark", "t_ns": int(t_s * SECOND_NS), "what": what, "text": text}


def marks_of(picture):
    return picture.lacking(Cursor())[0].get("marks", {"marks": []})["marks"]


def test_a_phone_that_comes_back_gets_only_what_it_lacks():
    picture = StreamState()
    picture.take(points(0, 1000))
    cursor = Cursor(generation=0, points=1000)

    told, data = picture.lacking(cursor)
    assert "points" not in told and data == b""
    picture.take(points(1000, 10))
    told, data = picture.lacking(cursor)

    assert (told["points"]["start"], told["points"]["count"], len(data)) == (1000, 10, 70)


def test_a_phone_with_points_of_larger_number_or_other_generation_begins_anew():
    picture = StreamState()
    picture.take(points(0, 50, generation=1))

    for cursor in (Cursor(generation=0, points=1000), Cursor(generation=1, points=51)):
        assert picture.lacking(cursor)[0]["points"]["start"] == 0


def test_a_mark_lies_where_one_was_although_the_mapping_is_late():
    picture = StreamState()
    picture.take(pose(1.0, 10.0))
    picture.take(mark(3.0, "crack"))
    assert marks_of(picture) == []

    picture.take(pose(2.0, 20.0))
    assert marks_of(picture) == []
    picture.take(pose(3.0, 30.0))

    assert [(one["text"], one["p"][0]) for one in marks_of(picture)] == [("crack", 30.0)]


def test_a_mark_appears_without_mapping_too_and_a_name_at_once():
    picture = StreamState()
    picture.take(mark(3.0, "town hall", what="place"))
    assert [one["text"] for one in marks_of(picture)] == ["town hall"]
    picture.take(mark(3.0, "crack"))
    picture.take({"kind": "status", "t_ns": 14 * SECOND_NS})

    assert [(one["text"], one["p"]) for one in marks_of(picture)] == [
        ("town hall", None),
        ("crack", None),
    ]


def test_an_hour_of_standing_is_one_place_of_the_way():
    picture = StreamState()
    for k in range(1000):
        picture.take(pose(k * 0.1, 0.001 * (k % 2)))
    picture.take(pose(101.0, 5.0))

    assert picture.lacking(Cursor())[0]["path"]["points"] == [[0.0, 0.0, 1.0], [5.0, 0.0, 1.0]]


def test_a_mark_lies_where_one_was_when_it_was_touched_not_where_its_note_was_finished():
    picture = StreamState()
    for second in range(1, 9):
        picture.take(pose(second, 10.0 * second))

    picture.take(mark(3.0, "crack"))
    picture.take(pose(9.0, 90.0))

    assert [one["p"][0] for one in marks_of(picture)] == [30.0]


def test_marks_of_an_earlier_server_are_not_told_twice_and_later_ones_come():
    picture = StreamState()
    picture.recall([mark(1.0, "town hall", what="place"), mark(2.0, "crack")])
    there, new = Cursor(marks=2), Cursor()
    picture.take(pose(3.0, 1.0))

    assert "marks" not in picture.lacking(there)[0]
    assert [one["text"] for one in picture.lacking(new)[0]["marks"]["marks"]] == [
        "town hall",
        "crack",
    ]
    picture.take(mark(3.0, "door"))
    picture.take(pose(4.0, 2.0))
    assert picture.lacking(there)[0]["marks"]["start"] == 2


def test_a_phone_that_knows_of_more_marks_than_there_are_gets_all():
    picture = StreamState()
    picture.recall([mark(1.0, "crack")])

    assert picture.lacking(Cursor(marks=3))[0]["marks"]["start"] == 0
