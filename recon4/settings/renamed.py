"""Settings and presets of earlier versions, so that old files, commands and projects stay readable.

A renamed one is translated. A retired one is fixed now; `retired.toml` beside this file has its
value. Nothing is said of one that had this value. One that had another value is announced with what
it did.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib import resources

from recon4.locales.coded import CodedText

EARLIER_PRESETS = {"staircase": "indoor"}
"""Earlier preset -> the one with the same settings."""
RENAMED = {
    ("odometry", "lost_share"): "lost_match_ratio",
    ("scans", "min_share"): "min_inlier_ratio",
    ("scans", "sure_share"): "confident_inlier_ratio",
    ("graph", "drift_share"): "drift_ratio",
    ("graph", "min_share"): "min_match_ratio",
    ("ingest", "laser_topic"): "lidar_topic",
}
"""Group and name in an earlier version -> current name."""

Value = bool | int | float | str


@dataclass(frozen=True, slots=True)
class Retired:
    """A setting of earlier versions that is fixed now."""

    value: Value
    """What it is fixed at."""
    text: str
    """What it is, and its unit."""
    thesis: Value | None = None
    """Its value in the preset `thesis`, which another setting stands for now."""

    def changed(self, path: str, given: object) -> str:
        """What to say of another value than the fixed one; empty = nothing."""
        if given == self.value or (self.thesis is not None and given == self.thesis):
            return ""
        return CodedText(
            "setting-retired", setting=path, value=str(self.value), given=str(given), what=self.text
        )


@cache
def retired() -> Mapping[tuple[str, str], Retired]:
    """Group and name of each retired setting."""
    text = resources.files("recon4.settings").joinpath("retired.toml").read_text("utf-8")
    return {
        (group, name): Retired(**row)
        for group, rows in tomllib.loads(text).items()
        for name, row in rows.items()
    }


def _current_name(group: str, name: str) -> str:
    """Current name of a setting in a file of any version."""
    return RENAMED.get((group, name), name)


def current_values(group: str, values: Mapping[str, object]) -> dict[str, object]:
    """Recorded values of a group under their current names.

    Of two names that are one setting now, the topic that somebody named counts.
    """
    found: dict[str, object] = {}
    for name, value in values.items():
        current = _current_name(group, name)
        if value != "" or current not in found:
            found[current] = value
    return found


def changed_retired(recorded: Mapping[str, Mapping[str, object]]) -> list[str]:
    """Sentences on retired settings that recorded settings had changed.

    Args:
        recorded: Group -> name -> value, of any version.
    """
    found = []
    for group, values in recorded.items():
        for name, value in values.items():
            fixed = retired().get((group, _current_name(group, name)))
            text = fixed.changed(f"{group}.{name}", value) if fixed else ""
            found += [text] if text else []
    return found
