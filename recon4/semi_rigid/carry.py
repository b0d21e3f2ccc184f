"""Decisions that hardly move the graph carry the refined trajectory along, without another round.

The refinement works out what is between the nodes: how multiframes fit those of other visits. Where
decisions move no node by more than the step at which it stops, it is near its end already: each
pose follows its nodes, and that is all. What is compared with is always the refinement without
decisions, so that small moves do not add up, and the result follows from the inputs alone.
"""

from __future__ import annotations

import numpy as np

from recon4.model.corrections import apply_corrections
from recon4.model.figures import CarriedFigures, RefineFigures
from recon4.model.trajectory import Trajectory
from recon4.semi_rigid.graph_nodes import GraphNodes
from recon4.semi_rigid.refine import Refinement
from recon4.semi_rigid.tuning import RefineTuning
from recon4.settings.reads import RefineReads
from recon4.settings.tuning import tuned
from recon4.store.arrays import load_trajectory
from recon4.store.stage import read_figures


def carry(given: GraphNodes, *, settings: RefineReads) -> Refinement | None:
    """Carry the refinement without decisions along with the nodes that decisions moved.

    Args:
        given: The nodes with the decisions.
        settings: Uses refine.

    Returns:
        None if there are no decisions, if they move a node farther than the limits of
        `RefineTuning`, or if the refinement without them did not converge.

    Raises:
        StoreError: If its artifact is damaged.
    """
    before, tuning = given.undecided, tuned(RefineTuning, settings.refine)
    if before is None or not np.array_equal(before.nodes.t_ns, given.nodes.t_ns):
        return None
    rounds = read_figures(before.refined, RefineFigures).rounds
    if not rounds or rounds[-1].largest_step_m >= tuning.converged_step_m:
        return None
    moved = _moved(before.nodes, given.nodes)
    if moved.moved_m > tuning.converged_step_m or moved.turned_rad > tuning.carried_turn_rad:
        return None
    trajectory = apply_corrections(
        load_trajectory(before.refined / "trajectory.npz"),
        given.nodes.t_ns,
        T_before=before.nodes.T_a_b,
        T_after=given.nodes.T_a_b,
    )
    return Refinement(trajectory, (), carried=moved)


def _moved(before: Trajectory, after: Trajectory) -> CarriedFigures:
    moved_m = np.linalg.norm(after.T_a_b.t - before.T_a_b.t, axis=1)
    turned_rad = (before.T_a_b.inverse() @ after.T_a_b).angle()
    return CarriedFigures(moved_m=float(moved_m.max()), turned_rad=float(turned_rad.max()))
