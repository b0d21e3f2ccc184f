"""Reads the content of a project: its finished artifacts, and the events of its running job."""

from __future__ import annotations

import logging
import threading
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from recon4.errors import Recon4Error
from recon4.geometry.se3 import Array
from recon4.model.rig import load_rig
from recon4.model.trajectory import Trajectory
from recon4.pose_graph.files import load_graph
from recon4.slam2d.grid_files import read_overview
from recon4.store.arrays import load_trajectory
from recon4.store.frames import open_frames
from recon4.store.project import read_artifacts
from recon4.untrusted.typed import decoded
from recon4_app.viewer.cloud.multiframes import Multiframes
from recon4_app.viewer.cloud.parts import Cloud
from recon4_app.viewer.cloud.preview import JobPreview
from recon4_app.viewer.scene.build import Content, GnssMarks
from recon4_app.viewer.scene.layers import EdgeTable
from recon4_app.viewer.scene.live import JobWatch

log = logging.getLogger(__name__)

TRAJECTORY_STAGES = ("level", "refine", "map_2d")
ODOMETRY_STAGES = ("odometry", "odometry_2d")
GRAPH_STAGES = ("level", "review", "verification", "graph", "graph_2d")
"""Stages with these artifacts, the last one first."""
SHOWN_WHILE_RUNNING = {"frames": (), "odometry": ("frames",), "graph": ("frames", "odometry")}
"""Running stage -> stages that are shown; the other artifacts are of an earlier run."""


