"""Tuning of what is stored."""

from __future__ import annotations

from msgspec import Struct


class PackingTuning(Struct, frozen=True, kw_only=True):
    """Points as compressed bytes. Study: docs/studies/storage.md."""

    step: int = -11
    """Power of two of the step of coordinates, 0.49 mm: a quarter of the resolution of a Velodyne,
    half of that of an Ouster or Livox."""
    level: int = 1
    """Of Zstandard. A higher one makes the noise of a sensor no smaller, and takes longer."""

    @property
    def step_m(self) -> float:
        """Step of coordinates [m]."""
        return float(2.0**self.step)


PACKING = PackingTuning()


class SqliteTuning(Struct, frozen=True, kw_only=True):
    """Databases of one file."""

    busy_s: float = 10.0
    """Longest wait for another writer [s]."""
    room_beside_bytes: int = 64 << 10
    """The index of a write-ahead log takes 32 KiB."""


SQLITE = SqliteTuning()


class CheckedFilesTuning(Struct, frozen=True, kw_only=True):
    """Files whose hashes are checked while they are read."""

    remembered: int = 4096
    """Number of files whose checked blocks are remembered."""


CHECKED_FILES = CheckedFilesTuning()
