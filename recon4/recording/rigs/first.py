"""A first rig file, written from what a recording shows of its sensors."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from recon4.errors import ConfigError
from recon4.locales.coded import CodedText
from recon4.model.lidars import lidar_model
from recon4.model.rig import Rig, format_rig
from recon4.recording.packets.companions import companion_paths, with_descriptions
from recon4.recording.rigs.choice import RigToComplete
from recon4.store.atomic import write_text


def first_rig_of(found: Rig | None, to_complete: RigToComplete | None, recording: Path) -> str:
    """A rig file of the sensors of a recording, as text; empty = none is known.

    It holds the descriptions that lie beside the recording: a live capture has no other.

    Args:
        found: The rig that was chosen.
        to_complete: A rig that a person must complete, in its place.
        recording: File or folder.
    """
    rig = found if to_complete is None else to_complete.rig
    if rig is None:
        return ""
    rig, _ = with_descriptions(rig, [recording, *companion_paths([recording])])
    if to_complete is None:
        return first_rig_text(rig, recording.name, mounted=True)
    mounted, uncertain = len(rig.sensors) == 1, to_complete.uncertain
    return first_rig_text(rig, recording.name, mounted=mounted, uncertain=uncertain)


def first_rig_text(
    rig: Rig, recording: str, *, mounted: bool, uncertain: Sequence[str] = ()
) -> str:
    """A rig as TOML text, with what remains to be measured as comments.

    Args:
        rig: The sensors of the recording.
        recording: Its name.
        mounted: Whether the recording says how they are mounted, or there is only one.
        uncertain: What else a person should look at.
    """
    lines = [
        f"# Sensors of {' '.join(recording.split())}. Body: x forward, y left, z up.",
    ]
    if not mounted:
        names = ", ".join(sensor.name for sensor in rig.sensors)
        lines += [
            f"# Measure xyz_m [m] and rpy_deg (roll, pitch, yaw) [°] of {names}: all are 0 here.",
            "# A centimeter and a degree are enough; recon4 calibrate finds the rest.",
        ]
    uncertain = [*uncertain, *_turned_imu(rig)]
    lines += [f"# {' '.join(text.split())}" for text in uncertain]
    text = format_rig(rig)
    if not mounted:
        text = text.replace("quat_xyzw = [0.0, 0.0, 0.0, 1.0]", "rpy_deg = [0.0, 0.0, 0.0]")
    return "\n".join([*lines, text])


def _turned_imu(rig: Rig) -> list[str]:
    """What is not certain of an IMU whose axes are not those of the points of its LiDAR."""
    models = [lidar_model(one.model) for one in rig.sensors if one.name == rig.imu_sensor]
    return [
        f"Uncertain: the IMU of an {model.name} is taken as turned by rpy_deg = "
        f"{list(model.rpy_sensor_imu_deg)} against its points, as public reports say; another "
        "mount: rpy_deg of [imu], in the body"
        for model in models
        if any(model.rpy_sensor_imu_deg)
    ]


def write_first_rig(text: str, path: Path) -> None:
    """Write a rig file that is not there yet.

    Raises:
        ConfigError: If there is nothing to write, or the file exists.
        StoreError: If it cannot be written.
    """
    if not text:
        raise ConfigError(CodedText("rig-no-sensor-known", file=path.name))
    if path.exists():
        raise ConfigError(CodedText("rig-file-exists", file=str(path)))
    write_text(path, text)
