"""Rigs as the pages edit them: conversion, and what is wrong with one."""

from __future__ import annotations

import math
from collections.abc import Iterator
from ipaddress import IPv4Address

import numpy as np

from recon4.errors import ConfigError, WrongSettings
from recon4.geometry.se3 import SE3, Array
from recon4.locales.coded import CodedText, text_of
from recon4.model.beams import BeamCorrections, parse_beams
from recon4.model.imu_mounts import imu_mount
from recon4.model.lidars import lidar_model
from recon4.model.limits import RIG_LIMITS
from recon4.model.point_recipes import PointRecipe, parse_fields_text
from recon4.model.rig import SENSOR_MODELS, Rig, Sensor
from recon4.model.serial_device import parse_serial_device
from recon4.untrusted.names import visible
from recon4_app.rigs.model import (
    BeamsContent,
    GnssContent,
    ImuContent,
    RigContent,
    SensorContent,
    Triple,
)
from recon4_app.rigs.tuning import RIG_CONTENT

Problem = tuple[str, str]
"""Field, and what is wrong with it."""


def content_of(rig: Rig) -> RigContent:
    """A rig in the units of its file."""
    return RigContent(
        name=visible(rig.name),
        sensors=[_sensor_content(sensor) for sensor in rig.sensors],
        imu=ImuContent(
            sensor=visible(rig.imu_sensor),
            xyz_m=_triple(rig.T_body_imu.t),
            rpy_deg=rpy_deg(rig.T_body_imu.R),
            time_offset_s=rig.imu_time_offset_s,
            port=rig.imu_port,
            topic=visible(rig.imu_topic),
        ),
        gnss=GnssContent(
            lever_arm_m=_triple(rig.p_body_antenna),
            time_offset_s=rig.gnss_time_offset_s,
            port=rig.gnss_port,
            serial=visible(rig.gnss_serial),
            topic=visible(rig.gnss_topic),
        ),
    )


def rig_of(content: RigContent) -> Rig:
    """The rig that a content describes.

    Raises:
        WrongSettings: With the problem of each field.
    """
    problems = problems_of(content)
    if problems:
        raise WrongSettings(problems)
    return Rig(
        name=content.name.strip(),
        sensors=tuple(_sensor(one) for one in content.sensors),
        T_body_imu=_imu_mount(content),
        imu_time_offset_s=content.imu.time_offset_s,
        p_body_antenna=np.array(content.gnss.lever_arm_m),
        gnss_time_offset_s=content.gnss.time_offset_s,
        imu_port=content.imu.port,
        gnss_port=content.gnss.port,
        gnss_serial=content.gnss.serial.strip(),
        imu_topic=content.imu.topic.strip(),
        imu_sensor=content.imu.sensor.strip(),
        gnss_topic=content.gnss.topic.strip(),
    )


def _imu_mount(content: RigContent) -> SE3:
    """That of the LiDAR that the IMU is in, or its own."""
    holder = next((one for one in content.sensors if one.name == content.imu.sensor), None)
    stated = _mount(content.imu.xyz_m, content.imu.rpy_deg)
    if holder is None:
        return stated
    # The page shows the mount of before: where the LiDAR tells it, it follows the LiDAR.
    facts = lidar_model(holder.model)
    follows = facts.has_imu and not any(facts.rpy_sensor_imu_deg)
    return imu_mount(_sensor(holder), None if follows else stated)


def problems_of(content: RigContent) -> dict[str, str]:
    """Field -> the problem, the expected and the found value; empty = the rig is valid."""
    found: dict[str, str] = {}
    for field, text in _problems(content):
        found.setdefault(field, text)
    return found


def warnings_of(content: RigContent) -> list[str]:
    """What can be wrong with a valid rig."""
    found: list[str] = []
    ports: dict[int, list[SensorContent]] = {}
    for sensor in content.sensors:
        ports.setdefault(sensor.port, []).append(sensor)
    for port, sensors in ports.items():
        addresses = {sensor.address for sensor in sensors}
        if len(sensors) > 1 and (len(addresses) < len(sensors) or "" in addresses):
            names = ", ".join(sensor.name for sensor in sensors)
            found.append(CodedText("rig-port-shared", names=names, port=port))
    if not any(sensor.enabled for sensor in content.sensors):
        found.append(CodedText("rig-all-disabled"))
    places = [(sensor.xyz_m, sensor.rpy_deg) for sensor in content.sensors]
    if len(set(places)) < len(places):
        found.append(CodedText("rig-same-pose"))
    return found


