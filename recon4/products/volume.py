"""Volume between a terrain and a plane inside of a polygon."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.errors import ConfigError
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.products.terrain import Terrain
from recon4.products.tuning import TERRAIN


@dataclass(frozen=True, slots=True)
class Volume:
    """What lies above and below a plane."""

    above_m3: float
    below_m3: float
    sd_m3: float
    """Standard deviation (1 σ) of their difference [m³]."""
    area_m2: float
    """Of the polygon."""
    unseen_m2: float
    """Part of it without a height: it counts as nothing."""
    base_m: float
    """Height of the plane in the middle of the polygon, in the map [m]."""
    base_sd_m: float
    """Standard deviation of the base in its middle [m]; 0 = the plane was given."""
    fitted: float = 1.0
    """Part of the border's cells that the base goes through: walls and other heaps are left out."""

    @property
    def text(self) -> str:
        """All figures in words."""
        return CodedText(
            "volume-made",
            fitted=self.fitted,
            above_m3=self.above_m3,
            below_m3=self.below_m3,
            sd_m3=self.sd_m3,
            area_m2=self.area_m2,
            unseen_m2=self.unseen_m2,
            base_m=self.base_m,
        )


def volume(
    terrain: Terrain, polygon: Array, *, rng: np.random.Generator, base_m: float | None = None
) -> Volume:
    """Sum the cells of a terrain over a plane.

    The deviation has three parts: that of each cell (independent), that of the map's heights as
    far as the covariances of its poses state it, and that of the base (both common to all cells):
    ``sd² = Σ (a sd_cell)² + (A sd_map)² + (A sd_base)²``. With a base that is fitted to the border
    the map's own part cancels: only the difference of heights counts.

    Args:
        terrain: Heights.
        polygon: Corners in the map, x and y [m], (N, 2).
        rng: For the hypotheses of the base.
        base_m: Height of a level plane in the map [m]; None = a plane fitted to the terrain along
            the border, without what stands there.

    Raises:
        ConfigError: If the polygon has no area or crosses itself, or nothing was seen in it.
    """
    inside, border, area = _cells_in(terrain, polygon)
    rows = inside & terrain.seen
    if not rows.any():
        raise ConfigError(CodedText("heap-nothing"))
    x, y = (axis[rows] for axis in np.meshgrid(*terrain.centers_m()))
    plane, base_sd, fitted = (np.array([0.0, 0.0, base_m]), 0.0, 1.0)
    map_sd = terrain.position_sd_m
    if base_m is None:
        plane, base_sd, fitted = _fitted_base(terrain, border, rng)
        map_sd = 0.0
    base = np.column_stack([x, y, np.ones(len(x))]) @ plane
    off = terrain.height_m[rows] - base
    cell = area / max(1, int(inside.sum()))
    sd = np.sqrt(
        np.sum((cell * terrain.sd_m[rows].astype(np.float64)) ** 2)
        + (cell * len(off) * map_sd) ** 2
        + (cell * len(off) * base_sd) ** 2
    )
    return Volume(
        float(cell * off[off > 0].sum()),
        float(cell * np.abs(off[off < 0]).sum()),
        float(sd),
        area,
        float(cell * (inside & ~terrain.seen).sum()),
        float(base.mean()),
        base_sd,
        fitted,
    )


def _cells_in(
    terrain: Terrain, polygon: Array
) -> tuple[NDArray[np.bool_], NDArray[np.bool_], float]:
    """Cells inside of a polygon, those near its border, and its area [m²]."""
    from shapely import Polygon, contains_xy, is_valid_reason, prepare

    corners = np.asarray(polygon, dtype=np.float64)
    if corners.ndim != 2 or corners.shape[1:] != (2,) or len(corners) < 3:
        raise ConfigError(CodedText("heap-corners", count=len(corners)))
    shape = Polygon(corners)
    if not shape.is_valid or shape.area < terrain.grid.pixel_m**2:
        raise ConfigError(CodedText("heap-no-area", shape=str(is_valid_reason(shape))))
    x, y = np.meshgrid(*terrain.centers_m())
    near = shape.exterior.buffer(TERRAIN.border_m)
    prepare(shape)
    prepare(near)
    return contains_xy(shape, x, y), contains_xy(near, x, y), float(shape.area)


def _fitted_base(
    terrain: Terrain, border: NDArray[np.bool_], rng: np.random.Generator
) -> tuple[Array, float, float]:
    """Plane ``z = a x + b y + c`` through the terrain along a border.

    Least median of squares and, through what is within 2.5 robust standard deviations of it, least
    squares (Rousseeuw and Leroy 1987): a wall beside a heap does not lift the base.

    Returns:
        Plane, (3,); its deviation [m]; part of the cells that it was fitted to.
    """
    rows = border & terrain.seen
    if rows.sum() < TERRAIN.border_cells:
        raise ConfigError(
            CodedText("heap-border", border_cells=TERRAIN.border_cells, rows=int(rows.sum()))
        )
    x, y = (axis[rows] for axis in np.meshgrid(*terrain.centers_m()))
    A, z = np.column_stack([x, y, np.ones(len(x))]), terrain.height_m[rows].astype(np.float64)
    inside = _on_one_plane(A, z, rng)
    plane = np.asarray(np.linalg.lstsq(A[inside], z[inside], rcond=None)[0], np.float64)
    residual, count = (z - A @ plane)[inside], int(inside.sum())
    sd = float(np.sqrt(residual @ residual / max(1, count - 3) / count))
    return plane, sd, count / len(z)


def _on_one_plane(A: Array, z: Array, rng: np.random.Generator) -> NDArray[np.bool_]:
    """Which heights are on the plane with the least median of squared residuals, (N,)."""
    few = slice(None, None, -(-len(z) // TERRAIN.most_cells))
    triples = rng.integers(0, len(z), (TERRAIN.hypotheses, 3))
    triples = triples[np.abs(np.linalg.det(A[triples])) > 2.0 * TERRAIN.triangle_m2]
    if not len(triples):
        raise ConfigError(CodedText("heap-border-line"))
    planes = np.linalg.solve(A[triples], z[triples, None])[..., 0]
    off = np.median(np.abs(z[few] - planes @ A[few].T), axis=1)
    best = int(np.argmin(off))
    sd = max(1.4826 * float(off[best]), TERRAIN.border_sd_m)
    return np.abs(z - A @ planes[best]) <= 2.5 * sd
