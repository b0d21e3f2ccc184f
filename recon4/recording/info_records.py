"""Contents of a recording as records and as text, for ``recon4 info``."""

from __future__ import annotations

from dataclasses import asdict, dataclass

import numpy as np

from recon4.findings.derived import derived_text, said_derived
from recon4.findings.wording import whole_text
from recon4.locales.coded import CodedText
from recon4.locales.languages import ENGLISH
from recon4.model.derived import Derived
from recon4.model.finding import Finding
from recon4.recording.assembly.assembler import TimeGap
from recon4.recording.formats.file_times import utc
from recon4.recording.tuning_times import FRAME_TIMES


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
    lost: tuple[str, ...] = ()
    """Counts of data that is not used, in words; of a large recording, at its head."""
    repaired: tuple[str, ...] = ()
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
            "walk": self.walk_text(language),
        }

    def walk_text(self, language: str = ENGLISH) -> str:
        """Kind of walk it is mapped as, and why, in words; empty = it cannot be mapped."""
        return derived_text(self.walk, language) if self.walk is not None else ""

    def lines(self, language: str = ENGLISH) -> list[str]:
        """The contents as text; what is derived and warned of in a language."""
        about = "about " if self.estimated else ""
        lines = [f"{self.path}: {self.kind.said(language)}, {self.bytes / 1e6:.1f} MB"]
        absolute = self.t_first_ns > FRAME_TIMES.earliest_ns
        if absolute or self.t_last_ns > self.t_first_ns:
            start = f"{utc(self.t_first_ns)} UTC" if absolute else "no absolute times"
            back = "" if self.seconds >= 0.0 else ", in reversed order: its times run backward"
            lines.append(f"time      {start}, {about}{abs(self.seconds):.2f} s{back}")
        lines += [f"walk      {self.walk_text(language)}"] if self.walk else []
        for sensor in self.sensors:
            lines += _sensor_lines(sensor, about, language)
        lines += [f"samples   {one.said(language)}" for one in self.samples]
        lines += [f"not read  {one.said(language)}" for one in self.unread]
        for gap in self.gaps[:10]:
            since_s = (gap.t_ns - self.t_first_ns) / 1e9
            what = "" if gap.seconds > 0 else "the clock goes back by "
            lines.append(
                f"gap       {gap.sensor}: {what}{abs(gap.seconds):.3f} s at {since_s:.2f} s"
            )
        if len(self.gaps) > 10:
            lines.append(f"gap       … {len(self.gaps)} in all")
        lines += [f"derived   {derived_text(one, language)}" for one in self.derived]
        lines += [f"missing   {one.said(language)}" for one in self.missing]
        lines += [f"lost      {text}" for text in self.lost]
        lines += [f"repaired  {text}" for text in self.repaired]
        lines += [f"warning   {whole_text(one, language)}" for one in self.findings]
        return lines


def _sensor_lines(sensor: SensorInfo, about: str, language: str) -> list[str]:
    rate = f", {sensor.rate_hz:.1f} a second" if np.isfinite(sensor.rate_hz) else ""
    turns = f", {sensor.rotation_hz:.2f} revolutions a second" * bool(
        np.isfinite(sensor.rotation_hz)
    )
    text = f"{sensor.label} {sensor.model}: {about}{sensor.count} "
    text += f"{sensor.content.said(language)}{rate}{turns}"
    lines = [f"lidar     {text}"]
    if sensor.fields:
        lines.append(f"fields    {', '.join(sensor.fields)}")
    lines += [f"remark    {sensor.label}: {one.said(language)}" for one in sensor.remarks]
    return lines + [f"remark    {whole_text(one, language)}" for one in sensor.findings]
