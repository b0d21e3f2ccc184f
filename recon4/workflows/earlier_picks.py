"""Surveyed points that were picked in an earlier map of the walk: who saw them, for the new one."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np

from recon4.errors import Recon4Error
from recon4.georeference.control_sightings import PickedTarget, sightings
from recon4.locales.coded import text_of
from recon4.model.events import Warned
from recon4.pose_graph.files import load_graph
from recon4.progress import Progress
from recon4.slices.measured_points import orthonormal
from recon4.slices.site_control import seen_place
from recon4.slices.stored_picks import TRAJECTORY, StoredPicks, add_seen_picks, unseen_picks
from recon4.store.arrays import load_trajectory
from recon4.store.frames import FrameStore, open_frames
from recon4.store.input_contents import files_of
from recon4.store.project import read_stages
from recon4.store.stage import Artifact
from recon4.workflows.make_map import PLACE


def keep_earlier_picks(root: Path, made: Mapping[str, Path], progress: Progress) -> None:
    """Keep who saw the picks of earlier maps, before the new one is there.

    Those of maps that were removed from the disk stay as they are. What fails here is said, and
    the map is made all the same.

    Args:
        root: The project folder.
        made: Stage -> folder of its artifact in the run that ends.
        progress: Who watches.
    """
    try:
        if "level" in made and (picks := unseen_picks(root, made["map"].name)).picks:
            store = open_frames(made["frames"], made.get("calibration"), made["odometry"])
            for artifact, level in _earlier_maps(root, {*picks.found_in.values()}):
                _keep(root, picks.of_map(artifact.key), level, store=store)
    except Recon4Error as error:
        progress.event(Warned(text=text_of(error)))


def _earlier_maps(root: Path, keys: set[str]) -> Iterator[tuple[Artifact, Path]]:
    """The maps of these keys that are still on the disk, and where their trajectories are."""
    stages = [
        Artifact(one.stage, one.key, root / "artifacts" / one.key) for one in read_stages(root)
    ]
    there = [one for one in stages if one.folder.is_dir()]
    levels = {files_of(one, PLACE).key: one.folder for one in there if one.stage == "level"}
    for one in there:
        level = levels.get(one.manifest()["recipe"]["inputs"].get("level") or "")
        if one.stage == "map" and one.key in keys and level is not None:
            yield one, level


def _keep(root: Path, picks: StoredPicks, level: Path, *, store: FrameStore) -> None:
    radius_m = {point.id: point.radius_m for point in picks.points}
    targets = {
        name: PickedTarget(np.array(at), orthonormal(picks.along[name]), radius_m.get(name, 0.0))
        for name, at in picks.picks.items()
    }
    trajectory = load_trajectory(level / TRAJECTORY)
    found = sightings(targets, store, load_graph(level), trajectory=trajectory)
    seen = {name: seen_place(one) for name, one in found.items() if len(one.t_ns)}
    add_seen_picks(root, seen, picks.picks)
