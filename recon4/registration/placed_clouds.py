"""Clouds that another program has put into the frame of a map, instead of those of a sensor.

Registered clouds of a SLAM program look like a recording, and odometry finds a sensor that never
moves. The view gives it away: it moves on, while everything that was seen stays where it is. A
LiDAR that stands and never scans twice alike has such a view, too; but seen from itself, surfaces
hide each other as much at all times. In placed clouds that changes with the path from the origin.
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
    if len(moved_m) < PLACED.least_pairs:
        return 0.0
    behind = [_hidden(frames, first) for first in np.unique(firsts).tolist()]
    return float(np.median(moved_m)) if np.ptp(behind) >= PLACED.least_change else 0.0


def _hidden(frames: Frames, first: int) -> float:
    """Fraction of directions in which surfaces of the next multiframes lie behind each other."""
    rows = range(first, first + PLACED.apart)
    p_body = np.concatenate([body_points(frames[k], frames.rig) for k in rows])
    range_m = np.linalg.norm(p_body, axis=1)
    away = range_m > PLACED.nearest_m
    p_body, range_m = p_body[away], range_m[away]
    azimuth = np.arctan2(p_body[:, 1], p_body[:, 0])
    angles = np.stack([azimuth, np.arcsin(p_body[:, 2] / range_m)], axis=1)
    cells, of = np.unique(
        np.floor(np.rad2deg(angles) / PLACED.cell_deg), axis=0, return_inverse=True
    )
    of = of.reshape(-1)
    nearest_m, farthest_m = np.full(len(cells), np.inf), np.zeros(len(cells))
    np.minimum.at(nearest_m, of, range_m)
    np.maximum.at(farthest_m, of, range_m)
    met = np.bincount(of, minlength=len(cells)) >= PLACED.least_met
    behind = farthest_m > nearest_m * PLACED.behind + PLACED.behind_m
    return float(behind[met].mean()) if met.any() else 0.0


def _is_still(T: SE3) -> bool:
    return bool(np.linalg.norm(T.t) < PLACED.still_m and T.angle() < PLACED.still_rad)


def placed_text(name: str, moves_m: float) -> str:
    """Why a recording of such clouds is refused, and what is expected."""
    return (
        f"{name}: its points are in the frame of a map already: the view moves on by "
        f"{moves_m:.1f} m in ten clouds, and all that was seen stays in place. Expected the points "
        "as the sensor measured them: topic or files before the odometry (as /points_raw), not "
        "registered ones (as /cloud_registered). If they are as measured: set as_measured of "
        "ingest (page: All settings; command: --set ingest.as_measured=true)"
    )
