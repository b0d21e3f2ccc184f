"""Gaps that come as evenly as clouds do: what a recording looks like that keeps every third one."""

from __future__ import annotations

import numpy as np

from recon4.model.trajectory import Times
from recon4.recording.assembly.tuning import EVEN_GAPS


def even_pause_ns(start_ns: Times, length_ns: Times, span_ns: tuple[int, int]) -> int:
    """Time from one gap to the next [ns] if all are alike over the whole recording; else 0.

    Args:
        start_ns: Where the gaps of one sensor begin [ns], (N,).
        length_ns: How long they are; negative = a clock went back [ns], (N,).
        span_ns: First and last point of the sensor [ns].
    """
    if len(start_ns) < EVEN_GAPS.least:
        return 0
    step_ns, first_ns = np.diff(start_ns), int(start_ns[0]) - span_ns[0]
    usual_ns, last_ns = float(np.median(step_ns)), span_ns[1] - int(start_ns[-1])
    alike = all(
        np.all(np.abs(values - np.median(values)) < EVEN_GAPS.uneven * usual_ns)
        for values in (step_ns, length_ns)
    )
    is_whole = max(first_ns, last_ns) < EVEN_GAPS.ends * usual_ns
    return round(usual_ns) if alike and is_whole and length_ns[0] > 0 else 0
