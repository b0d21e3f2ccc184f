"""Tuning of the preview."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class PreviewCloudTuning:
    """Preview of the map."""

    first_voxel_m: float = 0.1
    """Edge of the voxels at first [m]."""
    max_points: int = 400_000
    """Above this the voxel size is doubled; a phone can draw 500 k points."""
    longest: int = 1 << 15
    """Voxel coordinates are sent as int16."""


PREVIEW_CLOUD = PreviewCloudTuning()


@dataclass(frozen=True, slots=True, kw_only=True)
class FloorDetectionTuning:
    """Floors of a building."""

    apart_m: float = 2.0
    """Height difference to all known floors at which a new floor starts."""
    nearer_m: float = 0.5
    """Hysteresis: another floor must be nearer by this, so that stairs do not toggle the floor."""
    follow: float = 0.005
    """Gain of the floor height per multiframe (time constant 20 s): a street that rises gently
    stays one floor, stairs are faster."""


FLOOR_DETECTION = FloorDetectionTuning()