def rpy_deg(R: Array) -> Triple:
    """Roll, pitch, yaw [deg] of ``Rz Ry Rx``; with the pitch at 90° the yaw is 0.

    Args:
        R: A rotation, (3, 3).
    """
    level = float(np.hypot(R[0, 0], R[1, 0]))
    pitch = np.arctan2(-R[2, 0], level)
    if level < RIG_CONTENT.gimbal_lock:
        angles = (np.arctan2(np.sign(pitch) * R[0, 1], R[1, 1]), pitch, 0.0)
    else:
        angles = (np.arctan2(R[2, 1], R[2, 2]), pitch, np.arctan2(R[1, 0], R[0, 0]))
    roll, pitch_deg, yaw = (round(float(np.rad2deg(angle)), 9) + 0.0 for angle in angles)
    return roll, pitch_deg, yaw


def _problems(content: RigContent) -> Iterator[Problem]:
    if not content.name.strip():
        yield "name", CodedText("rig-needs-name")
    taken: set[str] = set()
    for k, sensor in enumerate(content.sensors):
        where = f"sensors.{k}"
        label = sensor.name.strip() or CodedText("rig-sensor-number", number=k + 1)
        yield from _sensor_problems(sensor, where, label)
        if sensor.name.strip() in taken:
            yield f"{where}.name", CodedText("rig-name-taken", sensor=label)
        taken.add(sensor.name.strip())
        yield from _mount_problems(sensor.xyz_m, sensor.rpy_deg, where=where, label=label)
        yield from _port_problems(sensor.port, f"{where}.port", label)
    names = [one.name for one in content.sensors]
    if content.imu.sensor and content.imu.sensor not in names:
        yield "imu.sensor", CodedText("rig-imu-holder", names=", ".join(names))
    yield from _mount_problems(content.imu.xyz_m, content.imu.rpy_deg, where="imu", label="IMU")
    yield from _port_problems(content.imu.port, "imu.port", "IMU")
    yield from _distance_problems(
        content.gnss.lever_arm_m, "gnss.lever_arm_m", CodedText("rig-antenna")
    )
    yield from _port_problems(content.gnss.port, "gnss.port", "GNSS")
    yield from _serial_problems(content.gnss)


def _sensor_problems(sensor: SensorContent, where: str, label: str) -> Iterator[Problem]:
    if not sensor.name.strip():
        yield f"{where}.name", CodedText("rig-sensor-needs-name", sensor=label)
    models = SENSOR_MODELS if sensor.kind == "lidar" else ("generic",)
    if sensor.model not in models:
        expected = ", ".join(models)
        yield (
            f"{where}.model",
            CodedText("rig-model-of", sensor=label, expected=expected, got=visible(sensor.model)),
        )
    if sensor.kind != "profiler" and (sensor.head_topic or sensor.head_rate_deg_s):
        yield f"{where}.head_topic", CodedText("rig-profiler-head", sensor=label)
    if abs(sensor.head_rate_deg_s) > RIG_CONTENT.largest_head_deg_s:
        yield (
            f"{where}.head_rate_deg_s",
            CodedText("rig-at-most", sensor=label, limit=f"{RIG_CONTENT.largest_head_deg_s:g} °/s"),
        )
    if sensor.clock_rate_ppm and sensor.kind != "lidar":
        yield f"{where}.clock_rate_ppm", CodedText("rig-lidar-clock", sensor=label)
    if abs(sensor.clock_rate_ppm) > RIG_LIMITS.clock_ppm:
        text = CodedText("rig-at-most", sensor=label, limit=f"{RIG_LIMITS.clock_ppm:g} ppm")
        yield f"{where}.clock_rate_ppm", text
    yield from _beams_problems(sensor, f"{where}.beams", label)
    yield from _fields_problems(sensor, f"{where}.fields", label)
    if sensor.address and not _is_address(sensor.address):
        got = visible(sensor.address)
        yield f"{where}.address", CodedText("rig-address", sensor=label, got=got)


def _beams_problems(sensor: SensorContent, field: str, label: str) -> Iterator[Problem]:
    if sensor.beams is not None and sensor.kind != "lidar":
        yield field, CodedText("rig-lidar-beams", sensor=label)
        return
    try:
        _beams(sensor)
    except ConfigError as error:
        yield field, text_of(error)


