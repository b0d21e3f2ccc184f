"""The messages of a capture to the pages of phones: only the fields that are new to each."""

from __future__ import annotations

import msgspec
from msgspec import UNSET, UnsetType

from recon4.live import protocol
from recon4.live.findings import CaptureFinding
from recon4.live.stretches import MarkedStretch
from recon4_app.live.health import LidarHealth
from recon4_app.live.power import Battery


class LocatedMark(msgspec.Struct, tag_field="kind", tag="mark", frozen=True):
    """A mark with its position in the map."""

    t_ns: int
    what: str
    text: str | None
    who: str | None
    p: list[float] | None
    """None = unknown."""


class PathPart(msgspec.Struct, frozen=True):
    """The path from its point ``start`` on."""

    start: int
    points: list[list[float]]


class MarksPart(msgspec.Struct, frozen=True):
    """The marks from number ``start`` on."""

    start: int
    marks: list[LocatedMark]


class StretchesPart(msgspec.Struct, frozen=True):
    """The stretches of findings from number ``start`` on."""

    start: int
    stretches: list[MarkedStretch]


class PointsPart(msgspec.Struct, frozen=True):
    """What the binary message after this one holds."""

    generation: int
    start: int
    count: int
    voxel_m: float
    total: int
    """Points of the whole map."""


class CaptureState(msgspec.Struct, kw_only=True):
    """State of a capture beside its map."""

    project: str
    state: str
    findings: list[CaptureFinding]
    """Findings, most urgent first."""
    rates: dict[str, float]
    """Datagrams per second of each sensor."""
    lidars: list[LidarHealth]
    battery: Battery | None
    server: str
    """Version of the server."""


class NoCapture(msgspec.Struct, kw_only=True):
    """There is none."""

    t: float
    """Time of the server [s]."""
    server: str
    state: str = "none"


class PhoneMessage(msgspec.Struct, kw_only=True):
    """What a phone lacks. A field that is `UNSET` is not sent: the phone has it."""

    t: float
    """Time of the server [s]."""
    status: protocol.Status | UnsetType = UNSET
    notes: protocol.Notes | UnsetType = UNSET
    fix: protocol.Fix | UnsetType = UNSET
    plan: protocol.Plan | UnsetType = UNSET
    gaps: protocol.Gaps | UnsetType = UNSET
    loop: protocol.Loop | UnsetType = UNSET
    motion: protocol.Motion | UnsetType = UNSET
    pose: protocol.Pose | UnsetType = UNSET
    path: PathPart | UnsetType = UNSET
    marks: MarksPart | UnsetType = UNSET
    stretches: StretchesPart | UnsetType = UNSET
    points: PointsPart | UnsetType = UNSET
    project: str | UnsetType = UNSET
    state: str | UnsetType = UNSET
    findings: list[CaptureFinding] | UnsetType = UNSET
    rates: dict[str, float] | UnsetType = UNSET
    lidars: list[LidarHealth] | UnsetType = UNSET
    battery: Battery | UnsetType | None = UNSET
    server: str | UnsetType = UNSET

    def add_changes(self, before: CaptureState | None, now: CaptureState) -> None:
        """Set the fields of a state that differ from those sent before (None = nothing was)."""
        for name in CaptureState.__struct_fields__:
            value = getattr(now, name)
            if before is None or getattr(before, name) != value:
                setattr(self, name, value)
