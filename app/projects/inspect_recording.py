"""What is inside a recording, and what to make of it: runs in a child of the compute pool."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

MOST_BESIDE = 50
"""Among more files than this no IMU or GNSS file is looked for."""


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
    """What a look at a recording found, and the settings that suit it."""

    path: str
    kind: str
    bytes: int
    seconds: float
    """How long it is; 0 = it does not say."""
    estimated: bool
    """Only the beginning was read: counts and length are estimates."""
    sensors: tuple[SensorSummary, ...]
    samples: tuple[str, ...]
    """IMU, GNSS and poses, in words."""
    derived: tuple[str, ...]
    """What will be worked out."""
    missing: tuple[str, ...]
    warnings: tuple[str, ...]
    project: str
    """A name for the project."""
    preset: str
    rig: str
    """A rig file that lies beside it; empty = guessed from the recording."""
    imu: str
    """An IMU file that lies beside it."""
    gnss: str
    """A GNSS file that lies beside it."""


def files_beside(path: Path) -> tuple[Path, ...]:
    """Regular files in the folder of a recording: what `inspect_recording` may read besides it.

    None among more than `MOST_BESIDE`, but those of the recording's own name (``x.db3-wal``).
    """
    folder = path if path.is_dir() else path.parent
    with os.scandir(folder) as entries:
        files = sorted(Path(one.path) for one in entries if one.is_file(follow_symlinks=False))
    files = [file for file in files if file != path]
    if len(files) > MOST_BESIDE:
        return tuple(file for file in files if file.name.startswith(path.stem))[:MOST_BESIDE]
    return tuple(files)


def inspect_recording(path: Path, beside: tuple[Path, ...]) -> RecordingSummary:
    """Look at a recording.

    Args:
        path: File or folder.
        beside: `files_beside` it.

    Raises:
        RecordingError: If it cannot be read or is nothing that recon4 knows.
    """
    import math

    from recon4.recording.info import describe

    info = describe(path)
    suited = _suited(beside)
    samples = " ".join(info.samples)
    located = "GNSS" in samples or "GNSS" in suited
    return RecordingSummary(
        path=str(path),
        kind=info.kind,
        bytes=info.bytes,
        seconds=max(0.0, info.seconds),
        estimated=info.estimated,
        sensors=tuple(
            SensorSummary(
                label=sensor.label,
                model=sensor.model,
                content=sensor.content,
                count=sensor.count,
                rate_hz=sensor.rate_hz if math.isfinite(sensor.rate_hz) else None,
            )
            for sensor in info.sensors
        ),
        samples=info.samples,
        derived=tuple(text for text in info.derived if not _guessed(text, suited)),
        missing=tuple(text for text in info.missing if not _there(text, suited)),
        warnings=(*info.warnings, *_gap_words(len(info.gaps))),
        project=_project_name(path),
        preset="outdoor" if located else "indoor",
        rig=suited.get("rig", ""),
        imu=suited.get("IMU", ""),
        gnss=suited.get("GNSS", ""),
    )


def _suited(files: tuple[Path, ...]) -> dict[str, str]:
    """Rig, IMU and GNSS files, known by their content."""
    from recon4.errors import Recon4Error
    from recon4.model.rig import load_rig
    from recon4.recording.open import RecordingKind, recognize

    found: dict[str, str] = {}
    for file in files:
        try:
            if file.suffix == ".toml":
                load_rig(str(file))
                found.setdefault("rig", str(file))
            elif file.suffix == ".csv":
                kind = recognize(file)
                name = {RecordingKind.IMU_CSV: "IMU", RecordingKind.GNSS_CSV: "GNSS"}.get(kind)
                if name:
                    found.setdefault(name, str(file))
        except Recon4Error:
            continue  # not meant for us
    return found


def _there(text: str, beside: dict[str, str]) -> bool:
    """Whether what the recording lacks lies beside it."""
    return any(text.startswith(kind) for kind in beside) or (
        text.startswith("rig") and "rig" in beside
    )


def _guessed(text: str, beside: dict[str, str]) -> bool:
    """Whether it tells of a guess that a file beside the recording makes needless."""
    return "rig" in beside and text.startswith("no rig given")


def _gap_words(gaps: int) -> tuple[str, ...]:
    return (f"{gaps} gaps in the data",) if gaps else ()


def _project_name(path: Path) -> str:
    import re

    from app.uploads.names import slug

    name = path.name
    if path.is_file() and re.fullmatch(r"(recording|data|capture|dump|out)\.\w+", name, re.I):
        name = path.parent.name
    # a recording that was uploaded lies in a folder of its name and a number
    if path.parent.name == "recordings" or path.parent.parent.name == "recordings":
        name = re.sub(r"-[0-9a-f]{12}$", "", name)
    return slug(name)
