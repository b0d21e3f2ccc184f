"""What the multiframes of a walk are read from."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from recon4.model.rig import Rig


@dataclass(frozen=True, slots=True)
class Sources:
    """The files of one walk, and what replaces the contents of its recordings."""

    recordings: tuple[Path, ...]
    """Files or folders: pcap, bags, folders of clouds."""
    rig: Rig | None = None
    """Sensors and mountings; None = chosen from the recording."""
    imu: Path | None = None
    """CSV file, in place of the recording's IMU samples."""
    gnss: Path | None = None
    """CSV file, in place of the recording's GNSS samples."""

    @property
    def paths(self) -> tuple[Path, ...]:
        """All files and folders that are read."""
        return (*self.recordings, *(path for path in (self.imu, self.gnss) if path))
