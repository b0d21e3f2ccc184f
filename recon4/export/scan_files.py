"""The scans and poses of a finished run for 3DTK."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np

from recon4.errors import ConfigError
from recon4.export.map_files import final_trajectory
from recon4.export.names import check_name
from recon4.export.scans import ScanRows, export_scans
from recon4.locales.coded import CodedText
from recon4.model.pose_graph import PoseGraph
from recon4.pose_graph.files import load_graph
from recon4.profiler.sweeps import find_sweeps
from recon4.progress import Progress
from recon4.store.atomic import atomic_folder
from recon4.store.frames import FrameStore, open_frames
from recon4.store.line_store import load_lines
from recon4.store.project import read_artifacts

_ALWAYS = (0, 2**63 - 1)


def export_3dtk(project: Path, folder: Path, *, progress: Progress, draft: bool = False) -> int:
    """Write one scan with its pose for each node of the pose graph, as 3DTK reads them.

    A node is a multiframe or, of a rig with a profiler, a sweep of its head. The format has no
    place for an approval.

    Args:
        project: The project folder.
        folder: Folder to make, ``.3dtk``; it must not exist.
        progress: Counts scans.
        draft: Whatever the approval is.

    Returns:
        How many points were written.

    Raises:
        Altered: If the trajectory was approved and is not what was approved; nothing is written.
        ConfigError: If the ending is another, or the folder exists.
        StoreError: If there is no finished trajectory yet or the folder cannot be written.
    """
    check_name(folder, ".3dtk")
    if folder.exists():
        raise ConfigError(CodedText("folder-exists", folder=str(folder)))
    artifacts = read_artifacts(project)
    dense = final_trajectory(project, artifacts, draft=draft)
    store = open_frames(artifacts["frames"], artifacts.get("calibration"))
    graph = load_graph(artifacts["verification"])
    scans = _multiframes if store.rig.row_of("profiler") is None else _sweeps
    with atomic_folder(folder) as temporary:
        return export_scans(store, dense, scans(store, graph), folder=temporary, progress=progress)


def _multiframes(store: FrameStore, graph: PoseGraph) -> list[ScanRows]:
    rows = np.searchsorted(store.index["frame_id"], graph.frame_ids).tolist()
    return [
        ScanRows(t_ns, range(row, row + 1), _ALWAYS)
        for t_ns, row in zip(graph.t_ns.tolist(), rows, strict=True)
    ]


def _sweeps(store: FrameStore, _: PoseGraph) -> list[ScanRows]:
    sweeps = find_sweeps(store, load_lines(store.folder))
    spans = pairwise(sweeps.start_ns.tolist())
    return [
        ScanRows(t_ns, sweeps.multiframes(store, k), span_ns)
        for k, (t_ns, span_ns) in enumerate(zip(sweeps.t_ns.tolist(), spans, strict=True))
    ]
