"""The stages of 2-D mapping: each reads the artifacts of those before and writes its own."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
from msgspec import to_builtins

from recon4.errors import EmptyRecording
from recon4.geometry.se2 import to_se3, transform, wrap
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.model.events import Remarked
from recon4.model.figures import GraphFigures, Map2dFigures, Odometry2dFigures, Scan2dFigures
from recon4.model.laser_scans import LaserScans
from recon4.model.laser_upright import turned_round
from recon4.model.rig import Sensor
from recon4.model.trajectory import Trajectory
from recon4.pose_graph.files import load_graph, save_graph
from recon4.progress import Progress
from recon4.recording.lasers.laser2d import read_laser_recording
from recon4.recording.lasers.mount import mount_of_rig, mounted_scans
from recon4.recording.report import ImportReport
from recon4.settings import IngestSettings
from recon4.settings.reads import Graph2dReads, Map2dReads, Odometry2dReads
from recon4.settings.tuning import tuned
from recon4.slam2d.grid_files import read_overview, write_map
from recon4.slam2d.keyframes import Keyframes, make_keyframes
from recon4.slam2d.loops import close_loops
from recon4.slam2d.occupancy import OccupancyGrid, crossing_ratio
from recon4.slam2d.odometry import Odometry2d
from recon4.slam2d.scan_points import scan_points
from recon4.slam2d.slam import make_grid, map_poses, run_steps, scan_covariances
from recon4.slam2d.steps import Steps2d
from recon4.slam2d.tuning import Grid2dTuning, Loop2dTuning, Slam2dTuning
from recon4.slam2d.tuning_graph import BEAM_ORDER, SCAN_GAPS
from recon4.store.arrays import load_arrays, load_record, save_record, save_trajectory
from recon4.store.atomic import write_json
from recon4.store.line_store import LineStoreWriter, load_laser_scans


def import_scans(
    recordings: Sequence[Path],
    out: Path,
    *,
    settings: IngestSettings,
    laser: Sensor | None = None,
    progress: Progress,
) -> Scan2dFigures:
    """Read a recording of a 2-D laser into a folder; the scans as seen from above.

    Args:
        recordings: A CARMEN log, or bags.
        out: Receives the scans and ``report.json``.
        settings: Name the topics of a bag.
        laser: The laser of a rig file, with its mount and topic; None = as the recording states.
        progress: Receives the warnings.

    Raises:
        RecordingError: If it cannot be read or has no scan.
    """
    report = ImportReport()
    progress.start("Reading", len(recordings), "files")
    by_rig = mount_of_rig(laser.T_body_sensor) if laser is not None else None
    topic = laser.topic if laser is not None else ""
    recording = read_laser_recording(recordings, report, settings=settings, topic=topic)
    mounted = mounted_scans(recording, by_rig, report=report)
    scans, mirrored = with_true_order(mounted.scans)
    report.count("scans_mirrored", len(scans) if mirrored else 0)
    report.count("gaps", int((np.diff(scans.t_ns) > round(1e9 * SCAN_GAPS.gap_s)).sum()))
    report.warn_of_losses()
    progress.advance(len(recordings))
    writer = LineStoreWriter(out)
    writer.append_scans(scans)
    writer.close()
    for finding in report.findings:
        progress.event(Remarked(finding=finding))
    _write_report(out / "report.json", recordings, report)
    return Scan2dFigures(
        scans=len(scans),
        beams=int(np.median(scans.beams)),
        odometry=scans.odometry is not None,
        outcome=report.outcome,
        tilt_deg=round(mounted.tilt_deg, 2),
        mirrored=mirrored,
        stated=dict(mounted.mount.doubted) if mounted.mount is not None else {},
    )


def _write_report(path: Path, recordings: Sequence[Path], report: ImportReport) -> None:
    write_json(
        path,
        {
            "recordings": [recording.name for recording in recordings],
            "outcome": report.outcome,
            "counts": dict(sorted(report.counts.items())),
            "derived": to_builtins(report.derived),
            "findings": to_builtins(report.findings),
        },
    )


def read_scans(folder: Path) -> LaserScans:
    """The scans that `import_scans` wrote.

    Raises:
        StoreError: If they are damaged.
        EmptyRecording: If there are none.
    """
    scans = load_laser_scans(folder)
    if scans is None:
        raise EmptyRecording(CodedText("laser-no-scans", folder=folder.name))
    return scans


def run_odometry(
    scans: Path, out: Path, *, settings: Odometry2dReads, progress: Progress
) -> Odometry2dFigures:
    """Register all scans; writes ``steps.npz`` and ``trajectory.npz``."""
    found = read_scans(scans)
    steps = run_steps(found, attitude=None, settings=settings, progress=progress)
    save_record(out / "steps.npz", steps)
    save_trajectory(out / "trajectory.npz", Trajectory(steps.t_ns, to_se3(steps.pose)))
    return Odometry2dFigures(
        scans=len(found),
        lost=int(steps.lost.sum()),
        keyframes=int(steps.keyframe.sum()),
        searched=int(steps.searched.sum()),
        resets=int(steps.resets.sum()),
    )


def read_keyframes(scans: Path, odometry: Path, *, settings: Slam2dTuning) -> Keyframes:
    """The keyframes of a finished odometry, with their returns.

    Args:
        scans: Folder of `import_scans`.
        odometry: Folder of `run_odometry`.
        settings: Those of the odometry.
    """
    steps = load_record(odometry / "steps.npz", Steps2d)
    return make_keyframes(read_scans(scans), steps, attitude=None, settings=settings)


def build_graph(
    scans: Path, odometry: Path, out: Path, *, settings: Graph2dReads, progress: Progress
) -> GraphFigures:
    """Close loops; writes the pose graph.

    Raises:
        EmptyRecording: If no scan had enough returns.
        GraphError: If the graph cannot be solved.
    """
    found = read_scans(scans)
    steps = load_record(odometry / "steps.npz", Steps2d)
    if not steps.keyframe.any():
        raise EmptyRecording(
            CodedText(
                "laser-few-returns",
                count=len(found),
                min_range_m=settings.slam2d.min_range_m,
                max_range_m=settings.slam2d.max_range_m,
            )
        )
    keyframes = make_keyframes(
        found, steps, attitude=None, settings=tuned(Slam2dTuning, settings.slam2d)
    )
    graph = close_loops(
        keyframes,
        settings=tuned(Slam2dTuning, settings.slam2d),
        loops=tuned(Loop2dTuning, settings.loops2d),
        progress=progress,
    )
    save_graph(out, graph)
    accepted = sum(edge.in_graph for edge in graph.edges)
    return GraphFigures(nodes=len(graph), edges=len(graph.edges), accepted=accepted)


def build_map(
    artifacts: dict[str, Path], out: Path, *, settings: Map2dReads, progress: Progress
) -> Map2dFigures:
    """Place all scans by the verified graph; writes trajectory, covariances and the grid.

    Args:
        artifacts: ``scans``, ``odometry`` and ``graph``.
        out: Receives the files.
        settings: Groups ``slam2d`` and ``grid2d``.
        progress: Counts scans.
    """
    scans = read_scans(artifacts["scans"])
    steps = load_record(artifacts["odometry"] / "steps.npz", Steps2d)
    graph = load_graph(artifacts["graph"])
    keyframes = make_keyframes(
        scans, steps, attitude=None, settings=tuned(Slam2dTuning, settings.slam2d)
    )
    poses = map_poses(steps, keyframes, graph)
    covariance = scan_covariances(keyframes, graph, len(scans))
    grid = make_grid(scans, poses, attitude=None, settings=settings, progress=progress)
    save_trajectory(out / "trajectory.npz", Trajectory(scans.t_ns, to_se3(poses)))
    np.savez(out / "poses.npz", t_ns=scans.t_ns, pose=poses, covariance=covariance)
    written = write_map(out, grid, tuned(Grid2dTuning, settings.grid2d))
    free = int(np.count_nonzero(written.free))
    return Map2dFigures(
        cell_m=grid.cell_m,
        enlarged=round(grid.cell_m / settings.grid2d.cell_m),
        overview_cell_m=read_overview(out).cell_m,
        size=(grid.log_odds.shape[0], grid.log_odds.shape[1]),
        free_m2=round(free * grid.cell_m**2, 2),
        crossing_ratio=round(_crossing(grid, scans, poses, settings=settings), 4),
        largest_sd_m=round(float(np.sqrt(np.linalg.eigvalsh(covariance[:, 1:, 1:]).max())), 4),
    )


def read_covariance(folder: Path) -> Array:
    """Covariances of the poses of all scans: yaw, x, y in the axes of the laser, (N, 3, 3).

    Raises:
        StoreError: If the artifact of `build_map` is damaged.
    """
    return np.asarray(load_arrays(folder / "poses.npz", ["covariance"])["covariance"])


def _crossing(
    grid: OccupancyGrid, scans: LaserScans, poses: Array, *, settings: Map2dReads
) -> float:
    def placed() -> Iterator[tuple[Array, Array]]:
        for k in range(0, len(scans), max(1, len(scans) // SCAN_GAPS.checked_scans)):
            points = scan_points(scans, k, settings=tuned(Slam2dTuning, settings.slam2d)).points
            yield transform(poses[k], points), poses[k, :2]

    return crossing_ratio(grid, placed())


def with_true_order(scans: LaserScans) -> tuple[LaserScans, bool]:
    """The scans, mirrored if they turn against the odometry of the recording.

    Returns:
        The scans, and whether they were. Without odometry, or without a turn, it cannot be known.
    """
    votes = [_vote(scans[rows]) for rows in _turns(scans)]
    if not votes or sum(votes) >= 0:
        return scans, False
    return turned_round(scans), True


def _turns(scans: LaserScans) -> list[slice]:
    """Stretches in which the odometry turns."""
    if scans.odometry is None:
        return []
    found: list[slice] = []
    steps = np.abs(wrap(np.diff(scans.odometry[:, 2])))
    first = 0
    while first + 2 < len(scans) and len(found) < BEAM_ORDER.stretches:
        turned = np.cumsum(steps[first : first + BEAM_ORDER.scans])
        enough = int(np.searchsorted(turned, BEAM_ORDER.turn_rad))
        if enough < len(turned):
            found.append(slice(first, first + enough + 2))
        first += BEAM_ORDER.scans
    return found


def _vote(scans: LaserScans) -> int:
    """1 = the scans turn as the odometry does, -1 = against it, 0 = neither."""
    assert scans.odometry is not None
    odometry = Odometry2d(scans, settings=Slam2dTuning(use_odometry=False))
    for k in range(len(scans)):
        odometry.push(k)
    by_scans = wrap(np.diff(odometry.steps.pose[:, 2]))
    by_robot = wrap(np.diff(scans.odometry[:, 2]))
    agreement = float(by_scans @ by_robot) / max(float(by_robot @ by_robot), 1e-12)
    return int(agreement > BEAM_ORDER.clear) - int(agreement < -BEAM_ORDER.clear)
