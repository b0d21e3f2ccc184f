"""What the multiframes of a walk are read from."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from os import PathLike
from pathlib import Path

from recon4.errors import RecordingError
from recon4.locales.coded import CodedText
from recon4.model.clock_jump import ClockJump
from recon4.model.rig import Rig


@dataclass(frozen=True, slots=True)
class Sources:
    """The files of one walk, and what replaces the contents of its recordings.

    >>> walk = api.Sources.of("recording/recording.pcap", rig="4recon", imu="recording/imu.csv")
    >>> walk.rig.name, [path.name for path in walk.paths]
    ('4RECON', ['recording.pcap', 'imu.csv'])
    """

    recordings: tuple[Path, ...]
    """Files or folders: pcap, bags, folders of clouds."""
    rig: Rig | None = None
    """Sensors and mountings; None = chosen from the recording."""
    imu: Path | None = None
    """CSV file, in place of the recording's IMU samples."""
    gnss: Path | None = None
    """File of positions, in place of the recording's GNSS samples."""
    near: tuple[Path, ...] = ()
    """Files beside the recordings (`recon4.recording.info.files_near`), for a process
    that may not list their folders."""
    jumps: tuple[ClockJump, ...] = ()
    """Where all clocks were set ahead, as a first reading showed."""

    @staticmethod
    def of(
        *recordings: str | PathLike[str],
        rig: str | PathLike[str] | Rig | None = None,
        imu: str | PathLike[str] | None = None,
        gnss: str | PathLike[str] | None = None,
    ) -> Sources:
        """The files of one walk by their paths.

        Args:
            recordings: Files or folders: pcap, bags, folders of clouds; several are one walk.
            rig: Rig file, with files beside it that describe its LiDARs, or the name of a shipped
                rig; None = chosen from the recording.
            imu: CSV file, in place of the recording's IMU samples.
            gnss: File of positions, in place of the recording's GNSS samples.

        Raises:
            ConfigError: If the rig cannot be read.
        """
        from recon4.recording.packets.companions import load_described_rig  # brings the decoders

        return Sources(
            tuple(map(Path, recordings)),
            rig if rig is None or isinstance(rig, Rig) else load_described_rig(rig)[0],
            Path(imu) if imu else None,
            Path(gnss) if gnss else None,
        )

    def require(self) -> None:
        """Check that there is something to read, before anything is made for nothing.

        Raises:
            RecordingError: If no recording is given, or a file or folder does not exist.
        """
        if not self.recordings:
            raise RecordingError(CodedText("recording-not-given"))
        require_files(self.paths)

    @property
    def paths(self) -> tuple[Path, ...]:
        """All files and folders that are read."""
        return (*self.recordings, *(path for path in (self.imu, self.gnss) if path))


def require_files(paths: Iterable[Path]) -> None:
    """Check that files and folders exist.

    Raises:
        RecordingError: If one does not.
    """
    for path in paths:
        if not path.exists():
            raise RecordingError(CodedText("no-file", path=str(path)))
