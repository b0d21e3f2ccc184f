"""Messages of a live capture, one record each: JSON lines on the sockets of recorder and mapper.

A message has its name in the field ``kind``, a request to the recorder in the field ``do``. Bytes
are base64. The server sends the newest messages on to the phones; ``docs/how-to/live.md`` has their
fields.

    recorder -> clients     written, status, mark, stopped
    mapper   -> clients     pose, path, points, plan, gaps, loop, motion, fix, notes, done
    clients  -> recorder    stop, pause, resume, mark
"""

from __future__ import annotations

from typing import Annotated, TypeVar, cast

import msgspec

from recon4.errors import Recon4Error
from recon4.model.finding import Finding
from recon4.model.odometry_figures import ImuAxes, ImuTurn

_T = TypeVar("_T")
Text = Annotated[str, msgspec.Meta(max_length=4000)]
Position = Annotated[list[float], msgspec.Meta(min_length=2, max_length=3)]
"""x, y and, except in plans, z in the map frame [m]."""


class ProtocolError(Recon4Error):
    """A line on a socket is not a message of this protocol."""


# -- messages of the recorder


class Written(msgspec.Struct, tag_field="kind", tag="written"):
    """The capture file grew."""

    size: int = msgspec.field(name="bytes")
    """Readable bytes."""


class Sender(msgspec.Struct):
    """Datagrams of one sender to one port."""

    source: str
    """Address, or ``others``."""
    port: int
    per_s: float
    """Datagrams per second."""
    data_per_s: float
    """Datagrams per second that are large enough for a data packet of a LiDAR."""
    silent_s: float
    """Time since the last one [s]."""


class FileState(msgspec.Struct):
    """State of the capture file."""

    written_bytes: int = 0
    """Passed to the system, complete records only."""
    synced_bytes: int = 0
    """Synced to the disk."""
    datagrams: int = 0
    dropped: int = 0
    """Datagrams missing in the file because the disk was full or too slow."""
    waiting_bytes: int = 0
    longest_sync_s: float = 0.0
    problem: str = ""
    """Why nothing is written now; empty = no problem."""


class DiskState(msgspec.Struct, frozen=True):
    """Free space of the disk."""

    free_bytes: int | None = None
    """None = unknown."""
    left_s: int | None = None
    """Time until the disk is full [s]; None = unknown, or it is not filling."""
    enough: bool = True
    """Whether there is enough space to continue."""


class RecorderState(msgspec.Struct, kw_only=True):
    """Fields of the messages `Status` and `Stopped`."""

    t_ns: int
    """Time of the recorder [ns]."""
    began_ns: int
    seconds: float
    """Time since the start [s]."""
    paused: bool
    skipped_in_pauses: int
    """Datagrams received in pauses."""
    senders: Annotated[list[Sender], msgspec.Meta(max_length=1000)]
    ports: dict[str, str]
    """Port number -> devices expected there."""
    kernel_drops: int
    """Datagrams the kernel dropped."""
    serial: str | None
    """Problem of the serial line; empty = none, null = there is no serial line."""
    file: FileState
    disk: DiskState
    notes: str
    """Why a mark is not on the disk; empty = all marks are."""


class Status(RecorderState, tag_field="kind", tag="status"):
    """State of the recorder, twice per second."""


class Stopped(RecorderState, tag_field="kind", tag="stopped"):
    """The capture file is complete."""

    why: str
    """``stopped``, or why the recording ended by itself."""


class Mark(msgspec.Struct, tag_field="kind", tag="mark", omit_defaults=True, frozen=True):
    """A mark of the operator, or the start or end of a pause; it is on the disk."""

    t_ns: int
    what: str
    """``point``, ``place``, ``pause`` or ``resume``."""
    text: str | None = None
    who: str | None = None


# -- messages of the mapper


class RecentFrames(msgspec.Struct, frozen=True):
    """Multiframes of the last 10 s."""

    frames: int
    thinned: int
    """Those left out of the preview."""


