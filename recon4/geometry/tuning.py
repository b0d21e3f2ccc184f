"""Tuning of geometry and ray casting."""

from __future__ import annotations

from msgspec import Struct


class LineGeometryTuning(Struct, frozen=True, kw_only=True):
    """Lines in space."""

    parallel_sin2: float = 1e-6
    """Squared sine of the angle below which two lines count as parallel (0.06°)."""


LINES = LineGeometryTuning()


class PoseBlockTuning(Struct, frozen=True, kw_only=True):
    """Poses that are computed at a time."""

    poses: int = 1 << 14
    """Of a dense trajectory: what interpolation needs in between takes 0.6 kB a pose."""


POSE_BLOCK = PoseBlockTuning()


class SurfaceReflectivity(Struct, frozen=True, kw_only=True):
    """How much of the light surfaces return."""

    glass: float = 0.02
    """Window glass."""
    clear: float = 0.004
    """Clear glass."""
    mirror: float = 0.001
    """A mirror."""


SURFACES = SurfaceReflectivity()


class RaycastTuning(Struct, frozen=True, kw_only=True):
    """Ray casting."""

    nearest_batch: int = 1_000_000
    """Points whose nearest surface is looked for at a time."""


RAYCASTING = RaycastTuning()
