"""Contents of a file of samples (IMU, GNSS) or poses alone, for ``recon4 info``."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from recon4.locales.coded import CodedText
from recon4.locales.texts import Shown
from recon4.model.finding_kinds import FindingKind
from recon4.recording.formats.poses import pose_format, read_tum, tum_hint
from recon4.recording.gnss.files import read_gnss
from recon4.recording.gnss.records import Dating
from recon4.recording.info.records import RecordingInfo
from recon4.recording.kinds import RecordingKind
from recon4.recording.report import ImportReport
from recon4.recording.samples.csv_files import read_imu_csv

_GNSS_SAMPLES = {
    Dating.UTC: "samples-gnss",
    Dating.DAY: "samples-gnss-undated",
    Dating.WEEK: "samples-gnss-weekless",
}
"""Code of samples by what their times are."""


def describe_samples(info: RecordingInfo, path: Path, kind: RecordingKind) -> RecordingInfo:
    """Times and number of the samples or poses of one file."""
    report = ImportReport()
    values: dict[str, Shown] = {}
    if kind is RecordingKind.IMU_CSV:
        t_ns, code = read_imu_csv(path, report).t_ns, "samples-imu"
        values["what"] = "imu"
    elif kind is RecordingKind.GNSS_FILE:
        file = read_gnss(path, report)
        t_ns, code = file.samples.t_ns, _GNSS_SAMPLES[file.dating]
        values |= {"format": file.format, "what": "gnss"}
    elif pose_format(path) == "tum":
        walk = read_tum(path, report)
        t_ns, code = walk.t_ns, "samples-tum"
        if tum_hint(walk):
            report.warn(FindingKind.QUATERNION_ORDER)
    else:
        missing = (CodedText("missing-times"),)
        return replace(info, samples=(CodedText("samples-kitti"),), missing=missing)
    first, last = int(t_ns.min()), int(t_ns.max())
    values["rate_hz"] = (len(t_ns) - 1) * 1e9 / (last - first) if last > first else 0.0
    return replace(
        info,
        t_first_ns=first,
        t_last_ns=last,
        samples=(CodedText(code, count=len(t_ns), **values),),
        derived=tuple(report.derived),
        lost=tuple(report.losses()),
        findings=tuple(report.findings),
    )
