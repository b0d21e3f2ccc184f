"""Layouts of PointCloud2 messages, as drivers write them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tests.variants.variant import Draw
from tests.variants.walk import Cloud

CODES = {"i1": 1, "u1": 2, "i2": 3, "u2": 4, "i4": 5, "u4": 6, "f4": 7, "f8": 8}
Field = tuple[str, str, int]
"""Name, type and offset [bytes]."""


@dataclass(frozen=True, slots=True)
class Layout:
    """Fields of a point."""

    driver: str
    fields: tuple[Field, ...]
    step: int
    """Bytes of a point."""
    time: str = ""
    """How the field of times is to be filled; empty = there is none."""
    big: bool = False
    """Big-endian."""
    organized: bool = False
    """Rows of rings, with NaN where nothing returned."""
    dense: bool = True
    """What ``is_dense`` says."""

    @property
    def has_times(self) -> bool:
        """Whether the times of the points are fine enough to be used."""
        types = {name: kind for name, kind, _ in self.fields}
        return bool(self.time) and (self.time != "s absolute" or types.get("time") != "f4")

    @property
    def stamp_at(self) -> float:
        """Where in the duration of a message its stamp is: 0 at the start, 1 at the end."""
        return {"before": 1.0, "around": 0.5}.get((f"{self.time} ").split(" ")[1], 0.0)

    @property
    def dtype(self) -> np.dtype[Any]:
        """Of a point."""
        order = ">" if self.big else "<"
        names, types, offsets = zip(*self.fields, strict=True)
        formats = [order + kind for kind in types]
        return np.dtype(
            {"names": names, "formats": formats, "offsets": offsets, "itemsize": self.step}
        )


_XYZ: tuple[Field, ...] = (("x", "f4", 0), ("y", "f4", 4), ("z", "f4", 8))
DRIVERS = (
    Layout(
        "velodyne",
        (*_XYZ, ("intensity", "f4", 12), ("ring", "u2", 16), ("time", "f4", 18)),
        22,
        "s",
    ),
    Layout(
        "velodyne, stamp at the end",
        (*_XYZ, ("intensity", "f4", 16), ("ring", "u2", 20), ("time", "f4", 24)),
        32,
        "s before the stamp",
    ),
    Layout("velodyne_pointcloud 1.2", (*_XYZ, ("intensity", "f4", 16), ("ring", "u2", 20)), 32),
    Layout(
        "ouster",
        (
            *_XYZ,
            ("intensity", "f4", 16),
            ("t", "u4", 20),
            ("reflectivity", "u2", 24),
            ("ring", "u1", 26),
            ("ambient", "u2", 28),
            ("range", "u4", 32),
        ),
        48,
        "ns",
    ),
    Layout(
        "hesai",
        (*_XYZ, ("intensity", "f4", 16), ("timestamp", "f8", 24), ("ring", "u2", 32)),
        48,
        "s absolute",
    ),
    Layout(
        "robosense",
        (*_XYZ, ("intensity", "f4", 12), ("ring", "u2", 16), ("timestamp", "f8", 18)),
        26,
        "s absolute",
    ),
    Layout(
        "livox_ros_driver2",
        (
            *_XYZ,
            ("intensity", "f4", 12),
            ("tag", "u1", 16),
            ("line", "u1", 17),
            ("timestamp", "f8", 18),
        ),
        26,
        "ns absolute",
    ),
    Layout(
        "livox, offset_time",
        (*_XYZ, ("reflectivity", "u1", 12), ("line", "u1", 13), ("offset_time", "u4", 16)),
        20,
        "ns",
    ),
    Layout(
        "float64",
        (
            ("x", "f8", 0),
            ("y", "f8", 8),
            ("z", "f8", 16),
            ("intensity", "u2", 24),
            ("t_us", "u4", 28),
            ("laser_id", "u2", 32),
        ),
        40,
        "us",
    ),
    Layout(
        "milliseconds",
        (*_XYZ, ("i", "u1", 12), ("channel", "u1", 13), ("time_offset", "f4", 16)),
        20,
        "ms",
    ),
    Layout(
        "ouster, signed times",
        (*_XYZ, ("signal", "f4", 12), ("t", "i4", 16), ("ring", "u2", 20), ("range", "u4", 24)),
        28,
        "ns before the stamp",
    ),
    Layout(
        "ouster, absolute times",
        (*_XYZ, ("intensity", "f4", 16), ("t", "f8", 24), ("ring", "u1", 32)),
        48,
        "ns absolute",
    ),
    Layout(
        "hesai, float64 all over",
        (
            ("x", "f8", 0),
            ("y", "f8", 8),
            ("z", "f8", 16),
            ("intensity", "f8", 24),
            ("timestamp", "f8", 32),
            ("ring", "i4", 40),
        ),
        48,
        "s absolute",
    ),
    Layout(
        "robosense, since the start",
        (*_XYZ, ("intensity", "u1", 12), ("ring", "u2", 14), ("timestamp", "f8", 16)),
        24,
        "s",
    ),
    Layout(
        "livox, microseconds",
        (*_XYZ, ("intensity", "f4", 12), ("line", "u1", 16), ("timestamp", "f8", 20)),
        28,
        "us absolute",
    ),
    Layout(
        "livox, float32 nanoseconds",
        (*_XYZ, ("intensity", "f4", 12), ("line", "u1", 16), ("offset_time", "f4", 20)),
        24,
        "ns",
    ),
    Layout(
        "a merged cloud in float32 seconds",
        (*_XYZ, ("intensity", "f4", 12), ("ring", "f4", 16), ("time", "f4", 20)),
        24,
        "s absolute",
    ),
    Layout(
        "aeva, stamp in the middle",
        (*_XYZ, ("intensity", "f4", 12), ("line", "i2", 16), ("time_offset", "i4", 20)),
        24,
        "ns around the stamp",
    ),
    Layout("x y z alone", _XYZ, 16),
    Layout("pcl::PointXYZI", (*_XYZ, ("intensity", "f4", 16)), 32),
)


def draw_layout(draw: Draw) -> Layout:
    """A driver's layout, with what its users change."""
    layout: Layout = draw.one(*DRIVERS)
    return replace(
        layout,
        big=draw.chance(0.08),
        organized=draw.chance(0.25),
        dense=draw.chance(0.6),
        step=layout.step + draw.one(0, 0, 0, 4, 16),
    )


