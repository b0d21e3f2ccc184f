"""Reads what a project has to show from its finished artifacts. Only reads."""

from __future__ import annotations

import logging
from pathlib import Path

from app.viewer.scene import Content, Tile
from app.viewer.tiles import read_tiles
from recon4.errors import Recon4Error
from recon4.model.pose_graph import PoseGraph
from recon4.model.rig import load_rig
from recon4.model.trajectory import Trajectory
from recon4.pose_graph.files import load_graph
from recon4.store.arrays import load_trajectory
from recon4.store.project import read_artifacts

log = logging.getLogger(__name__)

TRAJECTORY_STAGES = ("level", "refine", "carried")
GRAPH_STAGES = ("level", "verification", "graph")
"""Stages that leave them, the last one first."""


class ProjectSource:
    """The newest finished artifacts of a project."""

    def __init__(self, project: Path) -> None:
        self._project = project
        self._artifacts: dict[str, Path] = {}
        self._tiles: dict[int, tuple[tuple[Tile, ...], int]] = {}
        self._rest = Content()
        self.changed()

    def changed(self) -> bool:
        """Look again; whether a stage has finished since."""
        try:
            found = read_artifacts(self._project)
        except Recon4Error as error:
            log.warning("%s", error)
            return False
        if found == self._artifacts:
            return False
        self._artifacts, self._tiles = found, {}
        odometry = self._trajectory(("odometry",))
        self._rest = Content(
            trajectory=self._trajectory(TRAJECTORY_STAGES) or odometry,
            odometry=odometry,
            graph=self._graph(),
            sensors=self._sensors(),
        )
        return True

    def content(self, budget: int) -> Content:
        """What to show, with at most so many points (thinned evenly over the map)."""
        if budget not in self._tiles and "map" in self._artifacts:
            self._tiles[budget] = read_tiles(
                self._artifacts["map"], budget=budget, began_ns=self._began_ns()
            )
        tiles, points = self._tiles.get(budget, ((), 0))
        rest = self._rest
        return Content(
            tiles=tiles,
            points_in_map=points,
            trajectory=rest.trajectory,
            odometry=rest.odometry,
            graph=rest.graph,
            sensors=rest.sensors,
        )

    def _began_ns(self) -> int:
        line = self._rest.trajectory
        return int(line.t_ns[0]) if line is not None and len(line) else 0

    def _trajectory(self, stages: tuple[str, ...]) -> Trajectory | None:
        for stage in stages:
            path = self._artifacts.get(stage, Path()) / "trajectory.npz"
            if stage in self._artifacts and path.exists():
                return load_trajectory(path)
        return None

    def _graph(self) -> PoseGraph | None:
        for stage in GRAPH_STAGES:
            folder = self._artifacts.get(stage)
            if folder is not None and (folder / "graph.npz").exists():
                return load_graph(folder)
        return None

    def _sensors(self) -> tuple[str, ...]:
        frames = self._artifacts.get("frames")
        if frames is None or not (frames / "rig.toml").exists():
            return ()
        return tuple(sensor.name for sensor in load_rig(frames / "rig.toml").sensors)
