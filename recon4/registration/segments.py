"""Collar line segments of a multiframe: the features of every registration."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.kernels.segments import draw_pairs, points_of_sensor, segment_ends
from recon4.model.lidar_facts import LidarFacts
from recon4.model.lidars import lidar_model
from recon4.model.multiframe import Multiframe
from recon4.model.rig import Rig
from recon4.registration.in_body import in_body
from recon4.registration.tuning import SEGMENTS, SegmentTuning


@dataclass(frozen=True, slots=True, eq=False)
class Segments:
    """Segments between neighboring rings; each end was measured at its own time."""

    a_body: Array
    """First end in the body frame of its own time [m], (N, 3)."""
    b_body: Array
    """Second end, likewise, (N, 3)."""
    a_s: Array
    """Time of the first end after the start of the frame [s], (N,)."""
    b_s: Array
    """Time of the second end, (N,)."""
    range_m: Array
    """Distance of the nearer end from its sensor [m], (N,)."""

    def __len__(self) -> int:
        return len(self.a_s)


NO_SEGMENTS = Segments(np.empty((0, 3)), np.empty((0, 3)), np.empty(0), np.empty(0), np.empty(0))
"""Those of a frame without points."""


def sample_segments(frame: Multiframe, rig: Rig, settings: SegmentTuning = SEGMENTS) -> Segments:
    """Draw the collar line segments of all enabled sensors (requirements A3.1, 1-3).

    The same frame and settings give the same segments.
    """
    parts = [_of_sensor(frame, row, rig, settings=settings) for row in range(len(rig.sensors))]
    kept = [part for part in parts if part is not None]
    if not kept:
        return NO_SEGMENTS
    a, b, a_s, b_s, range_m = (np.concatenate(column) for column in zip(*kept, strict=True))
    return Segments(a, b, a_s, b_s, range_m)


def _of_sensor(
    frame: Multiframe, row: int, rig: Rig, *, settings: SegmentTuning = SEGMENTS
) -> tuple[Array, Array, Array, Array, Array] | None:
    sensor = rig.sensors[row]
    if not sensor.enabled:
        return None
    of, p = np.ascontiguousarray(frame.sensor), np.ascontiguousarray(frame.xyz)
    rings, t_ns = np.ascontiguousarray(frame.ring), np.ascontiguousarray(frame.dt_ns)
    xyz, ring, dt_ns = points_of_sensor(of, row, p, rings, t_ns)
    if len(xyz) < 2:
        return None
    band = _bands(xyz, ring, lidar_model(sensor.model), most=settings.most_bands)
    pairs = draw_pairs(
        xyz, band, int(band.max()) + 1, settings.azimuth_bins, settings.generated,
        settings.preserved, settings.max_length_per_range, _seed(settings.seed, frame, row),
    )  # fmt: skip
    ends, times_s = np.empty((2, len(pairs), 3), np.float32), np.empty((2, len(pairs)))
    range_m = np.empty(len(pairs))
    segment_ends(xyz, dt_ns, pairs, ends, times_s, range_m)
    a_body, b_body = (in_body(sensor, end) for end in ends)
    return a_body, b_body, times_s[0], times_s[1], range_m


def _bands(
    xyz: NDArray[np.float32], ring: NDArray[np.uint8], model: LidarFacts, *, most: int
) -> NDArray[np.uint8]:
    """Bands of elevation between which segments are drawn, (N,): the rings of the sensor.

    Neighboring rings of a sensor with more than ``most`` are one band, so that the number of
    segments does not grow with the beams. A pattern that does not repeat has no rings: its field
    of view is cut into ``most`` bands.
    """
    if model.has_rings:
        joined = -(-(int(ring.max()) + 1) // most)
        return np.ascontiguousarray(ring // np.uint8(joined))
    low, high = np.deg2rad(model.elevation_deg)
    elevation = np.arctan2(xyz[:, 2], np.hypot(xyz[:, 0], xyz[:, 1]))
    band = np.floor((elevation - low) * (most / (high - low)))
    return np.clip(band, 0, most - 1).astype(np.uint8)


def _seed(seed: int, frame: Multiframe, row: int) -> int:
    return (seed * 1_000_003 + frame.frame_id * 257 + row) & 0x7FFF_FFFF_FFFF_FFFF
