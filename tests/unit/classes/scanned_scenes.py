"""Tiny scenes made of boxes and upright cylinders, scanned by arithmetic from a straight walk."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from recon4.geometry.se3 import SE3
from recon4.model.multiframe import Multiframe
from recon4.model.trajectory import Trajectory
from tests.room_walks import T0_NS, Walk, rig_of

STEP_NS = 500_000_000
HEIGHT_M = 1.5
ROOM = ((-3.0, -3.0, 0.0), (9.0, 3.0, 3.0))


@dataclass(frozen=True)
class Thing:
    """Something that beams meet."""

    name: str
    reach: Callable
    """Ranges at which beams meet it, inf = never: (origins, directions, t_s) -> (N,)."""


def box(name, low, high):
    """A box, or a room if the sensor is in it."""

    def reach(p, d, _):
        with np.errstate(divide="ignore", invalid="ignore"):
            ends = np.stack([(np.array(low) - p) / d, (np.array(high) - p) / d])
        first, last = np.nanmin(ends, axis=0).max(axis=1), np.nanmax(ends, axis=0).min(axis=1)
        hit = np.where(first > 0.0, first, last)
        return np.where((first <= last) & (hit > 0.0), hit, np.inf)

    return Thing(name, reach)


def cylinder(name, place, radius_m, top_m=1.8, *, foot_m=0.0):
    """An upright cylinder; ``place(t_s)`` is its axis, (2,)."""

    def reach(p, d, t_s):
        to = np.asarray(place(t_s)) - p[:, :2]
        flat = np.hypot(d[:, 0], d[:, 1])
        along = (to * d[:, :2]).sum(axis=1) / flat
        miss2 = (to**2).sum(axis=1) - along**2
        near = (along - np.sqrt(np.maximum(radius_m**2 - miss2, 0.0))) / flat
        z = p[:, 2] + near * d[:, 2]
        met = (miss2 < radius_m**2) & (near > 0.0) & (z > foot_m) & (z < top_m)
        return np.where(met, near, np.inf)

    return Thing(name, reach)


def pane(x_m):
    """A pane of glass across the walk: beams return at nearly normal incidence only."""

    def reach(p, d, _):
        hit = (x_m - p[:, 0]) / d[:, 0]
        return np.where((hit > 0.0) & (d[:, 0] > 0.95), hit, np.inf)

    return Thing("pane", reach)


def scanned(*things, seconds=14.0, speed_m_s=0.4, azimuth_deg=(-60.0, 60.0), noise_m=0.01):
    """A walk along x, and the name of what each point is on, multiframe by multiframe."""
    rng = np.random.default_rng(3)
    azimuth = np.deg2rad(np.arange(*azimuth_deg, 0.5))
    elevation = np.deg2rad(np.arange(-31.0, 32.0, 2.0))
    a, e = (grid.ravel() for grid in np.meshgrid(azimuth, elevation, indexing="ij"))
    ring = np.tile(np.arange(len(elevation), dtype=np.uint8), len(azimuth))
    d = np.stack([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)], axis=1)
    frames, names = [], []
    rows = np.arange(-1, int(1e9 * seconds / STEP_NS) + 2)
    t_m = np.zeros((len(rows), 3))
    t_m[:, 0], t_m[:, 2] = speed_m_s * 1e-9 * STEP_NS * rows, HEIGHT_M
    for k in rows[1:-2]:
        p = np.tile(t_m[k + 1], (len(d), 1))
        ranges = np.stack([thing.reach(p, d, 1e-9 * STEP_NS * k) for thing in things])
        met, r = ranges.argmin(axis=0), ranges.min(axis=0)
        hit = np.isfinite(r)
        n = int(hit.sum())
        xyz = (r[hit] + rng.normal(0.0, noise_m, n))[:, None] * d[hit]
        small = (np.zeros(n, np.uint8) for _ in range(2))
        t_ns = T0_NS + int(k) * STEP_NS
        bright, dt_ns = np.full(n, 50, np.uint16), np.zeros(n, np.int32)
        points = (xyz.astype(np.float32), bright, ring[hit], *small, dt_ns)
        frames.append(Multiframe(int(k), t_ns, 2, *points))
        names.append(np.array([thing.name for thing in things])[met[hit]])
    R = np.broadcast_to(np.eye(3), (len(rows), 3, 3)).copy()
    trajectory = Trajectory(T0_NS + rows * STEP_NS, SE3(R, t_m))
    return Walk(frames, rig_of(SE3.identity()), trajectory), names
