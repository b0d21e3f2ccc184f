"""Requests and responses of the rigs API."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Base64Bytes, BaseModel, ConfigDict, Field

from recon4.model.limits import RIG_LIMITS
from recon4.model.rig import SensorKind
from recon4_app.names import Name, Note
from recon4_app.rigs.tuning import RIG_TEXTS

Number = Annotated[float, Field(ge=-4e9, le=4e9, allow_inf_nan=False)]
Triple = tuple[Number, Number, Number]
Port = Annotated[int, Field(ge=-(1 << 31), le=1 << 31)]
RIG_ID = r"^[A-Za-z0-9][A-Za-z0-9._-]{0,63}$"


class RigPart(BaseModel):
    """Part of a rig in a request; without unknown keys."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class BeamsContent(RigPart):
    """Corrections of the beams of a LiDAR, ring 0 (the lowest) first."""

    range_m: list[Number] = Field(max_length=RIG_LIMITS.beams)
    """Added to the measured range [m]."""
    elevation_deg: list[Number] = Field(max_length=RIG_LIMITS.beams)
    """Added to the elevation of the data sheet [deg]."""
    azimuth_deg: list[Number] = Field(max_length=RIG_LIMITS.beams)
    """Added to the azimuth [deg]."""


class SensorContent(RigPart):
    """One LiDAR, profiler or 2-D laser, in the units of a rig file."""

    name: Name = Field(max_length=RIG_TEXTS.longest_text)
    """Unique within the rig."""
    kind: SensorKind = "lidar"
    model: Name = Field(default="VLP-16", max_length=RIG_TEXTS.longest_text)
    """See `/api/sensor-models`."""
    xyz_m: Triple = (0.0, 0.0, 0.0)
    """Origin of the sensor in the body frame [m]."""
    rpy_deg: Triple = (0.0, 0.0, 0.0)
    """Roll, pitch, yaw in the body frame [deg]."""
    time_offset_s: Number = 0.0
    """Added to its timestamps [s]."""
    clock_rate_ppm: Number = 0.0
    """LiDAR: added for each second since its first measurement [µs]."""
    address: Name = Field(default="", max_length=RIG_TEXTS.longest_text)
    """IPv4 address its packets come from; empty = any."""
    port: Port = 2368
    """UDP port its packets go to."""
    topic: Name = Field(default="", max_length=RIG_TEXTS.longest_text)
    """Topic in a bag; empty = detected."""
    head_topic: Name = Field(default="", max_length=RIG_TEXTS.longest_text)
    """Profiler: topic of the angle of its head; empty = detected."""
    head_rate_deg_s: Number = 0.0
    """Profiler: constant turn rate of its head [deg/s]; 0 = the recording has the angles."""
    enabled: bool = True
    """False: its points are stored, but neither registered nor mapped."""
    serial: Name = Field(default="", max_length=RIG_TEXTS.longest_text)
    """Serial number; empty = not known."""
    description: str = Field(default="", max_length=RIG_LIMITS.file_bytes)
    """Metadata or table of angles of this very sensor, as its maker writes them."""
    beams: BeamsContent | None = None
    """Corrections of single beams; null = none."""
    fields: Name = Field(default="", max_length=RIG_TEXTS.longest_text)
    """What the columns of its points are, as `x=px:mm,y=py:mm,z=pz:mm`; empty = common names."""


class ImuContent(RigPart):
    """The IMU."""

    sensor: Name = Field(default="", max_length=RIG_TEXTS.longest_text)
    """Name of the LiDAR whose IMU it is, mounted as that LiDAR; empty = an IMU of its own."""
    xyz_m: Triple = (0.0, 0.0, 0.0)
    rpy_deg: Triple = (0.0, 0.0, 0.0)
    time_offset_s: Number = 0.0
    port: Port
    """UDP port of its datagrams; 0 = none."""
    topic: Name = Field(default="", max_length=RIG_TEXTS.longest_text)
    """Topic in a bag; empty = chosen by content."""


class GnssContent(RigPart):
    """The GNSS receiver."""

    lever_arm_m: Triple = (0.0, 0.0, 0.0)
    """Phase center of the antenna in the body frame [m]."""
    time_offset_s: Number = 0.0
    port: Port
    """UDP port of its datagrams; 0 = none."""
    serial: Name = Field(default="", max_length=RIG_TEXTS.longest_text)
    """Serial device and baud rate; empty = none."""
    topic: Name = Field(default="", max_length=RIG_TEXTS.longest_text)
    """Topic in a bag; empty = chosen by content."""


class RigContent(RigPart):
    """A rig in the units of a rig file."""

    name: Name = Field(max_length=RIG_TEXTS.longest_text)
    """Display name."""
    sensors: list[SensorContent] = Field(min_length=1, max_length=RIG_LIMITS.sensors)
    imu: ImuContent
    gnss: GnssContent


class FileBeside(RigPart):
    """A file that describes a LiDAR, as its maker delivers it: metadata, or a table of angles."""

    name: Name = Field(max_length=RIG_TEXTS.longest_text)
    content: Base64Bytes = Field(max_length=RIG_LIMITS.file_bytes)