class Pose(msgspec.Struct, tag_field="kind", tag="pose", kw_only=True):
    """Pose of a multiframe and quality of its registration."""

    frame_id: int
    t_ns: int
    """End of the multiframe, on the recorder's clock [ns]."""
    p: Position
    yaw: float
    """Heading in the map [rad]."""
    lost: bool
    """Whether tracking is lost."""
    lost_frames: int
    relocated: int
    """Number of relocalizations."""
    error_m: float | None
    match_ratio: float | None
    weak_sd_m: float | None
    """Standard deviation along the weakest direction by this multiframe's LiDARs alone [m]; None
    while the body stands."""
    prediction_offset_m: float | None
    turn_rad_s: float | None
    points: list[int]
    """Number of points of each sensor."""
    thinned: int
    """Multiframes left out of the preview since the start."""
    lately: RecentFrames
    imu: bool
    """Whether the odometry uses the IMU."""
    remark: str
    """Code of a warning about the IMU or the map, and why; empty = none."""
    imu_turn: ImuTurn | None = None
    imu_axes: ImuAxes | None = None
    """What was found wrong with the axes of the IMU, whose samples are repaired; None = nothing."""
    unobserved: str = ""
    """Direction that a 2-D laser does not observe now: ``along`` or ``across`` the heading; empty =
    it observes all, or there are LiDARs."""
    age_s: float = 0.0
    """Latency of the mapping [s]."""


class Path(msgspec.Struct, tag_field="kind", tag="path"):
    """The whole path so far; empty after a map reset."""

    points: list[Position]


class Points(msgspec.Struct, tag_field="kind", tag="points"):
    """New points of the preview."""

    generation: int
    """A new one voids all points before."""
    start: int
    """Number of points of the generation before these."""
    count: int
    voxel_m: float
    voxels: bytes
    """Integer voxel coordinates, int16 (N, 3)."""
    values: bytes
    """Normalized intensity, uint8 (N,)."""


class Plan(msgspec.Struct, tag_field="kind", tag="plan"):
    """Coverage of the current floor."""

    floor: int
    cell_m: float
    first_cell: Annotated[list[int], msgspec.Meta(min_length=2, max_length=2)]
    shape: Annotated[list[int], msgspec.Meta(min_length=2, max_length=2)]
    seen: bytes
    """`CoverageClass` of each cell, uint8, compressed with zlib."""


class Gap(msgspec.Struct):
    """A place that was not seen."""

    p: Position
    width_m: float
    away_m: float
    """Distance from the path [m]."""


class Gaps(msgspec.Struct, tag_field="kind", tag="gaps"):
    """Gaps of the current floor."""

    gaps: Annotated[list[Gap], msgspec.Meta(max_length=1000)]
    well: float | None
    """Part of the walls near the path that is seen well, 0 to 1; null = unknown."""
    elsewhere: int
    """Number of gaps on other floors."""


class Loop(msgspec.Struct, tag_field="kind", tag="loop"):
    """State of the loop back to the start."""

    near: bool
    """Whether a place visited before is near."""
    closed: bool
    drift_m: float | None = None
    """Drift at the last recognized place; null = none yet."""
    walked_m: float | None = None
    start_m: float | None = None
    """Distance from the start."""


class Axis(msgspec.Struct, frozen=True):
    """What the walk shows of one parameter of the rig."""

    quantity: Text
    """``rotation``, ``position`` or ``clock``."""
    axis: Text
    """``x``, ``y`` or ``z`` of the body; empty for a clock."""
    shown: float
    """Part of the information that a calibration needs, 0 to 1."""


class Motion(msgspec.Struct, tag_field="kind", tag="motion"):
    """What the motion so far shows of the rig, for a calibration."""

    still_s: float
    """Longest time without motion [s]."""
    tilt_deg: Annotated[list[float], msgspec.Meta(min_length=2, max_length=2)]
    """Range of the tilt to the front and to the sides [°]."""
    turned_deg: Annotated[list[float], msgspec.Meta(min_length=2, max_length=2)]
    """Turned to the left and to the right, in all [°]."""
    axes: Annotated[list[Axis], msgspec.Meta(max_length=100)]


