"""Finds samples that lie beside a recording but are not read."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import islice
from pathlib import Path

from recon4.errors import RecordingError
from recon4.locales.coded import CodedText
from recon4.recording.kinds import RecordingKind, recognize
from recon4.recording.limits import LIMITS
from recon4.recording.sources import Sources

SUFFIXES = frozenset({".csv", ".pos", ".sbet", ".ubx", ".nmea", ".gps"})
"""Of files that are looked at."""


def unread_samples(sources: Sources) -> list[str]:
    """A sentence for IMU and for GNSS samples beside the recordings that are not among the sources.

    Nobody named these files: what cannot be read is none of them.
    """
    wanted = (
        (RecordingKind.IMU_CSV, "--imu", sources.imu),
        (RecordingKind.GNSS_FILE, "--gnss", sources.gnss),
    )
    texts = []
    for kind, option, given in wanted:
        file = None if given else nearby_samples(sources.recordings, kind)
        if file and file not in sources.recordings:
            texts.append(
                f"{file} lies beside the recording and is not read: give it (page: IMU and GNSS "
                f"files; command: {option} {file})"
            )
    return texts


def missing_samples(recording: Path, kind: RecordingKind, *, has: bool) -> list[CodedText]:
    """That a recording has no samples of a kind, or which file beside it has some that it has not.

    Args:
        recording: Its path.
        kind: Of a file of such samples.
        has: Whether it has some itself: those of position packets are those of a plain receiver.
    """
    name = {RecordingKind.IMU_CSV: "imu", RecordingKind.GNSS_FILE: "gnss"}[kind]
    file = nearby_samples([recording], kind)
    if file is None:
        return [] if has else [CodedText(f"missing-{name}", what=name)]
    code = f"missing-{name}-more" if has else f"missing-{name}-given"
    return [CodedText(code, file=file.name, what=name)]


def nearby_samples(recordings: Sequence[Path], kind: RecordingKind) -> Path | None:
    """The first file of a kind of samples in the folders of the recordings; None = none."""
    folders = {path if path.is_dir() else path.parent for path in recordings}
    for folder in sorted(folders):
        try:
            files = (one for one in sorted(folder.iterdir()) if one.suffix.lower() in SUFFIXES)
            for file in islice(files, LIMITS.sample_files):
                if _is_of(file, kind):
                    return file
        except OSError:
            continue
    return None


def _is_of(file: Path, kind: RecordingKind) -> bool:
    try:
        return recognize(file) is kind
    except RecordingError:
        return False
