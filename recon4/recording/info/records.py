"""Contents of a recording as records and as text, for ``recon4 info``."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict, dataclass

from recon4.findings.derived import derived_text, said_derived
from recon4.findings.wording import whole_text
from recon4.locales.coded import CodedText, said
from recon4.locales.languages import ENGLISH
from recon4.model.derived import Derived
from recon4.model.finding import Finding
from recon4.model.import_counts import Loss
from recon4.recording.assembly.assembler import TimeGap
from recon4.recording.clocks.tuning import FRAME_TIMES
from recon4.recording.formats.file_times import utc


@dataclass(frozen=True, slots=True, kw_only=True)
class SensorInfo:
    """One LiDAR of a recording."""

    label: str
    """Address and port, topic, or folder."""
    model: str
    content: CodedText
    """What it sends, such as ``packets``."""
    count: int
    """Number of them; an estimate for a large capture file."""
    rate_hz: float
    """Number per second; NaN = unknown."""
    rotation_hz: float = float("nan")
    """Measured at the head; NaN = unknown."""
    fields: tuple[str, ...] = ()
    remarks: tuple[CodedText, ...] = ()
    findings: tuple[Finding, ...] = ()
    """What its reader warns of."""

    def to_json(self, language: str) -> dict[str, object]:
        """It as a record, with what it sends in a language."""
        return asdict(self) | {
            "content": self.content.said(language),
            "remarks": [one.said(language) for one in self.remarks],
        }

    def texts(self, language: str, *, estimated: bool) -> Iterator[tuple[str, str]]:
        """What each line is of, and its text.

        Args:
            language: Of the findings.
            estimated: Whether only the head of a large file was read.
        """
        rates = {"rate_hz": self.rate_hz, "turns_hz": self.rotation_hz}
        of = {"model": self.model, "content": self.content, "estimated": _yes(estimated)}
        yield "lidar", CodedText("info-sensor", label=self.label, count=self.count, **of, **rates)
        if self.fields:
            yield "fields", ", ".join(self.fields)
        for one in self.remarks:
            yield "remark", f"{self.label}: {one.said(language)}"
        for found in self.findings:
            yield "remark", whole_text(found, language)


@dataclass(frozen=True, slots=True, kw_only=True)
class RecordingInfo:
    """Contents of a recording."""

    path: str
    kind: CodedText
    bytes: int
    walk: Derived | None = None
    """Kind of walk it is mapped as, and why; None = it cannot be mapped."""
    t_first_ns: int = 0
    t_last_ns: int = 0
    """Both 0 = the recording has no times."""
    estimated: bool = False
    """Whether only the head of a large file was read; counts and end are estimates then."""
    sensors: tuple[SensorInfo, ...] = ()
    samples: tuple[CodedText, ...] = ()
    """IMU, GNSS and poses with their rates."""
    unread: tuple[CodedText, ...] = ()
    """Senders of packets that are not read, and why."""
    gaps: tuple[TimeGap, ...] = ()
    derived: tuple[Derived, ...] = ()
    """What recon4 derives or chooses because the recording does not say it."""
    missing: tuple[CodedText, ...] = ()
    lost: tuple[Loss, ...] = ()
    """Counts of data that is not used; of a large recording, at its head."""
    repaired: tuple[Loss, ...] = ()
    """Counts of repaired data."""
    findings: tuple[Finding, ...] = ()
    """What the readers warn of."""
    first_rig: str = ""
    """A rig file of its sensors, as text; empty = no sensor is known."""

    @property
    def seconds(self) -> float:
        """Duration [s]."""
        return (self.t_last_ns - self.t_first_ns) / 1e9

    def to_json(self, language: str = ENGLISH) -> dict[str, object]:
        """The contents as a record; what is derived also as text in a language."""
        return asdict(self) | {
            "kind": self.kind.said(language),
            "sensors": [one.to_json(language) for one in self.sensors],
            "samples": [one.said(language) for one in self.samples],
            "unread": [one.said(language) for one in self.unread],
            "derived": [said_derived(one, language) for one in self.derived],
            "missing": [one.said(language) for one in self.missing],
            "lost": [one.said(language) for one in self.lost],
            "repaired": [one.said(language) for one in self.repaired],
            "walk": self.walk_text(language),
        }

    def walk_text(self, language: str = ENGLISH) -> str:
        """Kind of walk it is mapped as, and why, in words; empty = it cannot be mapped."""
        return derived_text(self.walk, language) if self.walk is not None else ""

    def lines(self, language: str = ENGLISH) -> list[str]:
        """The contents as lines in a language, each with a word at its begin that says of what."""
        megabytes = self.bytes / 1e6
        head = CodedText("info-head", path=self.path, kind=self.kind, megabytes=megabytes)
        labelled = [(key, said(text, language)) for key, text in self._texts(language)]
        return [
            head.said(language),
            *(f"{_label(key, language):<9} {text}" for key, text in labelled),
        ]

    def _texts(self, language: str) -> Iterator[tuple[str, str]]:
        """What each line is of, and its text."""
        if (time := self._time()) is not None:
            yield "time", time
        if self.walk:
            yield "walk", self.walk_text(language)
        for sensor in self.sensors:
            yield from sensor.texts(language, estimated=self.estimated)
        yield from (("samples", one) for one in self.samples)
        yield from (("unread", one) for one in self.unread)
        yield from (("gap", one) for one in self._gap_texts())
        yield from (("derived", derived_text(one, language)) for one in self.derived)
        yield from (("missing", one) for one in self.missing)
        yield from (("lost", one.said(language)) for one in self.lost)
        yield from (("repaired", one.said(language)) for one in self.repaired)
        yield from (("warning", whole_text(one, language)) for one in self.findings)

    def _time(self) -> CodedText | None:
        absolute = self.t_first_ns > FRAME_TIMES.earliest_ns
        if not absolute and self.t_last_ns <= self.t_first_ns:
            return None
        none = CodedText("info-no-times")
        start = CodedText("info-start", start=utc(self.t_first_ns)) if absolute else none
        code = "info-time" if self.seconds >= 0.0 else "info-time-back"
        return CodedText(
            code, start=start, estimated=_yes(self.estimated), seconds=abs(self.seconds)
        )

    def _gap_texts(self) -> Iterator[CodedText]:
        for gap in self.gaps[:10]:
            since_s = (gap.t_ns - self.t_first_ns) / 1e9
            of = {"seconds": abs(gap.seconds), "since_s": since_s}
            yield CodedText(
                "info-gap" if gap.seconds > 0 else "info-gap-back", sensor=gap.sensor, **of
            )
        if len(self.gaps) > 10:
            yield CodedText("info-gaps", count=len(self.gaps))


def _yes(is_so: bool) -> str:
    return "yes" if is_so else "no"


def _label(key: str, language: str) -> str:
    return CodedText(f"info-label-{key}").said(language)
