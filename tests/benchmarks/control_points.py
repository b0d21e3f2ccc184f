"""Accuracy of a map on control points, at check points (docs/studies/control-points.md).

    python -m tests.benchmarks.control_points PROJECT RECORDING [CONTROL] [CHECK] [EPSG]

PROJECT is what ``recon4 process`` made of the simulated RECORDING. Targets are places that a scan
hit, spread over the walk. The survey has an error of 2 mm a coordinate. A pick is where the map
shows the target (the mean over the scans that saw it) with an error of 3 mm a coordinate. With EPSG
the survey is in that system, else in a grid of the site that is turned and shifted.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

import numpy as np

from recon4.evaluation.site_control import control_in, outcome_text
from recon4.geometry.se3 import SE3, Array
from recon4.georeference.control_sightings import PickedTarget, sightings
from recon4.georeference.crs import CrsTransform, GeodeticOrigin
from recon4.georeference.stage import LeveledMap, RefinedWalk, level_and_georeference
from recon4.mapping.undistort import place
from recon4.model.plain import to_plain
from recon4.model.site_control import SiteControl
from recon4.model.trajectory import Trajectory
from recon4.pose_graph.files import load_graph
from recon4.pose_graph.known_errors import load_known_errors
from recon4.progress import Silent
from recon4.recording.formats.poses import read_tum
from recon4.settings.reads import LevelReads, part_of
from recon4.slices.control_points import ControlPoint
from recon4.slices.measured_points import MeasuredPosition
from recon4.slices.site_control import ControlAccuracy, site_control
from recon4.store.arrays import load_trajectory
from recon4.store.frames import open_frames
from recon4.store.project import read_artifacts
from recon4.store.stage_settings import settings_to_repeat
from recon4.workflows.stages import LEVEL

SURVEY_SD_M, PICK_SD_M = 0.002, 0.003
NEAR_M = 8.0
SITE = SE3.from_rpy(0.0, 0.0, 0.7, t=[51_230.0, 108_470.0, 203.0])


def main(project: Path, recording: Path, control: int, check: int, crs: str) -> None:
    rng = np.random.default_rng(11)
    artifacts = read_artifacts(project)
    store = open_frames(artifacts["frames"], artifacts.get("calibration"), artifacts["odometry"])
    truth = read_tum(recording / "truth.tum")
    graph, own = (
        load_graph(artifacts["level"]),
        load_trajectory(artifacts["level"] / "trajectory.npz"),
    )
    true = _true_targets(store, truth, graph.t_ns, count=control + check, rng=rng)
    roles = np.full(len(true), "check", dtype=object)
    roles[np.linspace(0, len(true) - 1, control).round().astype(int)] = "control"
    seen = sightings(
        {name: PickedTarget(p, np.eye(3)) for name, p in true.items()},
        store,
        graph,
        trajectory=truth,
    )
    picks = {
        name: MeasuredPosition.full(
            (own.at(one.t_ns) @ one.p_body).mean(axis=0) + PICK_SD_M * rng.normal(size=3)
        )
        for name, one in seen.items()
    }
    to_site = _survey_system(recording, crs)
    points = [
        ControlPoint(
            name, tuple((to_site(p[None])[0] + SURVEY_SD_M * rng.normal(size=3)).tolist()), role
        )
        for (name, p), role in zip(true.items(), roles, strict=True)
    ]
    given = site_control(
        points,
        picks,
        artifacts,
        crs=crs,
        accuracy=ControlAccuracy(horizontal_m=0.004, height_m=0.004),
    )
    leveled = _leveled(artifacts, given)
    print(outcome_text(control_in({"control": to_plain(leveled.control)})))
    print(_by_truth(leveled, true, seen, to_site))


def _true_targets(store, truth, t_ns, *, count, rng) -> dict[str, Array]:
    rows = np.linspace(5, len(store) - 6, count).astype(int)
    out = {}
    for k, row in enumerate(rows.tolist()):
        frame = store[row]
        xyz = place(frame, truth, store.rig)
        off = np.linalg.norm(xyz - truth.at(np.array([frame.t_mid_ns])).t[0], axis=1)
        near = np.flatnonzero((off > 2.0) & (off < NEAR_M))
        out[f"T{k + 1}"] = xyz[rng.choice(near)]
    return out


def _survey_system(recording: Path, crs: str):
    if not crs:
        return lambda p: SITE @ p
    o = json.loads((recording / "world.json").read_text())["origin"]
    origin = GeodeticOrigin(np.deg2rad(o["lat_deg"]), np.deg2rad(o["lon_deg"]), o["height_m"])
    return CrsTransform(origin, crs).to_crs


def _leveled(artifacts: dict[str, Path], control: SiteControl) -> LeveledMap:
    graph = artifacts["review" if "review" in artifacts else "verification"]
    settings = part_of(settings_to_repeat(artifacts, [LEVEL]), LevelReads)
    store = open_frames(artifacts["frames"], artifacts.get("calibration"))
    walk = RefinedWalk(
        trajectory=load_trajectory(artifacts["refine"] / "trajectory.npz"),
        graph=load_graph(graph),
        known=load_known_errors(odometry=artifacts["odometry"]),
        control=control,
    )
    return level_and_georeference(store, walk, settings=settings, progress=Silent())


def _by_truth(leveled: LeveledMap, true, seen, to_site) -> str:
    """The same without survey and picks: where the trajectory is, against the truth."""
    facts = leveled.crs
    from recon4.georeference.crs import CrsTransform as Transform
    from recon4.georeference.site_grid import SiteGrid

    origin = leveled.georeference.origin
    system = (
        SiteGrid(tuple(facts.origin_m))
        if facts.name == "site grid"
        else Transform(origin, facts.name)
    )
    trajectory: Trajectory = leveled.trajectory
    off = np.array(
        [
            (system.to_crs(trajectory.at(one.t_ns) @ one.p_body) - to_site(true[name][None])).mean(
                0
            )
            for name, one in seen.items()
        ]
    )
    h, v = np.hypot(off[:, 0], off[:, 1]), np.abs(off[:, 2])
    return (
        f"all {len(off)} targets against the truth, without errors of survey and pick: "
        f"RMSE H {100 * np.sqrt((h**2).mean()):.2f} cm (max {100 * h.max():.2f}), "
        f"V {100 * np.sqrt((v**2).mean()):.2f} cm (max {100 * v.max():.2f})"
    )


if __name__ == "__main__":
    words = sys.argv[3:]
    numbers = [int(word) for word in words[:2]]
    main(
        Path(sys.argv[1]),
        Path(sys.argv[2]),
        numbers[0] if numbers else 5,
        numbers[1] if len(numbers) > 1 else 10,
        words[2] if len(words) > 2 else "",
    )
