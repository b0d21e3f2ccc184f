"""Inspection of a recording, with suitable settings: runs in a child of the compute pool."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from recon4.locales.languages import ENGLISH
from recon4.untrusted.names import is_unnameable
from recon4_app.projects.tuning import INSPECTION

if TYPE_CHECKING:
    from recon4.locales.coded import CodedText
    from recon4.recording.info.records import SensorInfo


@dataclass(frozen=True, slots=True, kw_only=True)
class SensorSummary:
    """One LiDAR of a recording."""

    label: str
    model: str
    content: str
    count: int
    rate_hz: float | None


@dataclass(frozen=True, slots=True, kw_only=True)
class RecordingSummary:
    """Content of a recording, and suitable settings."""

    path: str
    kind: str
    bytes: int
    seconds: float
    """Duration [s]; 0 = unknown."""
    estimated: bool
    """Only the beginning was read: counts and duration are estimates."""
    sensors: tuple[SensorSummary, ...]
    samples: tuple[str, ...]
    """IMU, GNSS and poses, as text."""
    derived: tuple[str, ...]
    """What the pipeline derives because it is not in the recording."""
    missing: tuple[str, ...]
    warnings: tuple[str, ...]
    project: str
    """Proposed name of the project."""
    preset: str
    rig: str
    """A rig file in the same folder; empty = detected from the recording."""
    imu: str
    """An IMU file in the same folder."""
    gnss: str
    """A GNSS file in the same folder."""
    first_rig: str
    """A rig file of the sensors, as text, where nothing says how they are mounted; else empty."""


def files_beside(path: Path) -> tuple[Path, ...]:
    """Regular files in the folder of a recording: `inspect_recording` may read them too.

    With more than `INSPECTION.max_beside` files only those of the recording's own name
    (``x.db3-wal``).
    """
    folder = path if path.is_dir() else path.parent
    with os.scandir(folder) as entries:
        files = sorted(Path(one.path) for one in entries if one.is_file(follow_symlinks=False))
    files = [file for file in files if file != path and not is_unnameable(file)]
    if len(files) > INSPECTION.max_beside:
        return tuple(file for file in files if file.name.startswith(path.stem))[
            : INSPECTION.max_beside
        ]
    return tuple(files)


def inspect_recording(
    path: Path, beside: tuple[Path, ...], language: str = ENGLISH
) -> RecordingSummary:
    """Inspect a recording.

    Args:
        path: File or folder.
        beside: Result of `files_beside`.
        language: Of its warnings, and of what is derived.

    Raises:
        RecordingError: If it cannot be read or has an unknown format.
    """
    from recon4.findings.derived import derived_text
    from recon4.findings.wording import whole_text
    from recon4.model.derived_kinds import DerivedKind
    from recon4.recording.info.describe import describe

    info = describe(path, near=beside)
    suited = _suited(beside)
    located = "gnss" in {text.values.get("what") for text in info.samples} or "GNSS" in suited
    return RecordingSummary(
        path=str(path),
        kind=info.kind.said(language),
        bytes=info.bytes,
        seconds=max(0.0, info.seconds),
        estimated=info.estimated,
        sensors=tuple(_summary_of(one, language) for one in info.sensors),
        samples=tuple(text.said(language) for text in info.samples),
        derived=tuple(
            derived_text(one, language)
            for one in info.derived
            if one.kind is not DerivedKind.RIG_CHOSEN or "rig" not in suited
        ),
        missing=tuple(
            text.said(language)
            for text in info.missing
            if text.values.get("what") not in {name.lower() for name in suited}
        ),
        warnings=(
            *(whole_text(finding, language) for finding in info.findings),
            *_gap_warnings([gap.seconds for gap in info.gaps]),
        ),
        project=_project_name(path),
        preset="outdoor" if located else "indoor",
        rig=suited.get("rig", ""),
        imu=suited.get("IMU", ""),
        gnss=suited.get("GNSS", ""),
        first_rig=info.first_rig if _needs_rig(info.missing) and "rig" not in suited else "",
    )


def _summary_of(sensor: SensorInfo, language: str) -> SensorSummary:
    from recon4.model.plain import finite_or_none

    return SensorSummary(
        label=sensor.label,
        model=sensor.model,
        content=sensor.content.said(language),
        count=sensor.count,
        rate_hz=finite_or_none(sensor.rate_hz),
    )


def _suited(files: tuple[Path, ...]) -> dict[str, str]:
    """Rig, IMU and GNSS files, recognized by their content."""
    from recon4.errors import Recon4Error
    from recon4.model.rig import load_rig
    from recon4.recording.info.nearby_samples import SUFFIXES
    from recon4.recording.kinds import RecordingKind, recognize

    found: dict[str, str] = {}
    for file in files:
        try:
            if file.suffix == ".toml":
                load_rig(str(file))
                found.setdefault("rig", str(file))
            elif file.suffix.lower() in SUFFIXES:
                kind = recognize(file)
                name = {RecordingKind.IMU_CSV: "IMU", RecordingKind.GNSS_FILE: "GNSS"}.get(kind)
                if name:
                    found.setdefault(name, str(file))
        except Recon4Error:
            continue  # another kind of file
    return found


def _needs_rig(missing: tuple[CodedText, ...]) -> bool:
    return any(text.values.get("what") == "rig" for text in missing)


def _gap_warnings(seconds: list[float]) -> list[str]:
    """Sentences about gaps, which are negative where a clock goes back."""
    back = sum(length < 0 for length in seconds)
    texts = [f"{len(seconds) - back} gaps in the data"] * (len(seconds) > back)
    return [*texts, *[f"the clock goes back {back} times"] * (back > 0)]


def _project_name(path: Path) -> str:
    import re

    from recon4_app.uploads.names import slug

    name = path.name
    if path.is_file() and re.fullmatch(r"(recording|data|capture|dump|out)\.\w+", name, re.I):
        name = path.parent.name
    # the folder of an uploaded recording has its name and an id
    if path.parent.name == "recordings" or path.parent.parent.name == "recordings":
        name = re.sub(r"-[0-9a-f]{12}$", "", name)
    return slug(name)