def _fields_problems(sensor: SensorContent, field: str, label: str) -> Iterator[Problem]:
    if sensor.fields and sensor.kind != "lidar":
        yield field, CodedText("rig-lidar-columns", sensor=label)
        return
    try:
        _fields(sensor)
    except ConfigError as error:
        yield field, text_of(error)


def _mount_problems(xyz_m: Triple, rpy: Triple, *, where: str, label: str) -> Iterator[Problem]:
    yield from _distance_problems(xyz_m, f"{where}.xyz_m", label)
    if any(abs(angle) > RIG_CONTENT.largest_deg for angle in rpy):
        yield (
            f"{where}.rpy_deg",
            CodedText("rig-angles", sensor=label, limit_deg=RIG_CONTENT.largest_deg, got=str(rpy)),
        )


def _distance_problems(xyz_m: Triple, field: str, label: str) -> Iterator[Problem]:
    if any(abs(value) > RIG_CONTENT.largest_m for value in xyz_m):
        yield (
            field,
            CodedText("rig-position", sensor=label, limit_m=RIG_CONTENT.largest_m, got=str(xyz_m)),
        )


def _port_problems(port: int, field: str, label: str) -> Iterator[Problem]:
    if not 0 <= port <= RIG_CONTENT.largest_port:
        yield field, CodedText("rig-port", sensor=label, limit=RIG_CONTENT.largest_port, got=port)


def _serial_problems(gnss: GnssContent) -> Iterator[Problem]:
    if not gnss.serial.strip():
        return
    try:
        parse_serial_device(gnss.serial.strip())
    except ConfigError as error:
        yield "gnss.serial", text_of(error)
    if not gnss.port:
        yield "gnss.serial", CodedText("gnss-port")


def _is_address(text: str) -> bool:
    try:
        IPv4Address(text)
    except ValueError:
        return False
    return True


def _sensor(content: SensorContent) -> Sensor:
    return Sensor(
        name=content.name.strip(),
        model=content.model,
        T_body_sensor=_mount(content.xyz_m, content.rpy_deg),
        kind=content.kind,
        head_topic=content.head_topic.strip(),
        head_rate_rad_s=math.radians(content.head_rate_deg_s),
        time_offset_s=content.time_offset_s,
        clock_rate_ppm=content.clock_rate_ppm,
        address=content.address,
        port=content.port,
        topic=content.topic.strip(),
        enabled=content.enabled,
        serial=content.serial.strip(),
        description=content.description,
        beams=_beams(content),
        fields=_fields(content),
    )


def _beams(content: SensorContent) -> BeamCorrections | None:
    table = content.beams and content.beams.model_dump()
    return parse_beams(table, f"{content.name}: beams", model=content.model)


def _fields(content: SensorContent) -> PointRecipe | None:
    text = content.fields.strip()
    return parse_fields_text(text, f"{content.name}: fields") if text else None


def _sensor_content(sensor: Sensor) -> SensorContent:
    return SensorContent(
        name=visible(sensor.name),
        kind=sensor.kind,
        model=sensor.model,
        xyz_m=_triple(sensor.T_body_sensor.t),
        rpy_deg=rpy_deg(sensor.T_body_sensor.R),
        time_offset_s=sensor.time_offset_s,
        clock_rate_ppm=sensor.clock_rate_ppm,
        address=visible(sensor.address),
        port=sensor.port,
        topic=visible(sensor.topic),
        head_topic=visible(sensor.head_topic),
        head_rate_deg_s=math.degrees(sensor.head_rate_rad_s),
        enabled=sensor.enabled,
        serial=visible(sensor.serial),
        description=sensor.description,
        beams=_beams_content(sensor.beams),
        fields=sensor.fields.text() if sensor.fields else "",
    )


def _beams_content(beams: BeamCorrections | None) -> BeamsContent | None:
    if beams is None:
        return None
    return BeamsContent(
        range_m=beams.range_m.tolist(),
        elevation_deg=np.rad2deg(beams.elevation_rad).tolist(),
        azimuth_deg=np.rad2deg(beams.azimuth_rad).tolist(),
    )


def _mount(xyz_m: Triple, rpy: Triple) -> SE3:
    roll, pitch, yaw = (math.radians(angle) for angle in rpy)
    return SE3.from_rpy(roll, pitch, yaw, t=xyz_m)


def _triple(values: Array) -> Triple:
    x, y, z = (float(value) for value in values)
    return x, y, z
