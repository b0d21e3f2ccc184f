"""Clouds that another program has put into the frame of a map, instead of those of a sensor.

Registered clouds of a SLAM program look like a recording, and odometry finds a sensor that never
moves. The view gives it away: it moves on, while everything that was seen stays where it is.
"""

from __future__ import annotations

import numpy as np

from recon4.geometry.se3 import SE3
from recon4.model.frames import Frames
from recon4.registration.scan_chain import body_points
from recon4.registration.scan_registration import make_scan, register_scans
from recon4.registration.tuning_motion import PLACED


def view_moves_on(frames: Frames) -> float:
    """How far the view moves on between two multiframes that fit without a motion [m]; 0 = not so.

    Pairs of multiframes about a second apart are compared, from all of the walk. Where a sensor
    stands, its view stays, too; where it moves, the scans fit at another pose only.

    Args:
        frames: Multiframes of a walk in order of time.
    """
    if len(frames) <= PLACED.apart:
        return 0.0
    firsts = np.linspace(0, len(frames) - 1 - PLACED.apart, PLACED.pairs).astype(int)
    moved_m, others = [], 0
    for first in np.unique(firsts).tolist():
        views = [body_points(frames[k], frames.rig) for k in (first, first + PLACED.apart)]
        if not all(map(len, views)):
            continue
        # Not thinned: most points lie around the sensor, also in a room that is seen whole.
        step_m = float(np.linalg.norm(views[1].mean(axis=0) - views[0].mean(axis=0)))
        if step_m < PLACED.least_m:
            continue
        a, b = map(make_scan, views)
        found = register_scans(a, b, initial=SE3.identity())
        if found.match_ratio < PLACED.least_ratio:
            continue
        if not _is_still(found.T_target_source):
            others += 1
        elif found.degeneracy >= PLACED.least_degeneracy:
            moved_m.append(step_m)
        if others > PLACED.most_others:
            return 0.0
    return float(np.median(moved_m)) if len(moved_m) >= PLACED.least_pairs else 0.0


def _is_still(T: SE3) -> bool:
    return bool(np.linalg.norm(T.t) < PLACED.still_m and T.angle() < PLACED.still_rad)


def placed_text(name: str, moves_m: float) -> str:
    """Why a recording of such clouds is refused, and what is expected."""
    return (
        f"{name}: its points are in the frame of a map already: the view moves on by "
        f"{moves_m:.1f} m in ten clouds, and all that was seen stays in place. Expected the points "
        "as the sensor measured them: topic or files before the odometry (as /points_raw), not "
        "registered ones (as /cloud_registered)"
    )
