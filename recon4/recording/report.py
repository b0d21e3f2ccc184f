"""Report of an import: all data is counted, nothing is dropped silently."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from recon4.findings.derived import derived_text
from recon4.findings.wording import whole_text
from recon4.locales.coded import CODE, KINDS, CodedText, coded, flat_values, joined
from recon4.model.count_meanings import JUMPS_OF
from recon4.model.derived import Derived
from recon4.model.derived_kinds import DerivedKind
from recon4.model.finding import Finding, Level, Value
from recon4.model.finding_kinds import FindingKind
from recon4.model.import_counts import Loss, count_text, losses, repairs, replaced
from recon4.recording.limits import LIMITS


def warning(kind: FindingKind, **values: Value | Exception) -> Finding:
    """A warning of a reader, as a finding; the catalog of the findings has its words.

    Args:
        kind: What it is.
        values: Figures and names that its text quotes; NaN is left out, a text of a file cut.
            An error is kept as its message and, in ``…_code``, its kind.
            ``sensor`` is the name of the sensor that it is about; ``start_s`` and ``end_s`` are its
            stretch, after the first multiframe [s].
    """
    known = _known(values)
    sensor = str(known.pop("sensor", ""))
    span_s = None
    if "start_s" in known:
        span_s = (float(known.pop("start_s")), float(known.pop("end_s")))
    return Finding(kind=kind, level=Level.CHECK, span_s=span_s, sensor=sensor, values=known)


@dataclass(slots=True)
class ImportReport:
    """Counts and findings of one import; the only mutable record of the readers."""

    counts: Counter[str] = field(default_factory=Counter)
    """Number of packets, messages, points and samples by result,
    for example ``packets``, ``packets_duplicate``, ``points_nan``."""
    details: dict[str, str] = field(default_factory=dict)
    """What is known of a count besides, by its name, for example a port."""
    derived: list[Derived] = field(default_factory=list)
    """What the recording lacks and was derived or chosen."""
    findings: list[Finding] = field(default_factory=list)
    """What the readers warn of: repairs, gaps, missing sensors, forced models."""
    ahead_ns: dict[str, int] = field(default_factory=dict)
    """Sensor -> its times minus those of the recorder's clock [ns], as last seen: GPS may drive
    the sensors, and the recorder's clock be wrong."""
    utc_ahead_ns: int = 0
    """UTC minus the recorder's clock [ns] if GPS drives a sensor, else 0."""
    recorder_jumps_ns: dict[str, list[int]] = field(default_factory=dict)
    """LiDAR -> jumps of the recorder's clock that its stamps show [ns], positive = ahead."""
    lags_ns: dict[str, list[int]] = field(default_factory=dict)
    """Kind of sensor -> time of recording minus stamp of its first messages [ns]."""
    outcome: str = "complete"
    """``complete``, ``lossy`` (salvaged) or ``nothing``."""

    def count(self, name: str, number: int = 1) -> None:
        """Add to a counter; zero adds nothing."""
        if number:
            self.counts[name] += int(number)

    def count_jump(self, source: str) -> None:
        """Count a jump of a sensor's or topic's clock, also as ``clock_jumps_of_NAME``."""
        self.count("clock_jumps")
        self.count(f"{JUMPS_OF}{source}")

    def note_lag(self, what: str, lag_ns: int) -> None:
        """Remember how long after its stamp a message was recorded [ns]."""
        lags = self.lags_ns.setdefault(what, [])
        if len(lags) < LIMITS.lags:
            lags.append(lag_ns)

    def derive(self, kind: DerivedKind, **values: Value | Exception) -> None:
        """State once what the recording lacks and was derived or chosen.

        Args:
            kind: What it is; the catalog has its words.
            values: As for `warning`.
        """
        self.keep(Derived(kind=kind, values=_known(values)))

    def keep(self, found: Derived) -> None:
        """Keep once what a reader derived before there was a report."""
        if found in self.derived:
            return
        if len(self.derived) < LIMITS.texts:
            self.derived.append(found)
        else:
            self.count("remarks_more")

    def warn(self, kind: FindingKind, **values: Value | Exception) -> None:
        """Warn of something once; arguments as for `warning`."""
        self.add(warning(kind, **values))

    def add(self, found: Finding) -> None:
        """Keep a warning once."""
        if found in self.findings:
            return
        if len(self.findings) < LIMITS.texts:
            self.findings.append(found)
        else:
            self.count("remarks_more")

    def withdraw(self, kind: FindingKind, sensor: str) -> None:
        """Remove warnings of a kind about a sensor: the whole recording shows that none is due."""
        kept = [one for one in self.findings if (one.kind, one.sensor) != (kind, sensor)]
        self.findings[:] = kept

    @property
    def recorder_set_ns(self) -> tuple[int, ...]:
        """Jumps of the recorder's clock [ns]: as by the LiDAR that shows most of them."""
        most: list[int] = max(self.recorder_jumps_ns.values(), key=len, default=[])
        return tuple(most)

    def warn_of_losses(self) -> None:
        """Warn of each large loss that no reader warned of; call once, at the end."""
        for loss in self.losses():
            if loss.is_warned:
                self.warn(FindingKind.DATA_LOST, **_values(loss))

    def text(self, name: str) -> str:
        """A count in words."""
        return count_text(name, self.counts, detail=self.details.get(name, ""))

    def lost(self) -> list[str]:
        """All counts of lost data, in words."""
        return [loss.text for loss in self.losses()]

    def losses(self) -> list[Loss]:
        """All counts of lost data: what is not used, then what something worse stands in for."""
        return losses(self.counts, self.details) + replaced(self.counts, self.details)

    def why_no_points(self, seen: str = "") -> str:
        """That there is no usable point, with all that was counted.

        Args:
            seen: What the recording has against its rig; said if no packet was one of a sensor.
        """
        counted = "; ".join(self.text(name) for name in sorted(self.counts))
        none = CodedText("no-usable-points", counted=counted or CodedText("nothing-read"))
        return joined([none, seen] if seen and self._nothing_decoded else [none])

    @property
    def _nothing_decoded(self) -> bool:
        """Whether there was no cloud and no packet as long as those of its sensor."""
        counts = self.counts
        return not counts["clouds"] and counts["packets"] <= counts["packets_wrong_length"]

    def counted(self) -> str:
        """All counts in one value, such as ``points=100 points_nan=5``; empty = nothing read."""
        return " ".join(f"{name}={self.counts[name]}" for name in sorted(self.counts))

    def said(self) -> list[str]:
        """What was warned of in words, for messages of errors."""
        return [whole_text(one) for one in self.findings]

    def said_derived(self) -> list[str]:
        """What was derived in words, for messages of errors."""
        return [derived_text(one) for one in self.derived]

    def repaired(self) -> list[str]:
        """All counts of repaired data, in words."""
        return [one.text for one in self.repairs()]

    def repairs(self) -> list[Loss]:
        """All counts of repaired data."""
        return repairs(self.counts)


def _known(values: Mapping[str, Value | Exception]) -> dict[str, Value]:
    errors = {name: coded(one) for name, one in values.items() if isinstance(one, Exception)}
    known_kinds = {name: one for name, one in errors.items() if one.code in KINDS.values()}
    values = {**values, **{n: one for n, one in errors.items() if n not in known_kinds}}
    coded_texts = {name: one for name, one in values.items() if isinstance(one, CodedText)}
    every: dict[str, Value | Exception] = {**values, **flat_values(coded_texts)}
    known = {name: _bounded(one) for name, one in every.items() if one == one}
    return known | {name + CODE: one.code for name, one in known_kinds.items()}


def _bounded(value: Value | Exception) -> Value:
    if isinstance(value, Exception):
        return str(value)[: LIMITS.text_characters]
    if isinstance(value, np.generic):  # a float64 is a float, but no value of JSON
        return _bounded(value.item())
    return value[: LIMITS.text_characters] if isinstance(value, str) else value


def _values(loss: Loss) -> dict[str, Value]:
    values: dict[str, Value] = {"count": loss.name, "number": loss.number}
    values |= {"total": loss.total} if loss.total else {"alone": True}
    return values | ({"detail": loss.detail} if loss.detail else {})
