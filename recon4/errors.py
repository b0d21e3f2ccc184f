"""Exceptions of recon4.

    Recon4Error
    ├── ConfigError            a setting or a rig file is wrong (also a ValueError)
    │   └── WrongSettings      all that is wrong with a set of settings at once
    ├── RecordingError         a recording cannot be read
    │   ├── UnknownFormat      no reader recognizes the file
    │   ├── EmptyRecording     the file is readable but has no points
    │   └── CorruptFile        bytes do not match the format
    ├── OutOfRange             a time is outside the trajectory
    ├── MapTooLarge            a map has more cells than fit into memory
    ├── CalibrationError       measurements do not determine a calibration
    ├── GraphError             a pose graph cannot be solved (not finite, not connected, …)
    ├── GeoreferenceError      no usable CRS, transformation or position
    ├── StoreError             a project folder is damaged, locked or cannot be written
    │   └── NoSpace            the disk is full
    └── Cancelled              the caller requested to stop (not a failure)

A measurement that turns out bad is not an error: it is a value
(``Registration.converged``, ``Edge.verdict``, ``OdometryStep.lost``).

>>> try:
...     api.process("missing.pcap", "out")
... except api.errors.RecordingError as error:
...     print(error)
cannot read missing.pcap: there is no such file or folder
"""

from __future__ import annotations

from pathlib import Path


class Recon4Error(Exception):
    """Base of the tree above; the message can be shown to an operator."""


class ConfigError(Recon4Error, ValueError):
    """A setting or a rig file is wrong."""


class WrongSettings(ConfigError):
    """All that is wrong with a set of settings at once."""

    def __init__(self, problems: dict[str, str]) -> None:
        super().__init__(problems)
        self.problems = problems
        """``group.field``, or the text itself if it has none -> description of the problem."""

    def __str__(self) -> str:
        return "; ".join(self.problems.values())


class RecordingError(Recon4Error):
    """A recording cannot be read."""


class UnknownFormat(RecordingError):
    """No reader recognizes the file."""

    def __init__(self, message: str, *, candidates: tuple[Path, ...] = ()) -> None:
        super().__init__(message)
        self.candidates = candidates
        """Recordings in a folder that is none itself: one of them may be meant."""


class EmptyRecording(RecordingError):
    """The file is readable but has no points."""


class CorruptFile(RecordingError):
    """Bytes do not match the format."""


class OutOfRange(Recon4Error):
    """A time is outside the trajectory."""


class MapTooLarge(Recon4Error):
    """A map has more cells than fit into memory."""


class CalibrationError(Recon4Error):
    """Measurements do not determine a calibration."""


class GraphError(Recon4Error):
    """A pose graph cannot be solved."""


class GeoreferenceError(Recon4Error):
    """No usable CRS, transformation or position."""


class StoreError(Recon4Error):
    """A project folder is damaged, locked or cannot be written."""


class NoSpace(StoreError):
    """The disk is full."""


class Cancelled(Recon4Error):
    """The caller requested to stop."""
