"""Tuning of the preview."""

from __future__ import annotations

from msgspec import Struct


class PreviewCloudTuning(Struct, frozen=True, kw_only=True):
    """Preview of the map."""

    first_voxel_m: float = 0.1
    """Edge of the voxels at first [m]."""
    max_points: int = 400_000
    """Above this the voxel size is doubled; a phone can draw 500 k points."""
    longest: int = 1 << 15
    """Voxel coordinates are sent as int16."""


PREVIEW_CLOUD = PreviewCloudTuning()


class FloorDetectionTuning(Struct, frozen=True, kw_only=True):
    """Floors of a building."""

    apart_m: float = 2.0
    """Height difference to all known floors at which a new floor starts."""
    nearer_m: float = 0.5
    """Hysteresis: another floor must be nearer by this, so that stairs do not toggle the floor."""
    follow: float = 0.005
    """Gain of the floor height per multiframe (time constant 20 s): a street that rises gently
    stays one floor, stairs are faster."""


FLOOR_DETECTION = FloorDetectionTuning()


class PlanTileTuning(Struct, frozen=True, kw_only=True):
    """The plan of what was seen, in square tiles."""

    cell_m: float = 0.25
    """Edge of a cell [m]."""
    tile: int = 64
    """Side of a tile [cells]."""
    around: int = 2
    """Tiles of the window on each side of the body's tile."""
    shown: int = 64
    """Tiles on each side of the body's tile that a layer is given for: 8256 cells in all, which a
    phone can draw, and which bound the memory when the body jumps far away."""

    @property
    def window(self) -> int:
        """Side of the window [cells]."""
        return self.tile * (2 * self.around + 1)

    @property
    def margin(self) -> int:
        """Smallest distance of the body from the border of the window [cells]."""
        return self.tile * self.around

    @property
    def ray_m(self) -> float:
        """Length up to which rays are traced, 30 m."""
        return self.cell_m * (self.margin - 8)


PLAN_TILES = PlanTileTuning()
