"""Decisions that move a map by less than anybody sees leave it where it was, bit for bit.

A decision about one loop of hundreds moves every pose a little. The refinement does not follow
steps of this size either: it stops when no multiframe moves farther. Below the limits of `HOLD` the
map so keeps the poses of the map without decisions, and nothing that is made of them is made again.
That map is always the one compared with, so that small moves do not add up, and the result follows
from the inputs alone: it does not matter which maps were made before.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import msgspec
import numpy as np

from recon4.errors import StoreError
from recon4.georeference.stage import LeveledMap
from recon4.georeference.tuning import HOLD
from recon4.locales.coded import at
from recon4.model.figures import LevelFigures, MirrorFigures, MovedFigures
from recon4.model.plain import to_plain
from recon4.model.trajectory import Trajectory
from recon4.pose_graph.files import save_graph
from recon4.pose_graph.relations import with_residuals
from recon4.pose_graph.uncertainty import PoseUncertainty
from recon4.pose_graph.uncertainty_files import load_uncertainty
from recon4.store.arrays import load_trajectory
from recon4.store.atomic import copy_file
from recon4.store.json_files import read_object
from recon4.store.stage import read_figures
from recon4.untrusted.limits import LIMITS
from recon4.untrusted.typed import as_type

KEPT = ("trajectory.npz", "georeference.json", "mirrors.npz", "uncertainty.npz")
"""Files of the map without decisions that a held one has, too."""


def hold(
    leveled: LeveledMap, undecided: Path, out: Path, *, moved: MovedFigures | None
) -> LevelFigures | None:
    """Write a map at its place without decisions, if they move it by less than the limits.

    The graph is the decided one, with its residuals at these poses.

    Args:
        leveled: The map with the decisions.
        undecided: Artifact of the stage ``level`` without decisions.
        out: Receives the files of `LeveledMap.save`.
        moved: As `moved_by_decisions` found it.

    Returns:
        None if they move it: nothing was written.

    Raises:
        StoreError: If the artifact is damaged.
    """
    if moved is None or not _within(moved):
        return None
    if not _is_known_as_well(leveled.uncertainty, load_uncertainty(undecided)):
        return None
    figures = read_figures(undecided, LevelFigures)
    for name in KEPT:
        if (undecided / name).is_file():
            copy_file(undecided / name, out / name)
    graph, before = leveled.graph, load_trajectory(undecided / "trajectory.npz")
    save_graph(out, with_residuals(graph.with_poses(before.at(graph.t_ns))))
    return msgspec.structs.replace(figures, held=moved)


def moved_by_decisions(leveled: LeveledMap, undecided: Path) -> MovedFigures | None:
    """How far decisions move a map that is at the same place on the earth, with the same mirrors.

    Args:
        leveled: The map with the decisions.
        undecided: Artifact of the stage ``level`` without decisions.

    Returns:
        None if it is another place, other mirrors or another walk.

    Raises:
        StoreError: If the artifact is damaged.
    """
    moved = _moved(load_trajectory(undecided / "trajectory.npz"), leveled.trajectory)
    if moved is None or not _has_same_place(leveled, undecided):
        return None
    mirrors = read_figures(undecided, LevelFigures).mirrors
    now = tuple(mirror.figures for mirror in leveled.mirrors)
    return moved if _are_same(mirrors, now) else None


def _moved(before: Trajectory, after: Trajectory) -> MovedFigures | None:
    """How far poses move at most; None = they are not of the same times."""
    if not np.array_equal(before.t_ns, after.t_ns):
        return None
    moved_m = np.linalg.norm(after.T_a_b.t - before.T_a_b.t, axis=1)
    turned_rad = (before.T_a_b.inverse() @ after.T_a_b).angle()
    return MovedFigures(moved_m=float(moved_m.max()), turned_rad=float(turned_rad.max()))


def _within(moved: MovedFigures) -> bool:
    return moved.moved_m <= HOLD.moved_m and moved.turned_rad <= HOLD.turned_rad


@dataclass(frozen=True, slots=True)
class _Georeference:
    """What of ``georeference.json`` says where the map is on the earth."""

    crs: dict[str, object]
    georeference: dict[str, object]

    @property
    def place(self) -> list[object]:
        """CRS and origin, and which edges the positions reject."""
        of = self.georeference
        return [self.crs, of.get("origin"), of.get("edges_rejected", [])]


def _has_same_place(leveled: LeveledMap, undecided: Path) -> bool:
    """Whether both are in the same CRS with the same origin, or both local."""
    record = read_object(undecided / "georeference.json", max_bytes=LIMITS.findings_bytes)
    own = to_plain({"crs": leveled.crs or {}, "georeference": leveled.georeference.record()})
    try:
        before, after = (as_type(one, _Georeference) for one in (record, own))
    except msgspec.ValidationError as error:
        raise StoreError(at("georeference.json", str(error))) from error
    return before.place == after.place


def _is_known_as_well(after: PoseUncertainty | None, before: PoseUncertainty | None) -> bool:
    """Whether the standard deviations are the same, as far as such figures can be known."""
    if after is None or before is None:
        return after is before
    if after.on_earth != before.on_earth or not np.array_equal(after.t_ns, before.t_ns):
        return False
    least = np.repeat([HOLD.least_sd_rad, HOLD.least_sd_m], 3)
    was, now = (np.sqrt(np.diagonal(one.cov, axis1=1, axis2=2)) for one in (before, after))
    return bool((np.abs(now - was) <= HOLD.sd_ratio * was + least).all())


def _are_same(before: Sequence[MirrorFigures], after: Sequence[MirrorFigures]) -> bool:
    """Whether mirrors are on the same walls."""
    middles = [
        np.array([one.middle_m for one in found]).reshape(-1, 2) for found in (before, after)
    ]
    if len(middles[0]) != len(middles[1]):
        return False
    return bool((np.abs(middles[0] - middles[1]) <= HOLD.mirror_m).all())
