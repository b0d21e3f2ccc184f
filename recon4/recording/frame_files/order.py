"""The order of frame files by their times: numbers of files may be in another order."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from recon4.model.trajectory import Times
from recon4.recording.clocks.tuning import FRAME_TIMES

Rows = NDArray[np.intp]


def order_of_times(t_ns: Times) -> Rows | None:
    """Rows in the order of their times, (N,); None if these cannot be times of a walk.

    Names that were given at random or backward leave steps that are nearly even once the times are
    sorted. Times that start again with each minute lie between each other then: they go on in runs
    whose steps are longer than those of the sorted times.

    Args:
        t_ns: Times in the order of the files [ns], negative where damaged, (N,).
    """
    order = np.argsort(t_ns, kind="stable")
    steps = np.diff(t_ns[order])
    if not len(steps) or t_ns.min() < 0 or steps.min() <= 0:
        return None
    usual = FRAME_TIMES.even_ratio * np.median(steps)
    uneven = np.count_nonzero(steps < usual)
    forward = np.diff(t_ns)
    forward = forward[forward > 0]
    in_runs = len(forward) > (1.0 - FRAME_TIMES.run_ratio) * len(steps)
    interleaved = in_runs and usual < FRAME_TIMES.even_ratio**2 * np.median(forward)
    return None if interleaved or uneven > FRAME_TIMES.uneven_ratio * len(steps) else order


def times_by_text(t_ns: Times, files: Sequence[Path]) -> Times:
    """Times that are listed in the order of a plain sort (1, 10, 2), in that of the numbers.

    Args:
        t_ns: As listed [ns], (N,).
        files: In the order of their numbers.
    """
    rows = sorted(range(len(files)), key=lambda row: files[row].name)
    found = np.empty_like(t_ns)
    found[rows] = t_ns
    return found


def moved_back(t_ns: Times) -> int:
    """How many of some times are earlier than one before them."""
    return int(np.count_nonzero(t_ns < np.maximum.accumulate(t_ns)))