class NewVersion(RigPart):
    """Request for a version of a rig; exactly one of ``content`` and ``toml``."""

    content: RigContent | None = None
    toml: str | None = Field(default=None, max_length=RIG_LIMITS.file_bytes)
    """Text of a rig file."""
    beside: list[FileBeside] = Field(default=[], max_length=RIG_LIMITS.sensors)
    """Files beside it, which become the descriptions of its LiDARs."""
    note: Note = Field(default="", max_length=500)
    """Why there is a new version."""
    after: int | None = Field(default=None, ge=0, le=1 << 31)
    """Newest version when the rig was read: with a newer one the request is rejected.
    None = after any version."""


class NewRig(RigPart):
    """Request for a rig; exactly one of ``content``, ``toml`` and ``copy_of``."""

    id: str = Field(pattern=RIG_ID)
    """Name of its folder."""
    content: RigContent | None = None
    toml: str | None = Field(default=None, max_length=RIG_LIMITS.file_bytes)
    beside: list[FileBeside] = Field(default=[], max_length=RIG_LIMITS.sensors)
    """Files beside the rig file, which become the descriptions of its LiDARs."""
    copy_of: str = Field(default="", max_length=64)
    """Rig whose newest version is copied."""
    note: Note = Field(default="", max_length=500)


class CalibratedVersion(RigPart):
    """Request to save the calibrated rig of a project."""

    rig: str = Field(pattern=RIG_ID)
    create: bool = False
    """Whether it becomes the first version of a new rig."""
    note: Note = Field(default="", max_length=500)


class RigVersion(BaseModel):
    """A version of a rig; it never changes."""

    number: int
    path: str
    """Value of ``rig`` of a job or capture."""
    who: str
    when: str
    """UTC, ISO 8601."""
    note: str
    evidence: str
    """Calibration it comes from; empty = none."""
    name: str
    """Display name of the rig."""
    sensors: list[str]
    """Names of its LiDARs."""
    digest: str
    """SHA-256 of the rig as projects store it."""
    sha256: str
    """SHA-256 of the file."""
    problem: str = ""
    """Why it cannot be read; empty = it can."""


class RigCard(BaseModel):
    """A rig in the list."""

    id: str
    shipped: bool
    """Whether it comes with recon4; then it cannot be changed."""
    name: str
    sensors: list[str]
    version: int
    """Newest version; 0 = shipped."""
    when: str
    """Time of the newest version; empty = shipped."""
    path: str
    """Value of ``rig`` of a job or capture."""
    problem: str = ""


class RigUse(BaseModel):
    """A project and the rig it was recorded with."""

    project: str
    name: str
    """Display name of the project."""
    version: int
    """0 = shipped."""


class RigView(BaseModel):
    """One version of a rig."""

    id: str
    shipped: bool
    version: int
    """0 = shipped."""
    content: RigContent
    versions: list[RigVersion]
    """Newest first; none of a shipped rig."""
    uses: list[RigUse]


class RigCheck(BaseModel):
    """Result of checking a rig."""

    problems: dict[str, str]
    """Field, such as ``sensors.0.port`` -> the problem and the expected value."""
    warnings: list[str]
    """What can be wrong, but is not forbidden."""


class SensorModel(BaseModel):
    """A model of a sensor."""

    model: str
    elevation_deg: tuple[float, float] | None
    """Lowest and highest beam [deg]; None = not known."""


class ParameterView(BaseModel):
    """What a recording says of one parameter of its rig."""

    sensor: str
    quantity: str
    axis: str
    unit: Literal["rad", "m", "s"]
    change: float
    sd: float | None
    status: Literal["consistent", "off", "not observable"]


class AgreementView(BaseModel):
    """How well a rig explains the windows of a walk that were not used."""

    rms_m: float | None
    offset_m: float | None
    imu_rms: float | None


class SavedRig(BaseModel):
    """A version of a stored rig."""

    id: str
    version: int


class LidarSlicesView(BaseModel):
    """A horizontal slice as one LiDAR sees it, around the body."""

    name: str
    before: list[tuple[float, float]] = Field(max_length=20_000)
    """Points by the rig file, x and y [m]."""
    after: list[tuple[float, float]] = Field(max_length=20_000)
    """The same by the calibrated rig."""


class CalibrationSlices(BaseModel):
    """What the LiDARs see before and after a calibration."""

    thickness_m: float
    lidars: list[LidarSlicesView] = Field(max_length=64)


class CalibrationView(BaseModel):
    """Audit of the rig of a project, and its calibration."""

    outcome: str
    applied: bool
    """Whether the calibrated rig was used for the map."""
    windows: int
    rms_m: float | None
    parameters: list[ParameterView]
    beams: list[ParameterView]
    """The same of single beams; ``axis`` is the ring. Empty = they were not estimated."""
    before: AgreementView | None
    after: AgreementView | None
    rig: SavedRig | None
    """Stored or shipped rig of the recording, where it is known."""
    saved: SavedRig | None
    """Version in which the calibrated rig is stored already."""
