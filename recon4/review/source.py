"""What a project has to be reviewed: its latest verified graph and how that was made."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from functools import cached_property
from pathlib import Path
from typing import Any

from recon4.errors import StoreError
from recon4.model.pose_graph import PoseGraph
from recon4.model.trajectory import Trajectory
from recon4.pose_graph.files import load_graph
from recon4.settings import Settings
from recon4.store.arrays import load_trajectory
from recon4.store.frames import FrameStore
from recon4.store.project import read_artifacts
from recon4.store.stage import read_manifest


@dataclass(frozen=True)
class Source:
    """The artifacts of a project's latest run; each is read when it is asked for."""

    artifacts: dict[str, Path]

    @staticmethod
    def of(root: Path) -> Source:
        """The latest run.

        Raises:
            StoreError: If there is no verified graph yet.
        """
        artifacts = read_artifacts(root)
        if "verification" not in artifacts:
            raise StoreError(f"{root.name} has no verified graph yet: there is nothing to review")
        return Source(artifacts)

    @property
    def key(self) -> str:
        """Key of the verified graph."""
        return self.artifacts["verification"].name

    @cached_property
    def verified(self) -> PoseGraph:
        """The graph before any decision."""
        return load_graph(self.artifacts["verification"])

    @cached_property
    def settings(self) -> Settings:
        """Those the graph was searched and verified with; others are the defaults."""
        told: dict[str, dict[str, Any]] = {}
        for stage in ("graph", "verification"):
            if stage in self.artifacts:
                told |= read_manifest(self.artifacts[stage])["recipe"]["settings"]
        return _settings(told)

    @cached_property
    def odometry(self) -> Trajectory:
        """``T_odom_body``, dense."""
        return load_trajectory(self._folder("odometry") / "trajectory.npz")

    @cached_property
    def frames(self) -> FrameStore:
        """The multiframes."""
        return FrameStore.open(self._folder("frames"))

    def _folder(self, stage: str) -> Path:
        if stage not in self.artifacts:
            raise StoreError(f"this project has no artifact of the stage {stage}")
        return self.artifacts[stage]


def _settings(told: dict[str, dict[str, Any]]) -> Settings:
    """From the recipe of an artifact; names that an older or newer recon4 wrote are left out."""
    settings = Settings()
    groups = {}
    for name, values in told.items():
        group = getattr(settings, name)
        known = {f.name for f in fields(group)}
        groups[name] = replace(group, **{n: v for n, v in values.items() if n in known})
    return replace(settings, **groups)
