"""Across a gap: where a scan lies on the last ones, however far the body moved unseen.

Consecutive scans of a walk overlap so far that the scan before decides. After a gap, or a step of
meters between two scans, much of what is seen is new, and the ratio of matches says little. So the
last few scans are joined, the new one is laid onto them from many initial poses, and it counts only
if nothing speaks against it: no other pose fits nearly as well (repeated doors, columns, rooms),
no view sees through what the other one shows, and every direction is observed.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from recon4.geometry.se3 import SE3, Array
from recon4.registration.overlap import RangeImage, make_range_image, seen_through
from recon4.registration.result import Registration
from recon4.registration.scan_registration import Scan, lay_onto, make_scan
from recon4.registration.tuning import SCANS, ScanTuning
from recon4.registration.tuning_motion import BRIDGE


def bridge_cov() -> Array:
    """Covariance that a bridge adds to the motion of its multiframe, (6, 6)."""
    return np.diag(np.repeat([BRIDGE.sd_rad, BRIDGE.sd_m], 3) ** 2)


@dataclass(frozen=True, slots=True, eq=False)
class SeenScan:
    """A scan with all of its points, thinned and not, in the body."""

    scan: Scan
    points: Array
    """[m], (N, 3)."""


class RecentScans:
    """The last scans of a walk, some steps apart: together they have fewer holes than one."""

    def __init__(self, settings: ScanTuning = SCANS) -> None:
        self._settings = settings
        self._kept: deque[tuple[int, SE3, Scan]] = deque(maxlen=BRIDGE.scans)

    def keep(self, scan: Scan, T_odom_body: SE3, t_ns: int) -> None:
        """Add a scan and its time [ns], unless the last one was taken at nearly the same pose."""
        if self._kept:
            step = self._kept[-1][1].inverse() @ T_odom_body
            if np.linalg.norm(step.t) < BRIDGE.apart_m and step.angle() < BRIDGE.apart_rad:
                return
        self._kept.append((t_ns, T_odom_body, scan))

    def joined(self, last: Scan, T_odom_body: SE3, *, since_ns: int) -> Scan:
        """The last scan and those since a time, in the body at this pose.

        Who steps out of an elevator sees again what he saw before the ride: older scans would say
        that he is still there.
        """
        T_body_odom = T_odom_body.inverse()
        placed = [T_body_odom @ T @ scan.points for t_ns, T, scan in self._kept if t_ns >= since_ns]
        return make_scan(np.concatenate([*placed, last.points]), self._settings)


def sure_pose(
    target: Scan,
    source: SeenScan,
    last: SeenScan,
    *,
    initial: Sequence[SE3],
    settings: ScanTuning = SCANS,
) -> SE3 | None:
    """``T_target_source`` if only one pose fits, else None.

    Args:
        target: The last scans together, in the body of the last one.
        source: The new scan.
        last: The last scan.
        initial: Poses to try beside the overlays of the ground plans.
        settings: Of the registration of two scans.
    """
    views = [make_range_image(one.points) for one in (last, source)]
    found = [
        one
        for one in lay_onto(target, source.scan, initial=initial, settings=settings)
        if one.match_ratio and _passed(views, one) <= BRIDGE.most_seen_through
    ]
    if not found:
        return None
    best = found[0]
    if best.match_ratio < BRIDGE.least_ratio or best.degeneracy < BRIDGE.least_degeneracy:
        return None
    return None if any(_is_rival(one, best) for one in found) else best.T_target_source


def _passed(views: Sequence[RangeImage], one: Registration) -> float:
    """Ratio of the points of one view in the free space of the other, 0..1."""
    before, now = views
    return seen_through(
        before,
        now,
        one.T_target_source,
    )


def _is_rival(one: Registration, best: Registration) -> bool:
    apart = best.T_target_source.inverse() @ one.T_target_source
    elsewhere = np.linalg.norm(apart.t) > BRIDGE.rival_m or apart.angle() > BRIDGE.rival_rad
    return bool(elsewhere) and one.match_ratio >= BRIDGE.rival_ratio * best.match_ratio
