"""What the phone says of the map while the walk goes on."""

import pytest

from recon4.live.findings_so_far import WalkSoFar
from recon4.live.tuning import STRETCHES
from recon4.model.odometry_figures import ImuAxes, ImuTurn
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


@pytest.mark.parametrize(
    ("language", "turned", "exchanged"),
    [
        ("en", "Map so far: check. The IMU is mounted otherwise", "turn rates are (x, y, -z)"),
        ("de", "Karte bisher: prüfen. Die IMU ist anders eingebaut", "Drehraten (x, y, -z)"),
    ],
)
def test_axes_of_an_imu_that_were_repaired_stay_said_in_the_words_of_the_report(
    language, turned, exchanged
):
    turn = ImuTurn(angle_rad=3.1, explained=0.3, explained_turned=0.99, rpy_deg=(180.0, 0.0, 0.0))
    axes = ImuAxes(gyro="x, y, -z", accel="x, y, z")
    so_far = walked((10, GOOD), (10, {"imu_turn": turn, "imu_axes": axes}), (10, GOOD))

    (said,) = so_far.findings(records=True, language=language)

    assert said.level == "warning"
    assert said.text.startswith(turned)
    assert exchanged in said.text


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


def stretches(*parts):
    """Kind, first and last x of each marked stretch of a walk along x at 1 m/s and 10 Hz."""
    so_far, k = WalkSoFar(), 0
    for count, changed in parts:
        for _ in range(count):
            so_far.take(pose(frame_id=k, t_ns=k * 100_000_000, p=[k / 10, 0.0, 0.0], **changed))
            k += 1
    return [(one.kind, one.p[0][0], one.p[-1][0]) for one in so_far.stretches.marked]


@pytest.mark.parametrize(
    ("parts", "expected"),
    [
        ([(100, GOOD)], []),
        ([(50, GOOD), (20, LOST), (50, GOOD)], [("TRACKING-LOST", 5.0, 6.5)]),
        ([(50, GOOD), (15, WEAK), (50, GOOD)], []),  # too short for a finding
        ([(50, GOOD), (60, WEAK), (50, GOOD)], [("WEAK-DIRECTION", 5.0, 10.5)]),
        (
            [(50, GOOD), (60, WEAK), (30, LOST)],
            [("WEAK-DIRECTION", 5.0, 10.5), ("TRACKING-LOST", 11.0, 13.5)],
        ),
        (
            [(10, LOST), (10, GOOD), (10, LOST)],
            [("TRACKING-LOST", 0.0, 0.5), ("TRACKING-LOST", 2.0, 2.5)],
        ),
    ],
)
def test_the_stretches_of_findings_are_marked_where_they_were(parts, expected):
    assert stretches(*parts) == expected


def test_a_long_stretch_goes_on_as_another_and_all_together_are_bounded():
    found = stretches((1500, LOST))

    assert len(found) == 2 and found[0][2] == found[1][1]
    assert len(stretches(*[(1, LOST), (1, GOOD)] * 300)) == STRETCHES.most_stretches
