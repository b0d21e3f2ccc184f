"""What reading a recording found: everything counted, nothing dropped in silence."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field

MAX_TEXTS = 200
"""Different remarks that are kept; the others are counted."""
MAX_TEXT_CHARACTERS = 1000


@dataclass(slots=True)
class ImportReport:
    """Counts and remarks of one import; the only mutable record of the readers."""

    counts: Counter[str] = field(default_factory=Counter)
    """Packets, messages, points and samples by what became of them,
    for example ``packets``, ``packets_duplicate``, ``points_nan``."""
    derived: list[str] = field(default_factory=list)
    """What was not in the recording and was worked out, in words."""
    warnings: list[str] = field(default_factory=list)
    """What a person should know: repairs, gaps, missing sensors, forced models."""
    ahead_ns: dict[str, int] = field(default_factory=dict)
    """Sensor -> its times minus those of the recorder's clock [ns], as last seen: GPS may drive
    the sensors, and the recorder's clock be wrong."""
    utc_ahead_ns: int = 0
    """UTC minus the recorder's clock [ns] if GPS drives a sensor, else 0."""
    outcome: str = "complete"
    """``complete``, ``lossy`` (salvaged) or ``nothing``."""

    def count(self, name: str, number: int = 1) -> None:
        """Add to a counter; zero adds nothing."""
        if number:
            self.counts[name] += int(number)

    def derive(self, text: str) -> None:
        """Remember once what was worked out."""
        self._remember(self.derived, text)

    def warn(self, text: str) -> None:
        """Remember a warning once."""
        self._remember(self.warnings, text)

    def _remember(self, texts: list[str], text: str) -> None:
        if text in texts:
            return
        if len(texts) < MAX_TEXTS:
            texts.append(text[:MAX_TEXT_CHARACTERS])
        else:
            self.count("remarks_more")