def points_of(cloud: Cloud, layout: Layout, *, stamp_ns: int, t0_ns: int) -> NDArray[Any]:
    """The points of a cloud in a layout.

    Args:
        cloud: The cloud.
        layout: Of a point.
        stamp_ns: Stamp of the message on the clock of the sensor [ns].
        t0_ns: Start of the cloud on that clock [ns].
    """
    points = np.zeros(len(cloud.xyz), layout.dtype)
    for name, kind, _ in layout.fields:
        points[name] = _column(cloud, name, kind, times=_times(cloud, layout, stamp_ns, t0_ns))
    if not layout.organized:
        return points
    return _organized(points, cloud.ring)


def _column(cloud: Cloud, name: str, kind: str, *, times: NDArray[Any]) -> NDArray[Any]:
    if name in "xyz":
        return cloud.xyz[:, "xyz".index(name)]
    if name in ("intensity", "i", "reflectivity", "signal"):
        return np.minimum(cloud.intensity, 255) if kind == "u1" else cloud.intensity
    if name in ("ring", "line", "laser_id", "channel"):
        return cloud.ring
    if name == "range":
        return np.rint(np.linalg.norm(cloud.xyz, axis=1) * 1000.0)
    if name in ("tag", "ambient"):
        return np.zeros(len(cloud.ring))
    return times


def _times(cloud: Cloud, layout: Layout, stamp_ns: int, t0_ns: int) -> NDArray[Any]:
    since = cloud.dt_ns + (t0_ns - stamp_ns)
    scale = {"s": 1e-9, "ms": 1e-6, "us": 1e-3, "ns": 1.0}
    unit = layout.time.split(" ")[0]
    if not unit:
        return np.zeros(len(since))
    absolute = layout.time.endswith("absolute")
    return (since + stamp_ns if absolute else since) * scale[unit]


def _organized(points: NDArray[Any], ring: NDArray[np.uint8]) -> NDArray[Any]:
    """One row a ring, filled up with NaN, (16, W)."""
    width = int(np.bincount(ring, minlength=16).max())
    table = np.zeros((16, width), points.dtype)
    for name in "xyz":
        table[name] = np.nan
    for row in range(16):
        of_ring = points[ring == row]
        table[row, : len(of_ring)] = of_ring
    return table
