"""Input of a review: the latest verified graph of a project and its settings."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from recon4.errors import StoreError
from recon4.locales.coded import CodedText
from recon4.model.pose_graph import Judgment, PoseGraph
from recon4.model.trajectory import Trajectory
from recon4.pose_graph.files import load_graph, load_history
from recon4.settings import Settings
from recon4.settings.tuning import tuned
from recon4.slam2d.tuning import Slam2dTuning
from recon4.store.arrays import load_trajectory
from recon4.store.frames import FrameStore, open_frames
from recon4.store.project import read_artifacts
from recon4.store.stage_settings import check_recipes, settings_in

if TYPE_CHECKING:  # other kinds of recordings; each is imported where it is read
    from recon4.profiler.sweeps import SweepNodes
    from recon4.slam2d.keyframes import Keyframes

_MADE_WITH = ("graph", "graph_2d", "verification")
"""Stages whose settings a review uses."""
_LAST_FIRST = ("level", "review", "verification")
"""Stages that judge edges, the last one first."""


@dataclass(frozen=True)
class Source:
    """The artifacts of a project's latest run; each is read on first use."""

    artifacts: dict[str, Path]

    @staticmethod
    def of(root: Path) -> Source:
        """Open the latest run.

        Raises:
            Altered: If the recorded settings of a stage were changed.
            StoreError: If there is no verified graph yet.
        """
        artifacts = read_artifacts(root)
        if "verification" not in artifacts:
            raise StoreError(CodedText("review-no-graph", root=root.name))
        check_recipes(artifacts[name] for name in _MADE_WITH if name in artifacts)
        return Source(artifacts)

    @property
    def key(self) -> str:
        """Key of the verified graph."""
        return self.artifacts["verification"].name

    @cached_property
    def verified(self) -> PoseGraph:
        """The graph before any decision."""
        return load_graph(self.artifacts["verification"])

    def history(self, frames: tuple[int, int]) -> tuple[Judgment, ...]:
        """Verdicts on a pair in the latest map, oldest first, with those of people and of GNSS.

        Empty if the graph does not have the pair. As long as there is no map: in the verified
        graph.
        """
        made = next(name for name in _LAST_FIRST if name in self.artifacts)
        return load_history(self.artifacts[made], frames)

    @cached_property
    def settings(self) -> Settings:
        """Settings of the search and the verification; others are the defaults."""
        return settings_in(self.artifacts[n] for n in _MADE_WITH if n in self.artifacts)

    @property
    def is_2d(self) -> bool:
        """Whether the nodes are scans of a 2-D laser."""
        return "scans_2d" in self.artifacts

    @cached_property
    def odometry(self) -> Trajectory:
        """``T_odom_body``, dense."""
        stage = "odometry_2d" if self.is_2d else "odometry"
        return load_trajectory(self._folder(stage) / "trajectory.npz")

    @cached_property
    def keyframes(self) -> Keyframes:
        """The nodes of a 2-D map with their returns."""
        from recon4.slam2d.stage import read_keyframes

        scans, odometry = self._folder("scans_2d"), self._folder("odometry_2d")
        return read_keyframes(scans, odometry, settings=tuned(Slam2dTuning, self.settings.slam2d))

    @cached_property
    def frames(self) -> FrameStore:
        """The multiframes."""
        return open_frames(self._folder("frames"), self.artifacts.get("calibration"))

    @cached_property
    def sweeps(self) -> SweepNodes:
        """Sweeps of the profiler's head: the nodes of the graph of such a rig."""
        from recon4.profiler.sweeps import find_sweeps
        from recon4.store.line_store import load_lines

        return find_sweeps(self.frames, load_lines(self.frames.folder))

    def _folder(self, stage: str) -> Path:
        if stage not in self.artifacts:
            raise StoreError(CodedText("stage-missing", stage=stage))
        return self.artifacts[stage]


def graph_key(root: Path) -> str:
    """Key of the verified graph of the latest run; empty if there is none yet.

    Raises:
        StoreError: If the project is damaged.
    """
    found = read_artifacts(root).get("verification")
    return found.name if found else ""
