"""Detects scans whose beams are stored in the wrong order: the map would be mirrored."""

from __future__ import annotations

import numpy as np

from recon4.geometry.se2 import wrap
from recon4.model.laser_scans import LaserScans
from recon4.model.laser_upright import turned_round
from recon4.slam2d.odometry import Odometry2d
from recon4.slam2d.tuning import Slam2dTuning
from recon4.slam2d.tuning_graph import BEAM_ORDER


def with_true_order(scans: LaserScans) -> tuple[LaserScans, bool]:
    """The scans, mirrored if they turn against the odometry of the recording.

    Returns:
        The scans, and whether they were. Without odometry, or without a turn, it cannot be known.
    """
    votes = [_vote(scans[rows]) for rows in _turns(scans)]
    if not votes or sum(votes) >= 0:
        return scans, False
    return turned_round(scans), True


def _turns(scans: LaserScans) -> list[slice]:
    """Stretches in which the odometry turns."""
    if scans.odometry is None:
        return []
    found: list[slice] = []
    steps = np.abs(wrap(np.diff(scans.odometry[:, 2])))
    first = 0
    while first + 2 < len(scans) and len(found) < BEAM_ORDER.stretches:
        turned = np.cumsum(steps[first : first + BEAM_ORDER.scans])
        enough = int(np.searchsorted(turned, BEAM_ORDER.turn_rad))
        if enough < len(turned):
            found.append(slice(first, first + enough + 2))
        first += BEAM_ORDER.scans
    return found


def _vote(scans: LaserScans) -> int:
    """1 = the scans turn as the odometry does, -1 = against it, 0 = neither."""
    assert scans.odometry is not None
    odometry = Odometry2d(scans, settings=Slam2dTuning(use_odometry=False))
    for k in range(len(scans)):
        odometry.push(k)
    by_scans = wrap(np.diff(odometry.steps.pose[:, 2]))
    by_robot = wrap(np.diff(scans.odometry[:, 2]))
    agreement = float(by_scans @ by_robot) / max(float(by_robot @ by_robot), 1e-12)
    return int(agreement > BEAM_ORDER.clear) - int(agreement < -BEAM_ORDER.clear)