class Fix(msgspec.Struct, tag_field="kind", tag="fix"):
    """Newest fix of the GNSS receiver."""

    t_ns: int
    quality: int
    lat_rad: float
    lon_rad: float
    sd_m: Annotated[list[float], msgspec.Meta(min_length=3, max_length=3)] | None
    """Standard deviations east, north, up; null = unknown."""
    jumped_m: float | None
    """Recent jump of the position; null = none."""


class Notes(msgspec.Struct, tag_field="kind", tag="notes"):
    """Findings and repairs of the reader."""

    findings: Annotated[list[Finding], msgspec.Meta(max_length=100)]
    counts: dict[str, int]
    recent: dict[str, int]
    """Counts of the last 10 s."""


class Done(msgspec.Struct, tag_field="kind", tag="done"):
    """The mapper has ended."""

    frames: int
    """Number of multiframes in the project."""
    problem: str
    """Why there are none, in English; empty = no problem."""
    seconds: float = 0.0
    """Time to complete the project [s]."""
    code: str = ""
    """Of the problem, as in `StoredText`; empty = it has none."""
    values: dict[str, int | float | str] = {}
    """What its text quotes."""


RecorderMessage = Written | Status | Mark | Stopped
MapperMessage = Pose | Path | Points | Plan | Gaps | Loop | Motion | Fix | Notes | Done
Message = RecorderMessage | MapperMessage


# -- requests to the recorder


class Stop(msgspec.Struct, tag_field="do", tag="stop", frozen=True):
    """End the recording."""


class Pause(msgspec.Struct, tag_field="do", tag="pause", frozen=True):
    """Record nothing until `Resume`."""


class Resume(msgspec.Struct, tag_field="do", tag="resume", frozen=True):
    """End a pause."""


class AddMark(msgspec.Struct, tag_field="do", tag="mark", frozen=True):
    """Save a mark."""

    what: Annotated[str, msgspec.Meta(max_length=20)]
    text: Text | None = None
    who: Text | None = None
    ago_s: Annotated[float, msgspec.Meta(ge=0.0, le=3600.0)] = 0.0
    """Age of the mark [s]."""


Request = Stop | Pause | Resume | AddMark

_MESSAGES: msgspec.json.Decoder[Message] = msgspec.json.Decoder(Message)
_REQUESTS: msgspec.json.Decoder[Request] = msgspec.json.Decoder(Request)


def encode(record: Message | Request) -> bytes:
    """A message or request as a line."""
    return msgspec.json.encode(record) + b"\n"


def decode_message(line: bytes) -> Message:
    """Decode a line of recorder or mapper.

    Raises:
        ProtocolError: If it is not a message; unknown fields are ignored.
    """
    return _decoded(_MESSAGES, line)


def decode_request(line: bytes) -> Request:
    """Decode a line of a client.

    Raises:
        ProtocolError: If it is not a request; unknown fields are ignored.
    """
    return _decoded(_REQUESTS, line)


def kind_of(message: Message) -> str:
    """The name of a message, as in its field ``kind``."""
    return cast("str", message.__struct_config__.tag)


def fields_of(record: Message) -> dict[str, object]:
    """The fields of a message as JSON values, without ``kind``; for files."""
    fields: dict[str, object] = msgspec.to_builtins(record)
    del fields["kind"]
    return fields


def _decoded(decoder: msgspec.json.Decoder[_T], line: bytes) -> _T:
    try:
        return decoder.decode(line)
    except (msgspec.MsgspecError, UnicodeDecodeError, RecursionError) as error:
        start = line[:80].decode("utf-8", "backslashreplace").rstrip()
        raise ProtocolError(
            f"not a message of a live capture: {error}; got {start!r} ({len(line)} bytes)"
        ) from error
