"""Which LiDARs have beams that can be calibrated, and how many."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from recon4.calibration.tuning_joint import BEAMS
from recon4.geometry.distinct import distinct
from recon4.model.beams import BEAMS_OF_MODEL
from recon4.model.frames import RecordedFrames


def beam_counts(frames: RecordedFrames, rows: tuple[int, ...]) -> dict[int, int]:
    """Number of beams of each LiDAR that has rings of single beams, by its row.

    Bands of elevation in place of rings, and clouds in another frame, are left out.

    Args:
        frames: The multiframes.
        rows: LiDARs that are looked at.
    """
    sampled = np.unique(np.linspace(0, len(frames) - 1, BEAMS.sampled).astype(int)).tolist()
    found = {}
    for row in rows:
        parts = [(frames[k].xyz, frames[k].ring, frames[k].sensor == row) for k in sampled]
        xyz = np.concatenate([p[mine] for p, _, mine in parts])
        ring = np.concatenate([of_point[mine] for _, of_point, mine in parts])
        if not len(ring):
            continue
        count = BEAMS_OF_MODEL.get(frames.rig.sensors[row].model, int(ring.max()) + 1)
        if count <= BEAMS.most and ring.max() < count and _are_cones(xyz, ring):
            found[row] = count
    return found


def _are_cones(xyz: NDArray[np.float32], ring: NDArray[np.uint8]) -> bool:
    elevation = np.arctan2(xyz[:, 2], np.hypot(xyz[:, 0], xyz[:, 1]))
    parts = (elevation[ring == one] for one in distinct(ring))
    spread = [np.median(np.abs(part - np.median(part))) for part in parts]
    return bool(np.median(spread) < BEAMS.max_spread_rad)
