"""The calibrated rig of a project, where there is one."""

from __future__ import annotations

from pathlib import Path

from recon4.model.rig import load_rig
from recon4.store.frames import FrameStore

RIG_FILE = "rig.toml"
"""In the folder of the stage `calibration`: the calibrated rig, if it is used."""


def open_frames(frames: Path, calibration: Path | None) -> FrameStore:
    """Open the multiframes of a project with its calibrated rig, if that is used.

    Args:
        frames: Folder of the stage ``frames``.
        calibration: Folder of the stage ``calibration``; None = the rig of the recording.

    Raises:
        StoreError: If a folder is incomplete or damaged.
        ConfigError: If the rig file is damaged.
    """
    path = calibration / RIG_FILE if calibration else None
    return FrameStore.open(frames, load_rig(path) if path and path.is_file() else None)
