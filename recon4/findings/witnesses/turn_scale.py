"""Turns of the odometry against those of registered pairs: the scale of the gyroscope.

The filter follows the gyroscope, because scans that are undistorted by wrong turn rates fit the map
they were added to. Pairs of sub-maps some seconds apart are registered by their points alone; with
an IMU in order both agree to 0.05 % of the turn, with a scale 3 % off they differ by 1 to 2 %.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from recon4.findings.walk_record import WalkRecord
from recon4.findings.witnesses.base import Witness, finding
from recon4.findings.witnesses.tuning import TURN_SCALE
from recon4.geometry.se3 import Array, so3_log
from recon4.model.finding import Finding, Level, Value
from recon4.model.finding_kinds import FindingKind
from recon4.model.pose_graph import PoseGraph
from recon4.model.trajectory import Trajectory


@dataclass(frozen=True, slots=True)
class TurnScale:
    """How much farther the odometry turns than registered pairs, as a ratio of the turn."""

    ratio: float
    sd: float

    @property
    def is_off(self) -> bool:
        """Whether odometry and pairs contradict each other."""
        return abs(self.ratio) > max(TURN_SCALE.most, TURN_SCALE.sigmas * self.sd)


def turn_scale(graph: PoseGraph, odometry: Trajectory) -> TurnScale | None:
    """Compare the turns of pairs that are in the graph; None = too few turn.

    Args:
        graph: With its edges as they were registered.
        odometry: ``T_odom_body``.
    """
    of, apart = graph.relations, graph.relations.j - graph.relations.i
    rows = np.flatnonzero(
        of.in_graph & (apart >= TURN_SCALE.fewest) & (apart <= TURN_SCALE.farthest)
    )
    if not len(rows) or not len(odometry):
        return None
    t_ns = np.clip(graph.t_ns, odometry.t_ns[0], odometry.t_ns[-1])
    R = odometry.at(t_ns).R
    turned: Array = so3_log(np.swapaxes(R[of.i[rows]], 1, 2) @ R[of.j[rows]])
    registered: Array = so3_log(of.T_i_j.R[rows])
    squared = np.einsum("na,na->n", registered, registered)
    used = (squared > TURN_SCALE.least_rad**2) & (squared < TURN_SCALE.most_rad**2)
    if used.sum() < TURN_SCALE.min_pairs:
        return None
    ratio = np.einsum("na,na->n", turned, registered)[used] / squared[used] - 1.0
    middle = float(np.median(ratio))
    spread = 1.4826 * float(np.median(np.abs(ratio - middle)))
    return TurnScale(middle, spread / float(np.sqrt(len(ratio))))


class TurnScales(Witness):
    """Turns of the odometry against those of registered pairs."""

    def check(self, walk: WalkRecord) -> Iterator[Finding]:
        """Whether they contradict each other."""
        if walk.graph is None or walk.odometry is None:
            return
        found = turn_scale(walk.graph, walk.odometry)
        if found is not None and found.is_off:
            way = "farther" if found.ratio > 0.0 else "less"
            values: dict[str, Value] = {"size": abs(found.ratio), "sd": found.sd, "way": way}
            yield finding(FindingKind.TURN_SCALE, Level.CHECK, values)
