"""Tuning of the search for places seen before."""

from __future__ import annotations

import numpy as np
from msgspec import Struct


class CandidateTuning(Struct, frozen=True, kw_only=True):
    """Candidate pairs for registration."""

    run_gap: int = 2
    """Nodes before and after a chosen one that are skipped, because they see the same."""


CANDIDATES = CandidateTuning()


class DensityTuning(Struct, frozen=True, kw_only=True):
    """Images of the walls around a place (docs/explanation/pose-graph.md)."""

    cell_m: float = 0.4
    """Edge of a cell [m]."""
    cells: int = 128
    """Cells along each side."""
    radius_m: float = 15.0
    """Radius of an image; with the largest shift nothing wraps around."""
    max_shift_m: float = 10.0
    """Largest shift between two images of one place [m]."""
    most: float = 4.0
    """Points in a cell beyond which it is full."""
    yaw_step_rad: float = np.deg2rad(5.0)
    """Step of the headings that are tried [rad]."""
    apart_m: float = 1.5
    apart_rad: float = 0.25
    """Maxima closer than this belong to one hypothesis."""
    radii: int = 12
    angles: int = 32
    """Circles and directions of a descriptor."""
    heights_m: tuple[float, float, float] = (-2.5, 5.0, 0.25)
    """Lowest and highest edge of the layers around the body, and their thickness."""


DENSITY = DensityTuning()


class FollowTuning(Struct, frozen=True, kw_only=True):
    """Recognized places are followed along the path."""

    nearest: int = 5
    """The best overlap with this many of the nearest nodes counts: on stairs a step changes
    much."""
    parted_m: float = 3.0
    """The two paths have parted where they are farther apart [m]."""
    max_stuck: int = 2
    """A correction is followed past this many nodes that contradict it, to count them."""
    step_m: float = 1.2
    max_steps: int = 12
    """Step along the path at which a correction is tested [m], shorter where the graph states more
    drift; and the largest number of steps."""
    change_m: float = 0.4
    change_rad: float = 0.07
    """Largest change of a correction over one step, beside the drift that the graph states."""


FOLLOW = FollowTuning()


class GroupTuning(Struct, frozen=True, kw_only=True):
    """Which corrections agree, compete and are plausible."""

    link_m: float = 15.0
    """Corrections with more path in between neither confirm nor exclude each other [m]."""
    max_height_slack_m: float = 1.0
    """Less than a storey, however long the walk [m]."""
    max_contradicted: float = 0.15
    """Largest part of the nodes whose views contradict a correction."""
    agree_m: float = 0.4
    agree_ratio: float = 0.05
    agree_rad: float = 0.09
    """Largest difference of the corrections of two places, beside the drift that the graph states:
    [m], ratio of the path in between, [rad]."""


GROUPS = GroupTuning()


class PlaceTuning(Struct, frozen=True, kw_only=True):
    """Places along a walk."""

    points: int = 1500
    """Points of a node that are drawn."""
    broken_sd_m: float = 1.0
    """Odometry edges that are less certain do not join the parts of a sub-map [m]."""
    redrawn_m: float = 0.05
    """A place is drawn again where its walls have moved farther relative to it [m]: an eighth of a
    cell."""
    below_m: float = 0.9
    above_m: float = 0.8
    """Points between these heights below and above the body count as walls [m]."""


PLACES = PlaceTuning()


class CandidatePlaceTuning(Struct, frozen=True, kw_only=True):
    """Which places are compared."""

    height_m: float = 1.0
    """Two visits of one place differ in height by less than this, beside the drift [m]."""
    yaw_rad: float = 0.26
    """Rotations that are always tried [rad]."""
    unlikely: float = 0.1
    """Score that a hypothesis loses if it moves a node by as much as is likely."""
    closed_nodes: int = 2
    """A place is known if an accepted loop closure ends this many nodes from it, or closer."""
    near_m: float = 1.5
    near_rad: float = 0.26
    """Hypotheses of one place that are closer than this are the same."""
    known_m: float = 0.5
    flight_m: float = 2.0
    """A height known to less than this [m] is kept, if it is less than a storey."""
    far: float = 1.2
    max_far: int = 1
    """Hypotheses of a place that are farther than likely; they can only be announced."""


RECOGNITION = CandidatePlaceTuning()


class BoundTuning(Struct, frozen=True, kw_only=True):
    """How far places may be off relative to each other."""

    anchors: int = 400
    """Places between which bounds are exact; of more places, some stand for their neighbors."""
    chunk: int = 64
    """Places whose paths are followed at a time."""


BOUNDS = BoundTuning()
