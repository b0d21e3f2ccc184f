"""Events of a run, one record per kind: what the stages report, and a job's log has line by line.

The log (``events.jsonl``) has a JSON object per line: the ``kind``, the time ``t`` in seconds since
1970, and the fields of the record. Readers ignore further fields and unknown kinds, so that logs of
earlier and later versions stay readable.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from recon4.geometry.se3 import Array
from recon4.model.finding import Finding
from recon4.model.pose_graph import EdgeKind, Reason, Verdict

Position = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class Event:
    """Something that happened in a run."""

    kind: ClassVar[str] = ""
    t: float | None = None
    """Seconds since 1970; None = not written yet."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RunStarted(Event):
    """A worker has begun; all events before are of another one."""

    kind: ClassVar[str] = "run"


@dataclass(frozen=True, slots=True, kw_only=True)
class WorkProgress(Event):
    """Progress of the current piece of work."""

    kind: ClassVar[str] = "progress"
    what: str
    done: int
    total: int
    """Units in all; 0 = not known."""
    seconds: float
    """Since the piece of work began [s]."""
    unit: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class StageChanged(Event):
    """A stage began or ended."""

    kind: ClassVar[str] = "stage"
    stage: str
    state: str
    """``running``, ``done`` or ``reused``."""
    key: str = ""
    """Of its artifact."""
    seconds: float | None = None
    """Duration [s]; None while it runs."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PosesAdded(Event):
    """Poses ``T_odom_body`` of the odometry."""

    kind: ClassVar[str] = "poses"
    t_ns: tuple[int, ...]
    t_m: tuple[Position, ...]
    quat_xyzw: tuple[Quaternion, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class NodesPlaced(Event):
    """Positions of all nodes of the graph [m]."""

    kind: ClassVar[str] = "nodes"
    t_m: tuple[Position, ...]
    t_ns: tuple[int, ...] = ()
    """Empty = the same nodes as before, moved."""


@dataclass(frozen=True, slots=True, kw_only=True)
class EdgeTried(Event):
    """Result of the registration of a pair of nodes; figures are None where not computed."""

    kind: ClassVar[str] = "edge"
    i: int
    j: int
    edge_kind: EdgeKind
    verdict: Verdict
    reason: Reason
    overlap: float | None = None
    error_m: float | None = None
    limit_m: float | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class VerdictsChanged(Event):
    """Verdicts of the verification: nodes, kind, verdict and reason of each edge."""

    kind: ClassVar[str] = "verdicts"
    edges: tuple[tuple[int, int, EdgeKind, Verdict, Reason], ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class ArtifactDamaged(Event):
    """An artifact was damaged; it is kept under another name and made again."""

    kind: ClassVar[str] = "damaged"
    stage: str
    moved_to: str
    """Path below the project."""
    files: tuple[str, ...]
    """What is wrong with the first of its files."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Warned(Event):
    """A warning for the operator."""

    kind: ClassVar[str] = "warning"
    text: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Remarked(Event):
    """A reader warns of something in the recording."""

    kind: ClassVar[str] = "remark"
    finding: Finding


@dataclass(frozen=True, slots=True, kw_only=True)
class TrackingLost(Event):
    """The odometry could not place a multiframe."""

    kind: ClassVar[str] = "lost"
    frame_id: int
    t_ns: int


@dataclass(frozen=True, slots=True, kw_only=True)
class RoundRefined(Event):
    """Result of a round of the refinement; see `recon4.model.figures.RefineRound`."""

    kind: ClassVar[str] = "refine"
    mean_m: float
    match_ratio: float
    largest_step_m: float


@dataclass(frozen=True, slots=True, kw_only=True)
class MapBuilt(Event):
    """The tiles of the map are complete."""

    kind: ClassVar[str] = "map"
    points: int
    removed: Mapping[str, int]
    """Points left out, by reason."""


def positions_of(t_m: Array) -> tuple[Position, ...]:
    """Positions (N, 3) for an event, rounded to a millimeter [m]."""
    return tuple((x, y, z) for x, y, z in np.round(t_m, 3).tolist())


KINDS: dict[str, type[Event]] = {
    record.kind: record
    for record in (
        RunStarted,
        WorkProgress,
        StageChanged,
        PosesAdded,
        NodesPlaced,
        EdgeTried,
        VerdictsChanged,
    )
}
"""Kind -> record, of the events that have a reader; the others are for the text of the log."""
