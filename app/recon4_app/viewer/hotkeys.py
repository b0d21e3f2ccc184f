"""The keys of the viewer, for its controls and for the list of keys on its page."""

from __future__ import annotations

from typing import Any

HOTKEYS: tuple[tuple[str, Any, str], ...] = (
    ("Raw or normalized intensity", "N", "normalized"),
    ("Points on fitted surfaces, as measured, or those left out", "R", "surface"),
    ("Fit the map into the view", "F", "fit"),
    ("View from above", "7", "above"),
    ("View from the south", "1", "south"),
    ("View from the east", "3", "east"),
    ("Narrow field of view, nearly orthographic", "O", "narrow"),
    ("Measure a distance between two points", "M", "measure"),
    ("Stop measuring, clear the mark", "escape", "stop"),
    ("Go to the marked stretch of the walk", "G", "stretch"),
    ("Play or stop", "P", "play"),
)
"""Label, key, and name for `PanelCallbacks.command`."""
