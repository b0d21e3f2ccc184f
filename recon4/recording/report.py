"""Report of an import: all data is counted, nothing is dropped silently."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field

from recon4.model.import_counts import Loss, count_text, losses, repairs, replaced
from recon4.recording.limits import LIMITS


@dataclass(slots=True)
class ImportReport:
    """Counts and remarks of one import; the only mutable record of the readers."""

    counts: Counter[str] = field(default_factory=Counter)
    """Number of packets, messages, points and samples by result,
    for example ``packets``, ``packets_duplicate``, ``points_nan``."""
    details: dict[str, str] = field(default_factory=dict)
    """What is known of a count besides, by its name, for example a port."""
    derived: list[str] = field(default_factory=list)
    """What the recording lacks and was derived."""
    warnings: list[str] = field(default_factory=list)
    """Warnings: repairs, gaps, missing sensors, forced models."""
    doubts: list[str] = field(default_factory=list)
    """Warnings about the mounts of the sensors: every verdict names them."""
    ahead_ns: dict[str, int] = field(default_factory=dict)
    """Sensor -> its times minus those of the recorder's clock [ns], as last seen: GPS may drive
    the sensors, and the recorder's clock be wrong."""
    utc_ahead_ns: int = 0
    """UTC minus the recorder's clock [ns] if GPS drives a sensor, else 0."""
    lags_ns: dict[str, list[int]] = field(default_factory=dict)
    """Kind of sensor -> time of recording minus stamp of its first messages [ns]."""
    outcome: str = "complete"
    """``complete``, ``lossy`` (salvaged) or ``nothing``."""

    def count(self, name: str, number: int = 1) -> None:
        """Add to a counter; zero adds nothing."""
        if number:
            self.counts[name] += int(number)

    def note_lag(self, what: str, lag_ns: int) -> None:
        """Remember how long after its stamp a message was recorded [ns]."""
        lags = self.lags_ns.setdefault(what, [])
        if len(lags) < LIMITS.lags:
            lags.append(lag_ns)

    def derive(self, text: str) -> None:
        """Add a derived value once."""
        self._remember(self.derived, text)

    def warn(self, text: str) -> None:
        """Add a warning once."""
        self._remember(self.warnings, text)

    def doubt(self, text: str) -> None:
        """Add a doubt about a mount once; it is a warning too."""
        self.warn(text)
        self._remember(self.doubts, text)

    def warn_of_losses(self) -> None:
        """Add a warning for each large loss that no reader warned of; call once, at the end."""
        for loss in self._losses():
            if loss.is_warned:
                self.warn(loss.text)

    def text(self, name: str) -> str:
        """A count in words."""
        return count_text(name, self.counts, detail=self.details.get(name, ""))

    def lost(self) -> list[str]:
        """All counts of lost data, in words."""
        return [loss.text for loss in self._losses()]

    def _losses(self) -> list[Loss]:
        return losses(self.counts, self.details) + replaced(self.counts, self.details)

    def why_no_points(self) -> str:
        """That there is no usable point, with all that was counted."""
        counted = "; ".join(self.text(name) for name in sorted(self.counts))
        return f"no usable points ({counted or 'nothing read'})"

    def repaired(self) -> list[str]:
        """All counts of repaired data, in words."""
        return repairs(self.counts)

    def _remember(self, texts: list[str], text: str) -> None:
        if text in texts:
            return
        if len(texts) < LIMITS.texts:
            texts.append(text[: LIMITS.text_characters])
        else:
            self.count("remarks_more")
