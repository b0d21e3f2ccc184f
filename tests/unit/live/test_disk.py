"""How long the disk lasts."""

from pathlib import Path

from recon4.live.protocol import DiskState
from recon4.live.recorder.disk import DiskWatch


def watch(*free_bytes, least=1000, every_s=1.0):
    left = iter(free_bytes)
    disk = DiskWatch(Path("x"), least_free_bytes=least, free_bytes=lambda folder: next(left))
    for k in range(len(free_bytes)):
        disk.update(k * every_s)
    return disk.state


def test_everything_that_fills_the_disk_counts():
    state = watch(*(100_000_000 - 12_000_000 * k for k in range(8)), least=4_000_000)

    assert state == DiskState(free_bytes=16_000_000, left_s=1, enough=True)


def test_a_disk_that_nobody_fills_lasts():
    assert watch(*[10**9] * 20).left_s is None
    assert watch(*(10**9 + k for k in range(20))).left_s is None


def test_in_the_first_seconds_nothing_is_said():
    assert watch(10**9, 10**8, 10**7).left_s is None


def test_what_was_freed_a_while_ago_is_forgotten():
    early, late = [10**9] * 30, [10**10 - 10**7 * k for k in range(70)]

    assert watch(*early, *late).left_s == round((late[-1] - 1000) / 10**7)


def test_too_little_is_said_at_once():
    assert not watch(999).enough
    assert watch(1001).enough


def test_a_disk_that_was_pulled_out_stops_nothing():
    def gone(folder):
        raise OSError(5, "Input/output error")

    disk = DiskWatch(Path("x"), least_free_bytes=1000, free_bytes=gone)
    disk.update(0.0)

    assert disk.state == DiskState()
