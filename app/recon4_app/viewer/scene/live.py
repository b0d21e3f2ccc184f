"""Trajectory and graph of a running job: a fold over the events its worker writes.

A finished stage leaves an artifact, which then replaces this state.
"""

from __future__ import annotations

import contextlib
import json
import time
from pathlib import Path

import numpy as np

from recon4.geometry.se3 import SE3
from recon4.model.events import (
    EdgeTried,
    Event,
    NodesPlaced,
    PosesAdded,
    Position,
    Quaternion,
    RunStarted,
    StageChanged,
    VerdictsChanged,
    WorkProgress,
)
from recon4.model.pose_graph import (
    Edge,
    EdgeKind,
    PoseGraph,
    Reason,
    Verdict,
    known_history,
    known_judgment,
)
from recon4.model.trajectory import Trajectory
from recon4_app.jobs.events import read_events
from recon4_app.viewer.tuning import LIVE_SCENE

Pair = tuple[int, int, str]


class LiveGraph:
    """The state of one run, updated with its events."""

    def __init__(self) -> None:
        self._clear()

    def _clear(self) -> None:
        self.stage = ""
        """The stage that runs; empty = none."""
        self._poses: list[tuple[int, Position, Quaternion]] = []
        self._nodes_ns: tuple[int, ...] = ()
        self._nodes_m: tuple[Position, ...] = ()
        self._edges: dict[Pair, Edge] = {}

    def take(self, event: Event) -> None:
        """Apply one event; unused events, and poses of unequal number, change nothing."""
        match event:
            case RunStarted():
                self._clear()
            case StageChanged():
                self._turn_to(event.stage, running=event.state == "running")
            case PosesAdded():
                if self._poses and event.t_ns and event.t_ns[0] <= self._poses[-1][0]:
                    self._poses = []  # the odometry runs again without moving objects
                with contextlib.suppress(ValueError):
                    self._poses += zip(event.t_ns, event.t_m, event.quat_xyzw, strict=True)
            case NodesPlaced():
                self._place(event)
            case EdgeTried():
                self._add(event)
            case VerdictsChanged():
                for i, j, kind, verdict, reason in event.edges:
                    self._judge((i, j, kind), verdict, reason)

    def _place(self, nodes: NodesPlaced) -> None:
        self._nodes_m = nodes.t_m
        if nodes.t_ns:
            self._nodes_ns = nodes.t_ns
            for k in range(len(self._nodes_ns) - 1):  # there is no event for odometry edges
                self._add(
                    EdgeTried(
                        i=k,
                        j=k + 1,
                        edge_kind=EdgeKind.ODOMETRY,
                        verdict=Verdict.ACCEPTED,
                        reason=Reason.NONE,
                    )
                )

    def _turn_to(self, stage: str, *, running: bool) -> None:
        if running:
            self.stage = stage
            if stage == "odometry":
                self._poses = []
            if stage == "graph":
                self._nodes_ns, self._nodes_m, self._edges = (), (), {}
        elif self.stage == stage:
            self.stage = ""

    def _add(self, event: EdgeTried) -> None:
        edge = _edge(event)
        self._edges[edge.i, edge.j, edge.kind.value] = edge

    def _judge(self, pair: Pair, verdict: Verdict, reason: Reason) -> None:
        if pair in self._edges:
            self._edges[pair] = self._edges[pair].judged(known_judgment(verdict, reason))

    @property
    def trajectory(self) -> Trajectory | None:
        """``T_odom_body`` of the odometry so far."""
        if len(self._poses) < 2:
            return None
        t_ns = np.array([row[0] for row in self._poses], dtype=np.int64)
        keep = np.diff(t_ns, prepend=t_ns[0] - 1) > 0
        T = SE3.from_quat(
            np.array([row[2] for row in self._poses]), np.array([row[1] for row in self._poses])
        )
        return Trajectory(t_ns[keep], T[keep])

    @property
    def graph(self) -> PoseGraph | None:
        """Current positions of the nodes (without rotations), and all edges."""
        n = min(len(self._nodes_m), len(self._nodes_ns))
        if n == 0:
            return None
        t_m = np.array(self._nodes_m[:n], dtype=np.float64).reshape(-1, 3)
        T = SE3(np.tile(np.eye(3), (n, 1, 1)), t_m)
        edges = tuple(edge for edge in self._edges.values() if max(edge.i, edge.j) < n)
        t_ns = np.array(self._nodes_ns[:n], dtype=np.int64)
        return PoseGraph(np.arange(n), t_ns, T, edges)


class JobWatch:
    """Finds and follows the events of the job that works on a project."""

    def __init__(self, project: Path, jobs: Path) -> None:
        self._project, self._jobs = str(project), jobs
        self._of: dict[Path, str] = {}
        self._followed: tuple[Path | None, int] = (None, 0)
        self.live = LiveGraph()

    def changed(self) -> bool:
        """Read the new events; whether there were any."""
        job = self._running()
        path, _ = self._followed
        if job != path:
            self.live = LiveGraph()
            self._followed = (job, 0)
        if job is None:
            return job != path
        events, after = read_events(job / "events.jsonl", self._followed[1])
        self._followed = (job, after)
        for event in events:
            self.live.take(event)
        return job != path or any(not isinstance(event, WorkProgress) for event in events)

    def _running(self) -> Path | None:
        """The project's job with the latest heartbeat, while it has no outcome."""
        found = [(beat, path) for path in self._jobs.glob("*") if (beat := self._beat(path))]
        return max(found)[1] if found else None

    def _beat(self, job: Path) -> float | None:
        try:
            beat = (job / "heartbeat").stat().st_mtime
        except OSError:
            return None
        over = time.time() - beat > LIVE_SCENE.silent_s or (job / "outcome.json").exists()
        return None if over or self._project_of(job) != self._project else beat

    def _project_of(self, job: Path) -> str:
        if job not in self._of:
            try:
                request = json.loads((job / "request.json").read_text("utf-8"))
                self._of[job] = str(request["project"])
            except (OSError, ValueError, KeyError, TypeError):
                return ""
        return self._of[job]


def _edge(event: EdgeTried) -> Edge:
    return Edge(
        i=event.i,
        j=event.j,
        T_i_j=SE3.identity(),
        kind=event.edge_kind,
        judgments=known_history(event.verdict, event.reason, kind=event.edge_kind),
        overlap=_nan_for_none(event.overlap),
        error_m=_nan_for_none(event.error_m),
        limit_m=_nan_for_none(event.limit_m),
    )


def _nan_for_none(value: float | None) -> float:
    return float("nan") if value is None else value
