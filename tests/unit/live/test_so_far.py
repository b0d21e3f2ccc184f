"""What the phone says of the map while the walk goes on."""

import pytest

from recon4.live.so_far import WalkSoFar
from recon4_app.live.stream_state import StreamState
from tests.live_messages import pose


def walked(*parts):
    """A walk at 10 Hz; each part is a count of poses and what they differ in."""
    so_far, k = WalkSoFar(), 0
    for count, changed in parts:
        for _ in range(count):
            so_far.take(pose(frame_id=k, t_ns=k * 100_000_000, **changed))
            k += 1
    return so_far


GOOD, LOST, WEAK = {"weak_sd_m": 0.01}, {"lost": True}, {"weak_sd_m": 0.5}


@pytest.mark.parametrize(
    ("parts", "text"),
    [
        ([(100, GOOD)], None),
        ([(50, GOOD), (15, WEAK), (50, GOOD)], None),  # shorter than what the report counts
        (
            [(50, GOOD), (50, WEAK), (50, GOOD)],
            "check. One direction was hardly observed for 5 s in all.",
        ),
        (
            [(50, GOOD), (120, WEAK)],
            "do not use. One direction was hardly observed for 12 s in all.",
        ),
        (
            [(80, GOOD), (20, LOST)],
            "do not use. Tracking was lost in 20 of 100 multiframes (20.0 %).",
        ),
    ],
)
def test_problems_of_the_walk_are_not_forgotten(parts, text):
    found = walked(*parts).findings(records=True)

    assert [one.text for one in found] == ([] if text is None else [f"Map so far: {text}"])
    assert {one.level for one in found} <= {"warning"}


def test_after_the_walk_an_unusable_map_is_an_error():
    (ended,) = walked((80, GOOD), (20, LOST)).findings(records=False)

    assert ended.level == "error"


def test_a_pause_is_no_weak_stretch_and_a_pose_counts_once():
    so_far = walked((10, GOOD))
    for t_s in (60, 60, 120):
        so_far.take(pose(frame_id=99, t_ns=t_s * 1_000_000_000, **WEAK))

    assert (so_far.multiframes, so_far.unobserved_s) == (12, 0.0)


def test_the_stream_counts_the_poses_of_the_mapper():
    stream = StreamState()
    stream.take(pose(frame_id=3, t_ns=1, lost=True))

    assert stream.so_far.lost == 1
