"""Gaps in which the carrier walked on as before: the clocks were set ahead."""

from dataclasses import replace

import pytest

from recon4.registration.clock_jumps import clock_jumps
from recon4.units import SECOND_NS
from tests.room_walks import FRAME_NS, T0_NS
from tests.scanned_room import scan, standing, strolling, walk

ROW = 6
"""First multiframe after the gap."""


def with_gap(pose, seconds, *, away_s=0.0):
    """A walk of 12 multiframes and a gap; the body goes on for ``away_s`` of it."""
    made = walk(pose, 2 * ROW, with_imu=False, columns=360)
    gap_ns = round(seconds * SECOND_NS)
    for k in range(ROW, len(made)):
        seen = made[k]
        if away_s:
            t_ns = T0_NS + k * FRAME_NS + round(away_s * SECOND_NS)
            seen = scan(pose, t_ns, frame_id=k, columns=360)
        made.frames[k] = replace(seen, t_ns=T0_NS + k * FRAME_NS + gap_ns)
    return made


def found(made):
    return clock_jumps(made, made.index["t_ns"])


@pytest.mark.parametrize("seconds", [37.0, 7.25])
def test_who_walks_on_at_the_same_place_shows_that_the_clocks_were_set(seconds):
    (jump,) = found(with_gap(strolling, seconds))

    assert jump.t_ns <= T0_NS + ROW * FRAME_NS < jump.t_ns + jump.length_ns
    assert jump.length_ns == pytest.approx(seconds * SECOND_NS, abs=FRAME_NS / 300)


@pytest.mark.parametrize(("row", "kept"), [(ROW - 1, slice(0, 1)), (ROW, slice(-1, None))])
def test_a_single_point_at_a_gap_has_a_time(row, kept):
    made = with_gap(strolling, 37.0)
    made.frames[row] = made.frames[row].take(kept)

    (jump,) = found(made)

    assert jump.length_ns == pytest.approx(37 * SECOND_NS + FRAME_NS, abs=FRAME_NS / 300)


@pytest.mark.parametrize(
    ("pose", "seconds", "away_s"),
    [(strolling, 3.0, 3.0), (strolling, 37.0, 4.0), (standing, 37.0, 0.0), (strolling, 1.0, 0.0)],
    ids=["went on", "elsewhere", "stands", "short"],
)
def test_other_gaps_stay(pose, seconds, away_s):
    assert not found(with_gap(pose, seconds, away_s=away_s))


def test_who_was_elsewhere_right_after_a_gap_shows_that_time_passed():
    """Key scans: a gap of 3.6 s, the next one 4.3 m away, and the one after it back on the path."""
    made = with_gap(strolling, 37.0)
    away = scan(strolling, T0_NS + 40 * FRAME_NS, frame_id=ROW, columns=360)
    made.frames[ROW] = replace(away, t_ns=made.frames[ROW].t_ns)

    assert not found(made)


def test_a_gap_at_the_ends_of_a_walk_stays():
    made = with_gap(strolling, 37.0)
    made.frames = made.frames[3:]

    assert not found(made)
