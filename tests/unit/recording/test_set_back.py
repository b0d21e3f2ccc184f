"""Clouds that come too often because their clock went back."""

import numpy as np
import pytest

from recon4.recording.clocks.set_back import SetBack

PERIOD_NS = 100_000_000


def backs(starts_ns):
    clock = SetBack()
    return [back for back in map(clock.back_ns, starts_ns) if back]


def starts(back_ns, *, jitter_ns=0.0, count=60):
    """Even starts of clouds, by time; the clock goes back before the thirtieth."""
    t_ns = np.arange(count) * PERIOD_NS
    t_ns[30:] -= back_ns
    t_ns = t_ns + (jitter_ns * np.random.default_rng(1).standard_normal(count)).astype(np.int64)
    return np.sort(t_ns).tolist()


@pytest.mark.parametrize("back_ms", [30, 80, 130, 270])
def test_a_clock_that_went_back_is_said_once(back_ms):
    found = backs(starts(back_ms * 1_000_000, jitter_ns=5e5))

    assert len(found) == 1
    assert found[0] == pytest.approx(back_ms * 1e6, abs=4e6)


@pytest.mark.parametrize("back_ms", [-80, 0, 20])
def test_even_clouds_and_a_pause_say_nothing(back_ms):
    assert not backs(starts(back_ms * 1_000_000))


def test_clouds_that_come_late_or_are_missing_say_nothing():
    t_ns = np.array(starts(0))
    t_ns[[20, 33]] += 60_000_000  # late by more than half a revolution

    assert not backs(t_ns.tolist())
    assert not backs(np.delete(t_ns, [10, 11, 40]).tolist())
    assert not backs(starts(0, jitter_ns=1.5e7))
