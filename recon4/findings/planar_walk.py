"""What the witnesses of a 2-D map read of a run."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from recon4.findings.walk_record import path_length_m
from recon4.findings.witnesses.planar import PlanarRecord
from recon4.model.figures import Map2dFigures, Odometry2dFigures, Scan2dFigures
from recon4.model.import_notes import import_notes
from recon4.pose_graph.files import load_graph
from recon4.slam2d.steps import Steps2d
from recon4.store.arrays import load_record, load_trajectory
from recon4.store.json_files import read_object
from recon4.store.stage import read_figures
from recon4.untrusted.limits import LIMITS


def read_planar(artifacts: Mapping[str, Path]) -> PlanarRecord:
    """Read the artifacts of a 2-D map.

    Args:
        artifacts: Stage -> folder.

    Raises:
        StoreError: If one is missing or damaged.
    """
    trajectory = load_trajectory(artifacts["map_2d"] / "trajectory.npz")
    scans = read_figures(artifacts["scans_2d"], Scan2dFigures)
    return PlanarRecord(
        scans=scans,
        imported=import_notes(import_report(artifacts), mount_doubts=scans.doubts),
        odometry=read_figures(artifacts["odometry_2d"], Odometry2dFigures),
        map=read_figures(artifacts["map_2d"], Map2dFigures),
        steps=load_record(artifacts["odometry_2d"] / "steps.npz", Steps2d),
        trajectory=trajectory,
        graph=load_graph(final_graph(artifacts)),
        path_length_m=float(path_length_m(trajectory)[-1]) if len(trajectory) > 1 else 0.0,
    )


def import_report(artifacts: Mapping[str, Path]) -> Mapping[str, object]:
    """The parsed ``report.json`` of the import."""
    path = artifacts["scans_2d"] / "report.json"
    return read_object(path, max_bytes=LIMITS.findings_bytes)


def final_graph(artifacts: Mapping[str, Path]) -> Path:
    """The graph with the decisions of people, if there are any."""
    return artifacts.get("review") or artifacts["verification"]
