"""From the solved graph to the pose of every scan."""

from __future__ import annotations

import numpy as np

from recon4.geometry.se2 import between, compose, wrap
from recon4.geometry.se3 import Array
from recon4.slam2d.keyframes import Keyframes


def corrected_poses(pose: Array, keyframes: Keyframes, T_map_key: Array) -> Array:
    """Poses of all scans in the map: the motions between keyframes bend to fit the solved ones.

    Each scan is placed from the keyframe before and from the one after it; in between the two
    results are blended by row.

    Args:
        pose: Poses of all scans by odometry, (N, 3).
        keyframes: Nodes of the graph.
        T_map_key: Their solved poses, (K, 3).
    """
    rows = np.arange(len(pose))
    before = np.clip(np.searchsorted(keyframes.rows, rows, side="right") - 1, 0, None)
    after = np.minimum(before + 1, len(keyframes) - 1)
    first = compose(T_map_key[before], between(keyframes.pose[before], pose))
    second = compose(T_map_key[after], between(keyframes.pose[after], pose))
    span = keyframes.rows[after] - keyframes.rows[before]
    fraction = np.clip((rows - keyframes.rows[before]) / np.maximum(span, 1), 0.0, 1.0)[:, None]
    turned = wrap(second[:, 2] - first[:, 2])
    blended = first + fraction * (second - first)
    blended[:, 2] = wrap(first[:, 2] + fraction[:, 0] * turned)
    return blended
