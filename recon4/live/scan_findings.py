"""Warnings about the scans of a 2-D laser and the lines of a profiler. No I/O."""

from __future__ import annotations

from collections.abc import Iterator

from recon4.live.protocol import Notes, Pose
from recon4.live.tuning import SCAN_WARNINGS
from recon4.locales.texts import Texts
from recon4.model.import_counts import ratio_text

_BAD_SCANS = ("scans_repeated", "scans_duplicate", "scans_out_of_order")


def unobserved_text(pose: Pose, say: Texts) -> str:
    """The direction that the 2-D laser does not observe, in words; empty = it observes all."""
    message = f"unobserved-{pose.unobserved}"
    return say(message) if message in say else ""


def scan_remarks(notes: Notes, say: Texts) -> Iterator[str]:
    """What was wrong with the scans of the last seconds."""
    recent = notes.recent
    for name in ("scans", "lines"):
        damaged, whole = recent.get("scans_damaged", 0), recent.get(name, 0)
        if damaged and not whole and name == "scans":
            yield say("scans-unreadable", damaged=damaged)
        elif damaged > SCAN_WARNINGS.part * whole >= SCAN_WARNINGS.part * SCAN_WARNINGS.least:
            yield say(f"{name}-damaged", damaged=damaged)
            break
    total = recent.get("scans", 0) + sum(recent.get(name, 0) for name in _BAD_SCANS)
    for name in _BAD_SCANS:
        count = recent.get(name, 0)
        if total >= SCAN_WARNINGS.least and count > SCAN_WARNINGS.part * total:
            yield ratio_text(name, count / total, say.language)
    blind = recent.get("scans_without_returns", 0)
    if blind >= SCAN_WARNINGS.least and 2 * blind > recent.get("scans", 0):
        yield say("laser-blind")
    if recent.get("lines_without_angle", 0) >= SCAN_WARNINGS.least:
        yield say("head-angles-missing")
