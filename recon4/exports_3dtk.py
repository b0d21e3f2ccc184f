"""The scans and poses of a finished run for 3DTK."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from recon4.errors import ConfigError
from recon4.export.names import check_name
from recon4.export.scans import ScanRows, export_scans
from recon4.pose_graph.files import load_graph
from recon4.profiler.turns import find_turns
from recon4.progress import Progress
from recon4.results import final_trajectory
from recon4.store.atomic import atomic_folder
from recon4.store.frames import open_frames
from recon4.store.line_store import load_lines
from recon4.store.project import read_artifacts


def export_3dtk(project: Path, folder: Path, *, progress: Progress) -> int:
    """Write one scan with its pose for each node of the pose graph, as 3DTK reads them.

    A node is a multiframe or, of a rig with a profiler, a turn of its head. The format has no place
    for an approval.

    Args:
        project: The project folder.
        folder: Folder to make, ``.3dtk``; it must not exist.
        progress: Counts scans.

    Returns:
        How many points were written.

    Raises:
        Altered: If the trajectory was approved and is not what was approved; nothing is written.
        ConfigError: If the ending is another, or the folder exists.
        StoreError: If there is no finished trajectory yet or the folder cannot be written.
    """
    check_name(folder, ".3dtk")
    if folder.exists():
        raise ConfigError(f"{folder} exists already: name a new folder")
    artifacts = read_artifacts(project)
    dense = final_trajectory(project, artifacts)
    store = open_frames(artifacts["frames"], artifacts.get("calibration"))
    graph = load_graph(artifacts["verification"])
    if store.rig.row_of("profiler") is None:
        rows = np.searchsorted(store.index["frame_id"], graph.frame_ids)
        scans = [
            ScanRows(int(t_ns), range(int(row), int(row) + 1))
            for t_ns, row in zip(graph.t_ns, rows, strict=True)
        ]
    else:
        turns = find_turns(store, load_lines(store.folder))
        scans = [ScanRows(int(t), turns.multiframes(store, k)) for k, t in enumerate(turns.t_ns)]
    with atomic_folder(folder) as temporary:
        return export_scans(store, dense, scans, folder=temporary, progress=progress)
