"""Whether the profiler is mounted as the rig file says.

With the right mount the points of all turns of the head lie on the fewest places. The trajectory is
that of IMU and 2-D laser: a refined one would have bent to fit the wrong mount.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from recon4.geometry.cubes import count_cubes
from recon4.geometry.se3 import Array, so3_exp
from recon4.model.trajectory import Trajectory
from recon4.profiler.samples import TimedPoints
from recon4.profiler.tuning_audits import MOUNT_AUDIT

_UNIT = np.repeat([MOUNT_AUDIT.step_rad, MOUNT_AUDIT.step_m], [3, 2])
"""Step of the search: rotation about x, y, z of the body, shift along x and y."""
_SKEW = so3_exp(np.array([0.4, 0.7, 0.3]))
"""Turns the cubes: a tilt would bring a floor along their faces into one layer of them."""


@dataclass(frozen=True, slots=True, eq=False)
class MountChange:
    """How the profiler is mounted against the rig file."""

    turn_rad: Array
    """Rotation vector about its origin, in axes of the body, (3,)."""
    shift_m: Array
    """Along x and y of the body, (2,)."""

    @property
    def is_wrong(self) -> bool:
        """Whether a person should look at the mount."""
        return bool(
            np.linalg.norm(self.turn_rad) > MOUNT_AUDIT.said_rad
            or np.linalg.norm(self.shift_m) > MOUNT_AUDIT.said_m
        )

    def describe(self) -> str:
        """The change in words."""
        turn = ", ".join(
            f"{np.rad2deg(value):+z.1f}° about {axis}"
            for axis, value in zip("xyz", self.turn_rad, strict=True)
        )
        x_cm, y_cm = 100.0 * self.shift_m
        return f"{turn}, {x_cm:+z.0f} cm in x, {y_cm:+z.0f} cm in y"


def mount_change(
    points: TimedPoints, origin_m: Array, trajectory: Trajectory
) -> MountChange | None:
    """Find the mount of the profiler with which its points lie on the fewest places.

    Args:
        points: Some of all line scans, in the body as the rig file says.
        origin_m: Position of the profiler in the body, (3,).
        trajectory: ``T_map_body`` by IMU and 2-D laser.

    Returns:
        None if no other mount is clearly better. The height is not sought: on a level floor it
        cannot be seen.
    """
    inside = points.between(int(trajectory.t_ns[0]), int(trajectory.t_ns[-1]))
    if not len(inside):
        return None

    def places(change: Array, count: int, cube_m: float) -> int:
        every = max(1, len(inside) // count)
        moved = (inside.p_body[::every] - origin_m) @ so3_exp(change[:3]).T + origin_m
        moved[:, :2] += change[3:]
        at = TimedPoints(inside.t_ns[::every], np.ascontiguousarray(moved)).placed(trajectory)
        return count_cubes(at @ _SKEW, cube_m)

    found = _lowest(
        np.zeros(5),
        np.array(MOUNT_AUDIT.coarse),
        lambda x: places(x, MOUNT_AUDIT.coarse_points, MOUNT_AUDIT.coarse_m),
    )

    def fine(change: Array) -> int:
        return places(change, MOUNT_AUDIT.fine_points, MOUNT_AUDIT.fine_m)

    found = _simplest(_lowest(found, np.array(MOUNT_AUDIT.fine), fine), fine)
    before, after = fine(np.zeros(5)), fine(found)
    return MountChange(found[:3], found[3:]) if after <= MOUNT_AUDIT.clear_ratio * before else None


def _lowest(start: Array, steps: Array, cost: Callable[[Array], int]) -> Array:
    """The lowest cost along each coordinate in turn, again while one changes."""
    best, value = start, cost(start)
    for _ in range(MOUNT_AUDIT.cycles):
        before = best
        for axis in range(len(best)):
            tried = [best + step * _UNIT * (np.arange(len(best)) == axis) for step in steps if step]
            costs = [cost(change) for change in tried]
            if min(costs) < value:
                best, value = tried[int(np.argmin(costs))], min(costs)
        if np.array_equal(before, best):
            break
    return best


def _simplest(best: Array, cost: Callable[[Array], int]) -> Array:
    """The change of the fewest coordinates that is as good as the best, within noise of counts.

    A turn and a shift that hardly differ in the points would both be there otherwise, against each
    other.
    """
    limit = cost(best) + np.sqrt(cost(best))
    used = np.flatnonzero(best)
    for count in range(len(used)):
        kept = [np.isin(np.arange(len(best)), some) for some in combinations(used, count)]
        tried = [np.where(keep, best, 0.0) for keep in kept]
        costs = [cost(change) for change in tried]
        if min(costs) <= limit:
            return tried[int(np.argmin(costs))]
    return best
