"""The folders of the multiframes of a project, by name: what a worker opens."""

from __future__ import annotations

from pathlib import Path

import msgspec

from recon4.store.frames import FrameStore, open_frames


class FrameFolders(msgspec.Struct, frozen=True):
    """Artifacts in which the multiframes are; paths are absolute, the same on all computers."""

    frames: str
    odometry: str
    calibration: str | None

    @staticmethod
    def of(frames: Path, odometry: Path, calibration: Path | None) -> FrameFolders:
        """Those of a project."""
        found = None if calibration is None else str(calibration.absolute())
        return FrameFolders(str(frames.absolute()), str(odometry.absolute()), found)

    def open(self) -> FrameStore:
        """Open the multiframes, as `open_frames`.

        Raises:
            StoreError: If a folder is incomplete or damaged.
            ConfigError: If the rig file is damaged.
        """
        calibration = None if self.calibration is None else Path(self.calibration)
        return open_frames(Path(self.frames), calibration, Path(self.odometry))
