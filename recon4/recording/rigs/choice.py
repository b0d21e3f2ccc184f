"""Chooses the rig of a recording and assigns its streams to the sensors of the rig."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from recon4.errors import ConfigError
from recon4.geometry.se3 import SE3
from recon4.locales.coded import CodedText
from recon4.model.derived_kinds import DerivedKind
from recon4.model.finding_kinds import FindingKind
from recon4.model.imu_mounts import imu_mount
from recon4.model.lidars import lidar_model
from recon4.model.point_recipes import PointRecipe
from recon4.model.rig import Rig, Sensor, load_rig
from recon4.recording.report import ImportReport
from recon4.recording.rigs.mismatch import mismatch_text

THESIS_RIG = "4recon"


@dataclass(frozen=True, slots=True)
class Stream:
    """The data of one LiDAR in a recording of any kind."""

    label: str
    """Display name: topic, or address and port."""
    model: str
    """`SENSOR_MODELS`; ``generic`` when unknown."""
    address: str = ""
    port: int = 0
    topic: str = ""
    serial: str = ""
    """Serial number, where several LiDARs send from one address to one port."""
    frame: str = ""
    """Frame of its points in a bag; empty = not known."""
    points: int = 0
    """Usual number of points of a cloud; 0 = not known."""
    detail: int = 0
    """How much of what a LiDAR measures its clouds have (`CloudTopic.detail`)."""
    fields: PointRecipe | None = None
    """What the columns of its points are; None = they have common names."""

    @property
    def likeness(self) -> tuple[int, bool, int]:
        """How much it looks like the main LiDAR, by its content."""
        return self.detail, self.model != "generic", self.points


class RigToComplete(ConfigError):
    """A recording that needs a rig; one is there for a person to complete."""

    def __init__(self, text: str, rig: Rig, uncertain: Sequence[str] = ()) -> None:
        """Prepare.

        Args:
            text: What is missing, and what to do.
            rig: The LiDARs, all at the origin of the body.
            uncertain: What a person should look at, besides the mounts of several LiDARs.
        """
        super().__init__(text)
        self.rig, self.uncertain = rig, tuple(uncertain)


class UnknownMounts(RigToComplete):
    """Several LiDARs, and nothing says how they are mounted."""


def choose_rig(streams: Sequence[Stream], report: ImportReport, *, why: str = "") -> Rig:
    """Choose the rig of a recording without a given one; noted in the report.

    Args:
        streams: The LiDARs.
        report: Receives what was chosen.
        why: Why the recording itself does not say how they are mounted.

    Raises:
        UnknownMounts: If there are several LiDARs of unknown mounting.
    """
    if len(streams) == 1:
        rig = single_rig(streams[0])
        report.derive(DerivedKind.RIG_CHOSEN, model=streams[0].model, own_frame=True)
        return rig
    thesis = load_rig(THESIS_RIG)
    if _is_thesis(streams, thesis):
        report.derive(DerivedKind.RIG_CHOSEN, sensors=_names(streams), preset=thesis.name)
        return thesis
    raise UnknownMounts(_remedy(streams, why), rig_to_complete(streams))


def _remedy(streams: Sequence[Stream], why: str) -> str:
    """What to do with several LiDARs of unknown mounting: ready to paste."""
    lines = [
        f"{len(streams)} LiDARs and no rig: how they are mounted is unknown"
        f"{f' ({why})' * bool(why)}:"
    ]
    lines += [f"  {_described(stream)}" for stream in streams]
    if streams[0].topic:
        best = max(streams, key=lambda stream: stream.likeness).topic
        lines.append(
            f"Read one of them: set lidar_topic of ingest to {best} (page: All settings; command: "
            f"--set ingest.lidar_topic={best})"
        )
    lines.append(
        "Or give a rig (page: Rigs, then the field Rig; command: --rig FILE; 4recon is the rig of "
        "the thesis) with their mounts in the body, x forward, y left, z up; a sensor that is not "
        "listed is not read:"
    )
    ports = [stream.port for stream in streams]
    lines.append('name = "my rig"')
    for number, stream in enumerate(streams):
        name = stream.topic.strip("/").replace("/", "_") or f"lidar_{stream.port or number}"
        if stream.port and ports.count(stream.port) > 1:
            name = f"lidar_{stream.address}_{stream.port}"
        lines += _skeleton(stream, name)
    return "\n".join(lines)


def rig_to_complete(streams: Sequence[Stream]) -> Rig:
    """The LiDARs of a recording at the origin of the body, to be completed by their mounts.

    The IMU is that of the first LiDAR that has one.
    """
    sensors = []
    for number, stream in enumerate(streams):
        name = stream.topic.strip("/").replace("/", "_") or f"lidar{number}"
        one = single_rig(stream).sensors[0]
        sensors.append(replace(one, name=name, address=stream.address, serial=stream.serial))
    rig = replace(single_rig(streams[0]), name="found in the recording")
    return with_lidars(rig, sensors)


def with_lidars(rig: Rig, sensors: Sequence[Sensor]) -> Rig:
    """A rig with these LiDARs, and the IMU in the first one that has one."""
    holder = next((one for one in sensors if lidar_model(one.model).has_imu), None)
    return replace(
        rig,
        sensors=tuple(sensors),
        T_body_imu=imu_mount(holder) if holder else SE3.identity(),
        imu_sensor=holder.name if holder else "",
    )


def _described(stream: Stream) -> str:
    frame = f", frame {stream.frame}" * bool(stream.frame)
    return f"{stream.label} {stream.model}{frame}" + f", {stream.points} points" * bool(
        stream.points
    )


def _skeleton(stream: Stream, name: str) -> list[str]:
    """The part of a rig file of a sensor; its mount is to be filled in."""
    lines = ["[[sensor]]", f"name = {json.dumps(name)}", f"model = {json.dumps(stream.model)}"]
    lines += [f"serial = {json.dumps(stream.serial)}"] if stream.serial else []
    if stream.topic:
        lines.append(f"topic = {json.dumps(stream.topic)}")
    elif stream.port:
        lines += [f"address = {json.dumps(stream.address)}", f"port = {stream.port}"]
    return [*lines, "xyz_m = [0.0, 0.0, 0.0]", "rpy_deg = [0.0, 0.0, 0.0]"]


def single_rig(stream: Stream) -> Rig:
    """One LiDAR whose frame is the body's."""
    sensor = Sensor(
        name="lidar",
        model=stream.model,
        T_body_sensor=SE3.identity(),
        port=stream.port or 2368,
        topic=stream.topic,
        fields=stream.fields,
    )
    turned = any(lidar_model(stream.model).rpy_sensor_imu_deg)  # an IMU of its own is not
    return Rig(
        name=f"single {stream.model}",
        sensors=(sensor,),
        T_body_imu=SE3.identity() if turned else imu_mount(sensor),
        imu_time_offset_s=0.0,
        p_body_antenna=np.zeros(3),
        gnss_time_offset_s=0.0,
    )


