"""Warnings about the scans of a 2-D laser and the lines of a profiler. No I/O."""

from __future__ import annotations

from collections.abc import Iterator

from recon4.live.protocol import Notes, Pose
from recon4.live.tuning import SCAN_WARNINGS
from recon4.model.import_counts import ratio_text

_BAD_SCANS = ("scans_repeated", "scans_duplicate", "scans_out_of_order")
_UNOBSERVED = {
    "along": "Nothing holds the map along this corridor: look at a corner or an open door",
    "across": "Nothing holds the map across your way: keep near a wall",
}


def unobserved_text(pose: Pose) -> str:
    """The direction that the 2-D laser does not observe, in words; empty = it observes all."""
    return _UNOBSERVED.get(pose.unobserved, "")


def scan_remarks(notes: Notes) -> Iterator[str]:
    """What was wrong with the scans of the last seconds."""
    recent = notes.recent
    for name, where in (("scans", "scans"), ("lines", "line scans")):
        damaged, whole = recent.get("scans_damaged", 0), recent.get(name, 0)
        if damaged and not whole and name == "scans":
            yield f"Nothing of what the 2-D laser sends can be read: {damaged} datagrams"
        elif damaged > SCAN_WARNINGS.part * whole >= SCAN_WARNINGS.part * SCAN_WARNINGS.least:
            yield f"{damaged} datagrams with {where} cannot be read"
            break
    total = recent.get("scans", 0) + sum(recent.get(name, 0) for name in _BAD_SCANS)
    for name in _BAD_SCANS:
        count = recent.get(name, 0)
        if total >= SCAN_WARNINGS.least and count > SCAN_WARNINGS.part * total:
            yield ratio_text(name, count / total)
    blind = recent.get("scans_without_returns", 0)
    if blind >= SCAN_WARNINGS.least and 2 * blind > recent.get("scans", 0):
        yield "The 2-D laser sees nothing: is it covered, or is everything beyond its range?"
    if recent.get("lines_without_angle", 0) >= SCAN_WARNINGS.least:
        yield "The angles of the profiler's head are missing: its lines cannot be placed"
    if recent.get("clock_jumps", 0):
        yield "A clock of the scanners jumped: its scans are timed by their arrival"