@dataclass(frozen=True, slots=True, kw_only=True)
class GnssResiduals:
    """The fixes in ``georeference.json``, with their residuals to the trajectory."""

    georeferenced: bool = False
    t_ns: tuple[int, ...] = ()
    residual_enu_m: tuple[tuple[float, float, float], ...] = ()
    """East, north, up [m]."""
    used: tuple[bool, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Crs:
    """The CRS in ``georeference.json``."""

    name: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Georeference:
    """The fields of ``georeference.json`` that the viewer shows."""

    georeference: GnssResiduals | None = None
    crs: Crs | None = None


class ProjectSource:
    """The newest content of a project; one thread checks for changes, many read it."""

    def __init__(self, project: Path, jobs: Path) -> None:
        self._project = project
        self._watch = JobWatch(project, jobs)
        self._artifacts: dict[str, Path] = {}
        self._made: dict[tuple[str, Path], Any] = {}
        self._lock = threading.Lock()
        self.content = Content()
        self.changed()

    def changed(self) -> bool:
        """Check for changes; whether there are any."""
        news = self._watch.changed()
        try:
            found = read_artifacts(self._project)
        except Recon4Error as error:
            log.warning("%s", error)
            found = self._artifacts
        shown = SHOWN_WHILE_RUNNING.get(self._watch.live.stage)
        if shown is not None:
            found = {stage: path for stage, path in found.items() if stage in shown}
        if found == self._artifacts and not news:
            return False
        self._artifacts = found
        self.content = self._compose()
        return True

    def crs_coordinates(self, p_map: Array) -> tuple[str, Array] | None:
        """Name of the CRS and coordinates of points (N, 3) in it; None = not georeferenced."""
        if not self.content.crs:
            return None
        from recon4.georeference.crs_file import read_crs  # brings pyproj and much of scipy

        transform = self._of_stage("level", lambda path: read_crs(path), name="crs")
        return None if transform is None else (transform.crs, transform.to_crs(p_map))

    def _compose(self) -> Content:
        live = self._watch.live
        odometry = self._trajectory(ODOMETRY_STAGES)
        if live.stage == "odometry":
            odometry = live.trajectory
        trajectory = self._trajectory(TRAJECTORY_STAGES) or odometry
        georeference = self._georeference()
        cloud = self._cloud(trajectory)
        calibration = self._artifacts.get("calibration")
        frames = self._of_stage(
            "frames",
            lambda path: Multiframes(open_frames(path, calibration)),
            name=f"frames {calibration}",
        )
        return Content(
            cloud=cloud,
            trajectory=trajectory,
            odometry=odometry,
            edges=self._edges(),
            multiframes=frames,
            preview=self._preview(frames) if cloud is None else None,
            sensors=self._sensors(),
            plan=self._of_stage("map_2d", read_overview),
            gnss=self._gnss(georeference.georeference, trajectory),
            crs=georeference.crs.name if georeference.crs else "",
        )

    def _once(self, name: str, folder: Path, make: Any) -> Any:
        """The object made from an artifact, cached; artifacts never change."""
        key = (name, folder)
        with self._lock:
            if key not in self._made:
                used = set(self._artifacts.values())
                self._made = {k: made for k, made in self._made.items() if k[1] in used}
                try:
                    self._made[key] = make(folder)
                except Recon4Error as error:
                    log.warning("%s of %s: %s", name, folder.name, error)
                    self._made[key] = None
            return self._made[key]

    def _of_stage(self, stage: str, make: Any, *, name: str = "") -> Any:
        folder = self._artifacts.get(stage)
        return None if folder is None else self._once(name or stage, folder, make)

    def _cloud(self, line: Trajectory | None) -> Cloud | None:
        began_ns = int(line.t_ns[0]) if line is not None and len(line) else 0
        cloud: Cloud | None = self._of_stage("map", lambda path: Cloud(path, began_ns=began_ns))
        return cloud

    def _preview(self, frames: Multiframes | None) -> JobPreview | None:
        if frames is None:
            return None
        made: JobPreview | None = self._of_stage(
            "frames", lambda _: JobPreview(frames), name="preview"
        )
        return made

    def _trajectory(self, stages: tuple[str, ...]) -> Trajectory | None:
        for stage in stages:
            folder = self._artifacts.get(stage)
            if folder is not None and (folder / "trajectory.npz").exists():
                made: Trajectory | None = self._once(
                    "trajectory", folder, lambda path: load_trajectory(path / "trajectory.npz")
                )
                return made
        return None

    def _edges(self) -> EdgeTable | None:
        live = self._watch.live
        if live.stage in {"graph", "verification"} and live.graph is not None:
            return EdgeTable.of(live.graph)
        for stage in GRAPH_STAGES:
            folder = self._artifacts.get(stage)
            if folder is not None and (folder / "graph.npz").exists():
                table: EdgeTable | None = self._once(
                    "edges", folder, lambda path: EdgeTable.of(load_graph(path))
                )
                return table
        return None

    def _sensors(self) -> tuple[str, ...]:
        frames = self._artifacts.get("frames")
        if frames is None or not (frames / "rig.toml").exists():
            return ()
        return tuple(sensor.name for sensor in load_rig(frames / "rig.toml").sensors)

    def _georeference(self) -> Georeference:
        return self._of_stage("level", _read_georeference) or Georeference()

    def _gnss(self, fixes: GnssResiduals | None, line: Trajectory | None) -> GnssMarks | None:
        """GNSS fixes: antenna positions of the trajectory plus the residuals."""
        frames = self._artifacts.get("frames")
        if line is None or frames is None or fixes is None or not fixes.georeferenced:
            return None
        t_ns = np.array(fixes.t_ns, dtype=np.int64)
        inside = (t_ns >= line.t_ns[0]) & (t_ns <= line.t_ns[-1])
        T = line.at(t_ns[inside])
        p_antenna = (T.R @ load_rig(frames / "rig.toml").p_body_antenna) + T.t
        return GnssMarks(
            t_ns=t_ns[inside],
            p_map=p_antenna + np.array(fixes.residual_enu_m).reshape(-1, 3)[inside],
            p_antenna=p_antenna,
            used=np.array(fixes.used, dtype=np.bool_)[inside],
        )


def _read_georeference(folder: Path) -> Georeference | None:
    try:
        data = (folder / "georeference.json").read_bytes()
        return decoded(data, Georeference)
    except (OSError, msgspec.MsgspecError, RecursionError):
        return None
