"""Times without the jumps of clocks that were set ahead while a recording ran."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TypeVar

import numpy as np

from recon4.model.clock_jump import ClockJump
from recon4.model.derived_kinds import DerivedKind
from recon4.model.laser_scans import LaserScans
from recon4.model.samples import GnssSamples, ImuSamples
from recon4.model.trajectory import Times, Trajectory
from recon4.recording.assembly.assembler import moved
from recon4.recording.assembly.shots import Shots
from recon4.recording.clocks.names import known_offset_s, looks_like
from recon4.recording.clocks.tuning import CLOCK_JUMPS
from recon4.recording.openers.request import Item, Recording
from recon4.recording.report import ImportReport
from recon4.units import SECOND_NS

Samples = TypeVar("Samples", ImuSamples, GnssSamples)


def without_jumps(t_ns: Times, jumps: Sequence[ClockJump]) -> Times:
    """Times as if no clock had been set [ns], (N,).

    Args:
        t_ns: As recorded [ns], (N,); nothing was recorded within a jump.
        jumps: Where all clocks were set ahead.
    """
    ahead = np.zeros_like(t_ns)
    for jump in jumps:
        ahead[t_ns > jump.t_ns + jump.length_ns // 2] += exact_length_ns(jump)
    return np.asarray(t_ns - ahead)


def samples_without_jumps(samples: Samples | None, jumps: Sequence[ClockJump]) -> Samples | None:
    """Samples as if no clock had been set; what was measured within a jump shows another clock.

    Args:
        samples: Of the IMU or of GNSS, on the clock of the LiDARs; None = there are none.
        jumps: Where the clocks of the LiDARs were set ahead.
    """
    if samples is None:
        return None
    mine = [jump for jump in jumps if not _measured_within(samples.t_ns, jump)]
    return replace(samples, t_ns=without_jumps(samples.t_ns, mine)) if mine else samples


def _measured_within(t_ns: Times, jump: ClockJump) -> bool:
    since = (t_ns - jump.t_ns) / jump.length_ns
    low, high = CLOCK_JUMPS.within
    return bool(np.any((since > low) & (since < high)))


def exact_length_ns(jump: ClockJump) -> int:
    """By how much a clock was set [ns]: that of a known difference of clocks, if it is near."""
    known_ns = round(known_offset_s(jump.length_ns / SECOND_NS) * SECOND_NS)
    near = abs(known_ns - jump.length_ns) < CLOCK_JUMPS.known_ns
    return known_ns if near else jump.length_ns


def say_jumps(jumps: Sequence[ClockJump], first_ns: int, report: ImportReport) -> None:
    """Count the jumps and state each.

    Args:
        jumps: Where all clocks were set ahead.
        first_ns: First time of the recording [ns].
        report: Receives them.
    """
    report.count("clock_jumps", len(jumps))
    for jump in jumps:
        jump_s = exact_length_ns(jump) / SECOND_NS
        looks = looks_like(jump_s)
        report.derive(
            DerivedKind.CLOCKS_SET,
            at_s=(jump.t_ns - first_ns) / SECOND_NS,
            jump_s=jump_s,
            **({"looks": looks} if looks else {}),
        )


def with_jumps_removed(recording: Recording, jumps: Sequence[ClockJump]) -> Recording:
    """The recording with the times of its points, scans and poses as if no clock had been set.

    Frames of files and samples keep theirs: the opener and the stage ``frames`` correct them.
    """

    def items() -> Iterator[Item]:
        for item in recording.read():
            if isinstance(item, Shots) and len(item):
                yield moved(item, without_jumps(item.t_ns, jumps) - item.t_ns)
            elif isinstance(item, Trajectory | LaserScans) and len(item.t_ns):
                yield replace(item, t_ns=without_jumps(item.t_ns, jumps))
            else:
                yield item

    return replace(recording, read=items) if jumps else recording
