"""Tuning of what is stored."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class PackingTuning:
    """Points as compressed bytes. Study: docs/studies/storage.md."""

    step: int = -11
    """Power of two of the step of coordinates, 0.49 mm: a quarter of the resolution of a Velodyne,
    half of that of an Ouster or Livox."""
    level: int = 1
    """Of Zstandard. A higher one makes the noise of a sensor no smaller, and takes longer."""


PACKING = PackingTuning()
