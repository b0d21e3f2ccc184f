"""Kernels of free space: what a scan sees through, as an image of ranges around its sensor."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

NO_SURFACE = np.float32(np.inf)
"""Value of a cell without a return."""


class Verdicts(NamedTuple):
    """What other scans say of a point."""

    met: int = -1
    """A surface is there."""
    unknown: int = 0
    seen_through: int = 1
    """Nothing stands there."""
    hidden: int = 2
    """All that a scan has around its direction lies before it."""


VERDICT = Verdicts()


class Sights(NamedTuple):
    """Scans of S sensors as images of ranges. Kernels index it: a part of an array is dear."""

    R: NDArray[np.float64]
    """Rotations of the sensors in the map, (M, S, 3, 3)."""
    t: NDArray[np.float64]
    """Their places [m], (M, S, 3)."""
    images: NDArray[np.float32]
    """Of `nearest_ranges`, (M, S, rows, columns) [m]."""


@njit(cache=True, nogil=True, error_model="numpy")
def to_sensor(
    p: tuple[float, float, float], sights: Sights, v: int, s: int
) -> tuple[float, float, float]:
    """A point in the frame of a sensor of a scan."""
    R, t = sights.R, sights.t
    dx, dy, dz = p[0] - t[v, s, 0], p[1] - t[v, s, 1], p[2] - t[v, s, 2]
    return (
        R[v, s, 0, 0] * dx + R[v, s, 1, 0] * dy + R[v, s, 2, 0] * dz,
        R[v, s, 0, 1] * dx + R[v, s, 1, 1] * dy + R[v, s, 2, 1] * dz,
        R[v, s, 0, 2] * dx + R[v, s, 1, 2] * dy + R[v, s, 2, 2] * dz,
    )


@njit(cache=True, nogil=True, error_model="numpy")
def cell_towards(x: float, y: float, z: float, shape: tuple[int, int]) -> tuple[int, int, float]:
    """Row (elevation), column (azimuth) and range of a point in the image of its sensor."""
    flat = math.sqrt(x * x + y * y)
    row = int((math.atan2(z, flat) / math.pi + 0.5) * shape[0])
    column = int((math.atan2(y, x) / (2.0 * math.pi) + 0.5) * shape[1])
    range_m = math.sqrt(flat * flat + z * z)
    return min(max(row, 0), shape[0] - 1), column % shape[1], range_m


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def column_beside(column: int, step: int, columns: int) -> int:
    """A column of an image that goes all around, without a division."""
    j = column + step
    if j < 0:
        return j + columns
    return j - columns if j >= columns else j


@njit(cache=True, nogil=True, error_model="numpy")
def nearest_ranges(
    points: NDArray[np.float64],
    R: NDArray[np.float64],
    t: NDArray[np.float64],
    image: NDArray[np.float32],
) -> None:
    """Write the range of the nearest point in each direction into an image.

    Args:
        points: In the frame of the trajectory [m], (N, 3).
        R: Rotation of the sensor in that frame, (3, 3).
        t: Its place [m], (3,).
        image: Elevation from straight down to straight up by azimuth [m], `NO_SURFACE` at first,
            (rows, columns).
    """
    for n in range(len(points)):
        dx, dy, dz = points[n, 0] - t[0], points[n, 1] - t[1], points[n, 2] - t[2]
        x = R[0, 0] * dx + R[1, 0] * dy + R[2, 0] * dz
        y = R[0, 1] * dx + R[1, 1] * dy + R[2, 1] * dz
        z = R[0, 2] * dx + R[1, 2] * dy + R[2, 2] * dz
        row, column, range_m = cell_towards(x, y, z, image.shape)
        if range_m < image[row, column]:
            image[row, column] = range_m


@njit(cache=True, nogil=True, error_model="numpy")
def sight(
    images: NDArray[np.float32],
    image: tuple[int, int],
    cell: tuple[int, int],
    range_m: float,
    limits: tuple[float, float],
) -> int:
    """One of `VERDICT`, by how far everything lies behind and how near a surface is [m].

    What stands beside the point or lies a little lower keeps it: all around has to lie behind, with
    returns on all four sides: the lowest beam passes above the ground before the feet.
    """
    # Most points are where they were: their own cell says so.
    (v, s), (row, column) = image, cell
    if abs(images[v, s, row, column] - range_m) < limits[1]:
        return VERDICT.met
    rows, columns = images.shape[2:]
    nearest_m = np.inf
    below = above = left = right = False
    for i in range(max(row - 1, 0), min(row + 2, rows)):
        for step in range(-1, 2):
            seen_m = images[v, s, i, column_beside(column, step, columns)]
            if seen_m == np.inf:
                continue
            if abs(seen_m - range_m) < limits[1]:
                return VERDICT.met
            below, above = below or i < row, above or i > row
            left, right = left or step < 0, right or step > 0
            nearest_m = min(nearest_m, seen_m)
    around = below and above and left and right
    return VERDICT.seen_through if around and nearest_m > range_m + limits[0] else VERDICT.unknown


@njit(cache=True, nogil=True, error_model="numpy")
def find_moving_points(
    points: NDArray[np.float64],
    R: NDArray[np.float64],
    t: NDArray[np.float64],
    images: NDArray[np.float32],
    rules: NDArray[np.float64],
    moving: NDArray[np.bool_],
) -> None:
    """Which points move: more scans see through them than meet a surface there.

    A scan meets a surface if one of its sensors does. The scans are asked in their order, until
    enough of them agree.

    Args:
        points: In the frame of the trajectory [m], (N, 3).
        R: Rotations of the S sensors of each scan in that frame, (V, S, 3, 3).
        t: Their places [m], (V, S, 3).
        images: Of `nearest_ranges`, (V, S, rows, columns).
        rules: Margin [m], margin per range, nearest and farthest range [m] of a point that is
            compared, fewest scans that see through a moving point, and by how many more than the
            others scans agree, (6,).
        moving: Filled, (N,).
    """
    shape, sights = images.shape[2:], Sights(R, t, images)
    for n in range(len(points)):
        p = points[n, 0], points[n, 1], points[n, 2]
        passes = meets = 0
        for v in range(len(images)):
            vote = 0
            for s in range(images.shape[1]):
                row, column, range_m = cell_towards(*to_sensor(p, sights, v, s), shape)
                if range_m < rules[2] or range_m > rules[3]:
                    continue
                margin_m = rules[0] + rules[1] * range_m
                seen = sight(images, (v, s), (row, column), range_m, (margin_m, margin_m))
                if seen < 0:
                    vote = -1
                    break
                vote = max(vote, seen)
            passes += vote > 0
            meets += vote < 0
            if abs(passes - meets) >= rules[5]:
                break
        moving[n] = passes >= rules[4] and passes > meets
