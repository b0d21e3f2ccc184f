"""Whether samples are of the time of the points."""

from __future__ import annotations

from typing import TypeVar

from recon4.errors import ConfigError
from recon4.locales.coded import CodedText
from recon4.model.finding import Value
from recon4.model.finding_kinds import FindingKind
from recon4.model.samples import GnssSamples, ImuSamples
from recon4.recording.clocks.names import described, known_offset_s, looks_like, offset_values
from recon4.recording.report import ImportReport

Samples = TypeVar("Samples", ImuSamples, GnssSamples)


def covering(
    samples: Samples | None, span: tuple[int, int], asked_for: bool, *, report: ImportReport
) -> Samples | None:
    """The samples, unless their times do not overlap with those of the points.

    Raises:
        ConfigError: If they were given as a file, which must be used.
    """
    if samples is None:
        return None
    what = "IMU" if isinstance(samples, ImuSamples) else "GNSS"
    first, last = int(samples.t_ns[0]), int(samples.t_ns[-1])
    margin_ns = 1_000_000_000
    if last < span[0] - margin_ns or first > span[1] + margin_ns:
        ahead_s = (first - span[0]) / 1e9
        times = {
            "first_s": first / 1e9,
            "last_s": last / 1e9,
            "points_first_s": span[0] / 1e9,
            "points_last_s": span[1] / 1e9,
            "offset_s": -ahead_s,
        }
        names = {"what": what, "table": what.lower()}
        if asked_for:
            ahead = described(ahead_s)
            raise ConfigError(CodedText("samples-not-covering", ahead=ahead, **names, **times))
        report.warn(FindingKind.SAMPLES_ELSEWHEN, **names, **times, **offset_values(ahead_s))
        return None
    late_s, early_s = (first - span[0]) / 1e9, (span[1] - last) / 1e9
    looks = looks_like(late_s) if abs(late_s + early_s) < 1.0 else ""
    if looks or (what == "IMU" and max(late_s, early_s) > 1.0):
        clock: dict[str, Value] = {"looks": looks, "offset_s": -known_offset_s(late_s)}
        report.warn(
            FindingKind.SAMPLES_SHORT,
            what=what,
            table=what.lower(),
            late_s=late_s,
            early_s=early_s,
            **(clock if looks else {}),
        )
    return samples