def assign_topics(rig: Rig, streams: Sequence[Stream], report: ImportReport) -> Rig:
    """The rig with the topic of every sensor filled in; a sensor without one is missing.

    In this order: the topic the rig names; a topic with the sensor's name in it; as many topics
    left as sensors, in their order.

    Raises:
        ConfigError: If no sensor of the rig is in the recording.
    """
    topics = [stream.topic for stream in streams]
    chosen = {s.name: s.topic for s in rig.sensors if s.topic in topics}
    unnamed = [s for s in rig.sensors if not s.topic]
    for sensor in unnamed:
        alike = [t for t in _free(topics, chosen) if sensor.name.lower() in t.lower()]
        if len(alike) == 1:
            chosen[sensor.name] = alike[0]
    left = [s for s in unnamed if s.name not in chosen]
    if len(left) == len(_free(topics, chosen)):
        for sensor, topic in zip(left, _free(topics, chosen), strict=True):
            chosen[sensor.name] = topic
            report.derive(DerivedKind.SENSOR_TOPIC, sensor=sensor.name, topic=topic)
    if not chosen:
        raise ConfigError(CodedText("rig-not-recorded", why=mismatch_text(rig, _names(streams))))
    _warn_unassigned(rig, chosen, _free(topics, chosen), report=report)
    sensors = [replace(s, topic=chosen.get(s.name, s.topic)) for s in rig.sensors]
    return replace(rig, sensors=tuple(sensors))


def _free(topics: Sequence[str], chosen: dict[str, str]) -> list[str]:
    return [topic for topic in topics if topic not in chosen.values()]


def _warn_unassigned(
    rig: Rig, chosen: dict[str, str], free: Sequence[str], *, report: ImportReport
) -> None:
    for sensor in rig.sensors:
        if sensor.name not in chosen:
            named = {"topic": sensor.topic} if sensor.topic else {}
            report.warn(FindingKind.SENSOR_NOT_RECORDED, sensor=sensor.name, **named)
    for topic in free:
        report.warn(FindingKind.TOPIC_UNASSIGNED, topic=topic)


def _is_thesis(streams: Sequence[Stream], thesis: Rig) -> bool:
    if len(streams) != len(thesis.sensors) or any(s.model != "VLP-16" for s in streams):
        return False
    if sorted(s.port for s in streams) == sorted(s.port for s in thesis.sensors):
        return True
    topics = [stream.topic.lower() for stream in streams]
    return all(sum(s.name in topic for topic in topics) == 1 for s in thesis.sensors)


def _names(streams: Sequence[Stream]) -> str:
    return ", ".join(f"{s.label} {s.model}" for s in streams)
