"""Grid of the map: voxels form cells, cells form tiles, without remainder."""

from __future__ import annotations

from dataclasses import dataclass

from recon4.settings import MapSettings


@dataclass(frozen=True, slots=True)
class Grid:
    """Edge lengths; every cell border is a voxel border and every tile border a cell border."""

    voxel_m: float
    """Edge of a voxel [m]. If all points are kept, voxels only sort them."""
    cell_voxels: int
    """Voxels along a cell."""
    tile_cells: int
    """Cells along a tile."""
    thin: bool
    """Whether one point per voxel is kept, or all."""
    halo_cells: int = 1
    """Cells of the halo around a tile. Surfaces need two: planes are taken from the windows of
    neighboring cells, which must be complete."""

    @staticmethod
    def of(settings: MapSettings) -> Grid:
        """The grid nearest to the settings: cells and tiles are rounded to multiples."""
        voxel_m = settings.voxel_m or 0.01
        cell_voxels = max(1, round(settings.normal_cell_m / voxel_m))
        tile_cells = max(1, round(settings.tile_m / (cell_voxels * voxel_m)))
        halo_cells = 2 if settings.surface == "fitted" else 1
        return Grid(voxel_m, cell_voxels, tile_cells, settings.voxel_m > 0.0, halo_cells)

    @property
    def cell_m(self) -> float:
        """Edge of a cell [m]."""
        return self.voxel_m * self.cell_voxels

    @property
    def halo_m(self) -> float:
        """Width of the halo around a tile [m]."""
        return self.cell_m * self.halo_cells

    @property
    def tile_m(self) -> float:
        """Edge of a tile [m]."""
        return self.voxel_m * self.cell_voxels * self.tile_cells

    @property
    def side_cells(self) -> int:
        """Cells along a tile with its halo."""
        return self.tile_cells + 2 * self.halo_cells

    @property
    def key_bits(self) -> int:
        """Bits of the index of a voxel in a tile with its halo."""
        return int((self.cell_voxels * self.side_cells) ** 3).bit_length()
