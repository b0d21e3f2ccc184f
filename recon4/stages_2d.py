"""The stages of 2-D maps as the pipeline runs them, with the version of their code."""

from __future__ import annotations

from pathlib import Path

from recon4.model.figures import GraphFigures, Map2dFigures, Odometry2dFigures, Scan2dFigures
from recon4.progress import Progress
from recon4.settings import Settings
from recon4.store.stage import Stage


def _scans(
    *, out: Path, settings: Settings, progress: Progress, recordings: tuple[Path, ...]
) -> Scan2dFigures:
    from recon4.slam2d.stage import import_scans

    return import_scans(recordings, out, progress=progress)


def _odometry(
    *, out: Path, settings: Settings, progress: Progress, scans: Path
) -> Odometry2dFigures:
    from recon4.slam2d.stage import run_odometry

    return run_odometry(scans, out, settings=settings, progress=progress)


def _graph(
    *, out: Path, settings: Settings, progress: Progress, scans: Path, odometry: Path
) -> GraphFigures:
    from recon4.slam2d.stage import build_graph

    return build_graph(scans, odometry, out, settings=settings, progress=progress)


def _map(
    *,
    out: Path,
    settings: Settings,
    progress: Progress,
    scans: Path,
    odometry: Path,
    graph: Path,
) -> Map2dFigures:
    from recon4.slam2d.stage import build_map

    artifacts = {"scans": scans, "odometry": odometry, "graph": graph}
    return build_map(artifacts, out, settings=settings, progress=progress)


SCANS_2D = Stage("scans_2d", 1, (), _scans, Scan2dFigures)
ODOMETRY_2D = Stage("odometry_2d", 1, ("slam2d", "hector"), _odometry, Odometry2dFigures)
GRAPH_2D = Stage("graph_2d", 1, ("slam2d", "loops2d"), _graph, GraphFigures)
MAP_2D = Stage("map_2d", 1, ("slam2d", "grid2d"), _map, Map2dFigures)
