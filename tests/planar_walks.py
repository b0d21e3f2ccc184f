"""Walks of a 2-D laser through floor plans made of walls, with their truth."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from recon4.geometry.se2 import between, compose
from recon4.geometry.se3 import Array
from recon4.model.laser_scans import LaserScans, joined_scans
from tests.laser_rows import rows_of, with_rows

START_NS = 1_000_000_000_000
BEAMS, FIRST_RAD, STEP_RAD = 271, -np.deg2rad(135.0), np.deg2rad(1.0)
RANGE_MAX_M = 20.0


def rectangle(x0: float, y0: float, x1: float, y1: float) -> Array:
    """The four walls of a rectangle, (4, 4): x, y, x, y of each."""
    corners = np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]])
    return np.concatenate([corners, np.roll(corners, -1, axis=0)], axis=1)


def ring_corridor() -> Array:
    """A square corridor of 2 m around a block of 12 m, with pillars and niches along it."""
    walls = [rectangle(-2.0, -2.0, 14.0, 14.0), rectangle(0.0, 0.0, 12.0, 12.0)]
    rng = np.random.default_rng(5)
    for at in np.arange(0.5, 12.0, 1.7):
        size = rng.uniform(0.15, 0.4, 4)
        walls += [
            rectangle(at, -2.0, at + size[0], -2.0 + size[1]),
            rectangle(at, 14.0 - size[2], at + size[3], 14.0),
            rectangle(-2.0, at, -2.0 + size[1], at + size[2]),
            rectangle(14.0 - size[0], at, 14.0, at + size[1]),
        ]
    return np.concatenate(walls)


def furnished_room() -> Array:
    """A room of 8 x 6 m with a cupboard, a table and a pillar."""
    parts = [
        rectangle(-4.0, -3.0, 4.0, 3.0),
        rectangle(-4.0, 1.8, -2.2, 3.0),
        rectangle(1.5, -1.2, 2.7, -0.4),
        rectangle(-1.5, -2.4, -1.2, -2.1),
    ]
    return np.concatenate(parts)


def blank_corridor() -> Array:
    """Two parallel walls, far longer than the range of the laser."""
    return np.array([[-100.0, -1.0, 200.0, -1.0], [-100.0, 1.0, 200.0, 1.0]])


def along(
    corners: Array, *, speed_m_s: float = 0.8, rate_hz: float = 10.0, turn_s: float = 1.0
) -> Array:
    """Poses of a walk from corner to corner that looks ahead, with rounded turns, (N, 3)."""
    steps = np.linalg.norm(np.diff(corners, axis=0), axis=1)
    path = np.concatenate([[0.0], np.cumsum(steps)])
    at = np.arange(0.0, path[-1], speed_m_s / rate_hz)
    places = np.stack([np.interp(at, path, corners[:, k]) for k in range(2)], axis=1)
    window = int(rate_hz * turn_s) | 1
    padded = np.pad(places, ((window // 2, window // 2), (0, 0)), mode="edge")
    kernel = np.ones(window) / window
    smooth = np.stack([np.convolve(padded[:, k], kernel, "valid") for k in range(2)], axis=1)
    ahead = np.gradient(smooth, axis=0)
    yaw = np.unwrap(np.arctan2(ahead[:, 1], ahead[:, 0]))
    return np.concatenate([smooth, yaw[:, None]], axis=1)


def ring_walk(rounds: float = 1.2) -> Array:
    """Around the ring corridor; more than one round visits its beginning again."""
    corners = np.array([[-1.0, -1.0], [13.0, -1.0], [13.0, 13.0], [-1.0, 13.0]])
    count = int(np.ceil(4 * rounds)) + 1
    return along(corners[np.arange(count) % 4])


def cast(walls: Array, pose: Array, angles: Array, range_max_m: float) -> Array:
    """Range of each beam to the nearest wall [m], (M,); NaN = beyond the largest range."""
    direction = np.stack([np.cos(pose[2] + angles), np.sin(pose[2] + angles)], axis=1)
    start, edge = walls[:, :2], walls[:, 2:] - walls[:, :2]
    to_start = start - pose[:2]
    cross = direction[:, None, 0] * edge[None, :, 1] - direction[:, None, 1] * edge[None, :, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        along_beam = (to_start[:, 0] * edge[:, 1] - to_start[:, 1] * edge[:, 0]) / cross
        across = to_start[None, :, 0] * direction[:, None, 1]
        along_wall = (across - to_start[None, :, 1] * direction[:, None, 0]) / cross
        hit = (along_beam > 1e-6) & (along_wall >= 0.0) & (along_wall <= 1.0)
    nearest = np.where(hit, along_beam, np.inf).min(axis=1)
    return np.where(nearest <= range_max_m, nearest, np.nan)


@dataclass(frozen=True, slots=True, eq=False)
class PlanarWalk:
    """Scans with the true poses of the laser."""

    scans: LaserScans
    truth: Array
    """x [m], y [m], yaw [rad] of each scan, (N, 3)."""

    def errors(self, poses: Array) -> tuple[Array, Array]:
        """Distance [m] and rotation [rad] of poses from the truth, aligned at the first one."""
        moved = compose(self.truth[0], between(poses[0], poses))
        off = between(self.truth, moved)
        return np.hypot(off[:, 0], off[:, 1]), np.abs(off[:, 2])


def scanned(
    walls: Array, truth: Array, *, odometry: bool = True, noise_m: float = 0.01, rate_hz: float = 10
) -> PlanarWalk:
    """Measure a walk: ranges with noise, and odometry that drifts."""
    rng = np.random.default_rng(1)
    angles = FIRST_RAD + STEP_RAD * np.arange(BEAMS)
    ranges = np.stack([cast(walls, pose, angles, RANGE_MAX_M) for pose in truth])
    ranges += noise_m * rng.standard_normal(ranges.shape)
    scans = LaserScans.of_rows(
        START_NS + np.round(np.arange(len(truth)) * 1e9 / rate_hz).astype(np.int64),
        ranges.astype(np.float32),
        angles=(FIRST_RAD, STEP_RAD),
        range_max_m=RANGE_MAX_M,
    )
    return PlanarWalk(replace(scans, odometry=drifting(truth, rng) if odometry else None), truth)


Layout = tuple[float, float, int]
"""First angle and step [rad] and number of beams of a scan."""


def full_turns(count: int) -> list[Layout]:
    """Full turns of 260 to 266 beams, drawn at random, as of a cheap laser."""
    beams = np.random.default_rng(4).integers(260, 267, count).tolist()
    return [(-np.pi, 2.0 * np.pi / n, n) for n in beams]


def interlaced(count: int) -> list[Layout]:
    """Half turns of 1° whose first angles go through the quarters of a degree."""
    return [(np.deg2rad(-90.0 + 0.25 * (k % 4)), np.deg2rad(1.0), 180) for k in range(count)]


def clockwise_and_back(count: int) -> list[Layout]:
    """Turns of 270° from left to right and from right to left."""
    sides = [1.0 - 2.0 * (k % 2) for k in range(count)]
    return [(np.deg2rad(135.0) * side, -np.deg2rad(1.0) * side, 271) for side in sides]


def scanned_in(walls: Array, truth: Array, layouts: list[Layout]) -> PlanarWalk:
    """Measure a walk with the angles of each scan; there is no odometry."""
    rng = np.random.default_rng(1)
    parts = [
        LaserScans.of_rows(
            START_NS + np.array([k * 100_000_000], np.int64),
            (
                cast(walls, truth[k], first + step * np.arange(beams), RANGE_MAX_M)
                + 0.01 * rng.standard_normal(beams)
            )[None].astype(np.float32),
            angles=(first, step),
            range_max_m=RANGE_MAX_M,
        )
        for k, (first, step, beams) in enumerate(layouts)
    ]
    return PlanarWalk(joined_scans(parts), truth)


def drifting(truth: Array, rng: np.random.Generator) -> Array:
    """Odometry with 3 % too long steps, slip and a heading that drifts."""
    motion = between(truth[:-1], truth[1:])
    motion[:, :2] *= 1.03
    motion[:, 2] += 0.002 * rng.standard_normal(len(motion)) + 0.0005
    poses = [np.zeros(3)]
    for step in motion:
        poses.append(compose(poses[-1], step))
    return np.array(poses)


def without(scans: LaserScans, first_s: float, last_s: float) -> LaserScans:
    """The scans without those of a time since the start."""
    t_s = (scans.t_ns - scans.t_ns[0]) / 1e9
    return scans[(t_s < first_s) | (t_s > last_s)]


def mirrored(scans: LaserScans) -> LaserScans:
    """The scans with their beams in the opposite order."""
    return with_rows(scans, rows_of(scans)[:, ::-1])


def write_carmen(path: Path, scans: LaserScans) -> None:
    """Write a log of ``ROBOTLASER1`` messages; no return becomes the largest range."""
    path.write_text("".join(f"{line}\n" for line in carmen_lines(scans)), "ascii")


def carmen_lines(scans: LaserScans) -> list[str]:
    """The scans as ``ROBOTLASER1`` messages."""
    odometry = np.zeros((len(scans), 3)) if scans.odometry is None else scans.odometry
    lines = ["# a log of a simulated walk", "PARAM robot_frontlaser_offset 0.0 nohost 0"]
    for k, (t_ns, pose) in enumerate(zip(scans.t_ns.tolist(), odometry, strict=True)):
        first, step, ranges = scans.angle_min_rad[k], scans.angle_step_rad[k], scans.ranges(k)
        head = f"0 {first:.9f} {step * (len(ranges) - 1):.9f} {step:.9f}"
        head += f" {scans.range_max_m} 0.01 0 {len(ranges)}"
        filled = np.where(np.isfinite(ranges), ranges, scans.range_max_m)
        values = " ".join(f"{value:.3f}" for value in filled)
        place = " ".join(f"{value:.6f}" for value in pose)
        time = f"{t_ns // 10**9}.{t_ns % 10**9:09d}"
        lines.append(f"ROBOTLASER1 {head} {values} 0 {place} {place} 0 0 0 0 0 {time} robot {time}")
    return lines
