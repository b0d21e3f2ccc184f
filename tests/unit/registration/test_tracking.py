"""The state machine of tracking: who owns pieces, losses and resets."""

import pytest

from recon4.registration.tracking import NEXT, Mode, Seen, TrackingState
from recon4.settings import OdometrySettings


def after(*seen: Seen) -> TrackingState:
    tracking = TrackingState(OdometrySettings())
    for one in seen:
        tracking.next(one)
    return tracking


def test_a_walk_begins_with_a_map_to_make_and_ends_in_one_piece():
    tracking = after(*[Seen.FITS] * 5)

    assert (tracking.mode, tracking.piece, tracking.lost_frames) == (Mode.TRACKING, 0, 0)


def test_a_gap_begins_another_piece_and_a_bridge_does_not():
    assert after(Seen.FITS, Seen.GAP).piece == 1
    assert after(Seen.FITS, Seen.CROSSES_GAP).piece == 0
    assert after(Seen.FITS, Seen.CROSSES_GAP).mode is Mode.BRIDGED


def test_a_gap_right_after_a_restart_is_crossed_like_any_other():
    again = after(Seen.FITS, Seen.MISSES, Seen.SURE_AGAIN, Seen.CROSSES_GAP)

    assert (again.mode, again.piece) == (Mode.BRIDGED, 1)


def test_lost_frames_are_counted_in_a_row():
    assert after(Seen.FITS, Seen.MISSES, Seen.MISSES).lost_frames == 2
    assert after(Seen.FITS, Seen.MISSES, Seen.FITS).lost_frames == 0


def test_after_a_long_loss_only_the_map_begins_again_if_it_was_trusted():
    trusted = after(*[Seen.FITS] * 40, Seen.MISSES, Seen.LOST_FOR_LONG)

    assert (trusted.mode, trusted.piece) == (Mode.RESTARTED, 0)
    assert after(Seen.FITS, Seen.MISSES, Seen.LOST_FOR_LONG).piece == 0  # nothing was before


def test_a_map_that_is_lost_soon_after_a_reset_is_of_another_piece():
    lost = [Seen.FITS, Seen.MISSES, Seen.LOST_FOR_LONG]

    assert after(*lost, *lost).piece == 1


def test_fixes_end_a_loss_and_keep_the_map():
    placed = after(Seen.FITS, Seen.MISSES, Seen.PLACED)

    assert (placed.mode, placed.piece, placed.lost_frames) == (Mode.PLACED, 0, 0)
    assert after(Seen.FITS, Seen.PLACED, Seen.FITS).mode is Mode.TRACKING


def test_without_an_imu_sure_scans_begin_another_piece():
    assert after(Seen.FITS, Seen.MISSES, Seen.SURE_AGAIN).piece == 1


def test_the_velocity_is_known_after_two_tracked_frames():
    assert not after(Seen.FITS).is_velocity_known
    assert after(Seen.FITS, Seen.FITS).is_velocity_known
    assert not after(Seen.FITS, Seen.FITS, Seen.MISSES).is_velocity_known
    assert not after(Seen.FITS, Seen.FITS, Seen.GAP).is_velocity_known


def test_what_is_not_in_the_table_is_an_error():
    with pytest.raises(KeyError):
        after(Seen.FITS, Seen.SURE_AGAIN)
    assert {mode for mode, _ in NEXT} == set(Mode)
