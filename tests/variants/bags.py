"""Bags of a LiDAR with an IMU, and of whatever else a robot records."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from recon4.geometry.se3 import SE3
from tests.builders import bag_path, storage_file
from tests.robot_bags import RobotBag
from tests.variants.capture_files import points_in
from tests.variants.companions import odometry, others, write_unread
from tests.variants.layouts import draw_layout, points_of
from tests.variants.messages import (
    DRIVER_MESSAGES,
    CloudMessage,
    DriverMessage,
    ImuMessage,
    PacketsMessage,
)
from tests.variants.other_lidars import packets_of
from tests.variants.plan import BagPlan, write_transforms
from tests.variants.several import add_lidar, draw_copy, lidars_of
from tests.variants.variant import Draw, Variant
from tests.variants.walk import TURN_NS, Cloud, RecordedWalk, turned

_SECOND_NS = 1_000_000_000
_HEADERS = 42
_CLOCKS = {
    "UTC": 0,
    "TAI": 37 * _SECOND_NS,
    "GPS time since 1980": (18 - 315_964_800) * _SECOND_NS,
}


def write_bag(draw: Draw, walk: RecordedWalk, folder: Path) -> Variant:
    """Draw and write a bag."""
    kind = draw.one("bag1", "db3", "mcap")
    variant = Variant(kind, bag_path(folder, kind))
    plan = _plan(draw, walk, variant)
    lidar = {"clouds": _clouds, "packets": _raw_packets, "driver": _driver_messages}[plan.lidar]
    with RobotBag(variant.path, kind) as bag:
        write_transforms(draw, bag, plan, variant, start_ns=walk.clouds[0].t_ns)
        messages = [*lidar(draw, walk, plan, variant), *_imu(draw, walk, plan, variant)]
        messages += others(draw, walk, plan, variant)
        messages += odometry(draw, walk, plan, variant)
        write_unread(draw, bag, walk, variant)
        for t_ns, write in sorted(messages, key=lambda one: one[0]):
            write(bag, t_ns + plan.ahead_ns)
    if draw.chance(0.1):
        _cut(draw, storage_file(variant.path), variant)
    return variant


def _plan(draw: Draw, walk: RecordedWalk, variant: Variant) -> BagPlan:
    layout = draw_layout(draw)
    lidar = draw.one(
        *("velodyne", "/velodyne", "os_sensor", "base/laser 3d", ""),
        *("robot1/velodyne", "/robot_1/os_lidar"),
    )
    plan = BagPlan(
        layout,
        variant.kind,
        draw.one("/velodyne_points", "/points_raw", "/robot_1/os1/points", "/a/b/c/d_e/cloud"),
        lidar,
        draw.one(lidar, "imu_link", "/imu", f"{lidar}_imu".replace(" ", "_")),
        SE3.identity(),
    )
    plan.lidar = draw.one(*["clouds"] * 12, *["packets"] * 2, "driver")
    if plan.lidar != "clouds":
        return plan
    variant.say(f"{layout.driver}{', big-endian' * layout.big}{', organized' * layout.organized}")
    clock = draw.one("UTC", "UTC", "UTC", "UTC", "boot", *_CLOCKS)
    plan.offset_ns = 1234 * _SECOND_NS - walk.clouds[0].t_ns if clock == "boot" else _CLOCKS[clock]
    variant.offset_ns = plan.offset_ns
    if clock != "UTC":
        variant.say(f"clock {clock}")
    if draw.chance(0.15):
        variant.say("recorder an hour off")
        plan.ahead_ns = draw.one(-3600, 3600) * _SECOND_NS
    if draw.chance(0.15) and plan.layout.time and not plan.layout.organized:
        variant.say("four messages a revolution")
        plan.parts = 4
    _damage(draw, plan, variant, len(walk.clouds))
    if draw.chance(0.25) and plan.parts == 1 and not plan.layout.organized:
        add_lidar(draw, plan, variant)
    return plan


def _damage(draw: Draw, plan: BagPlan, variant: Variant, count: int) -> None:
    inner = range(2, count - 2)
    if draw.chance(0.15):
        first = draw.one(*inner)
        plan.skipped = set(range(first, min(first + draw.one(1, 3, 6), count - 1)))
        variant.say(f"{len(plan.skipped)} clouds missing")
        variant.exact = False
    for name, what, chance in (
        ("repeated", "written twice", 0.15),
        ("unstamped", "without stamps", 0.12),
        ("swapped", "out of order", 0.12),
        ("absurd", "with absurd times of points", 0.15),
    ):
        if draw.chance(chance) and (name != "absurd" or plan.layout.time):
            setattr(plan, name, set(draw.rows(len(inner), 2)))
            variant.say(f"clouds {what}")


# -- clouds


def _clouds(draw, walk, plan, variant):
    copy = draw_copy(draw, plan, variant)
    variant.timed = plan.layout.has_times
    variant.exact &= plan.layout.has_times or not plan.layout.organized
    for k, cloud in enumerate(walk.clouds):
        if k in plan.skipped:
            continue
        sensors = lidars_of(_as_measured(cloud, plan.T_lidar_as_measured), plan)
        variant.points += len(cloud.xyz) - 3 * (k in plan.absurd) * len(sensors)
        for topic, frame, measured in sensors:
            for recorded, message in _messages(k, measured, plan, place=(topic, frame)):
                yield recorded, message
                if copy is not None and topic == plan.topic:
                    yield from copy(k, recorded, message)


def _messages(k, cloud, plan, *, place):
    """The messages of a revolution, with their times of recording [ns]."""
    late_ns = 130_000_000 * (k in plan.swapped)
    for part, t0_ns in _parts(cloud, plan.parts):
        stamp_ns = t0_ns + plan.offset_ns + round(TURN_NS // plan.parts * plan.layout.stamp_at)
        points = points_of(part, plan.layout, stamp_ns=stamp_ns, t0_ns=cloud.t_ns + plan.offset_ns)
        if k in plan.absurd and t0_ns == cloud.t_ns:
            _make_absurd(points, plan.layout)
        recorded = t0_ns + TURN_NS // plan.parts + plan.late_ns + late_ns
        stamp_ns = 0 if k in plan.unstamped else stamp_ns
        for again in range(1 + (k in plan.repeated)):
            yield recorded + again, CloudMessage(*place, stamp_ns, points, plan.layout.dense)


def _raw_packets(draw, walk, plan, variant):
    """Packets of a Velodyne in messages of a revolution; clouds made of them may be beside."""
    sensor = draw.one("VLP-16", "VLP-16", "VLP-16 dual", "HDL-32E", "VLP-32C")
    variant.say(f"raw packets of a {sensor}")
    packets = packets_of(walk, sensor)
    variant.points = points_in(bytes(_HEADERS) + p.tobytes() for p in packets.payloads)
    message_ns = draw.one(TURN_NS, TURN_NS, TURN_NS // 10)
    number = (packets.t_ns - packets.t_ns[0]) // message_ns
    for k in range(int(number[-1]) + 1):
        rows = number == k
        t_ns = packets.t_ns[rows] + plan.offset_ns
        message = PacketsMessage(
            "/velodyne_packets", plan.lidar_frame, t_ns, packets.payloads[rows]
        )
        yield int(t_ns[-1]) - plan.offset_ns + plan.late_ns, message
    if draw.chance(0.4):
        variant.say("clouds beside them")
        points = variant.points
        yield from _clouds(draw, walk, plan, variant)
        variant.points = points


def _driver_messages(draw, walk, plan, variant):
    """A LiDAR in messages of its own driver, which recon4 does not read."""
    kind = draw.one(*DRIVER_MESSAGES)
    variant.say(f"LiDAR as {kind}")
    variant.refusal = "messages of a driver"
    variant.remedies = (kind.replace("/msg/", "/"), *DRIVER_MESSAGES[kind])
    for cloud in walk.clouds:
        yield cloud.t_ns + TURN_NS, DriverMessage("/lidar", kind, cloud.t_ns + plan.offset_ns)


def _as_measured(cloud: Cloud, T: SE3) -> Cloud:
    return replace(cloud, xyz=turned(cloud.xyz, T.R).astype(np.float32))


def _parts(cloud: Cloud, count: int) -> list[tuple[Cloud, int]]:
    """Pieces of a revolution of equal durations, with their times of start [ns]."""
    if count == 1:
        return [(cloud, cloud.t_ns)]
    number = np.minimum(cloud.dt_ns * count // TURN_NS, count - 1)
    return [
        (
            Cloud(
                cloud.t_ns,
                cloud.dt_ns[number == k],
                cloud.xyz[number == k],
                cloud.intensity[number == k],
                cloud.ring[number == k],
            ),
            cloud.t_ns + k * TURN_NS // count,
        )
        for k in range(count)
    ]


def _make_absurd(points, layout):
    name = next(n for n, _, _ in layout.fields if "time" in n or n in ("t", "t_us"))
    flat = points.reshape(-1)
    rows = np.flatnonzero(np.isfinite(flat["x"]))[[5, 50, 500]]
    dtype = flat[name].dtype
    flat[name][rows] = np.iinfo(dtype).max if dtype.kind in "ui" else 3e30


# -- IMU


def _imu(draw, walk, plan, variant):
    sound = bool(variant.must_say)  # what is said of the IMU's mount needs an IMU that is used
    if draw.chance(0.1) and not sound:
        variant.say("no IMU")
        return
    imu = walk.imu
    gyro = turned(imu.gyro_rad_s, plan.T_imu_lidar.R)
    accel = turned(imu.accel_m_s2, plan.T_imu_lidar.R)
    how = draw.one("", "", "", "in g", "zeros", "cov", "nan", "stamp 0", "unsorted", "other clock")
    how = "" if sound else how
    variant.samples = len(imu)
    offset_ns, absent = plan.offset_ns, ()
    if how:
        variant.say(f"IMU {how}")
    if how == "in g":
        accel = accel / 9.80665
    elif how in ("zeros", "cov"):
        accel = np.zeros_like(accel)
        absent = ("accel",) if how == "cov" else ()
    elif how == "other clock":
        offset_ns += 18 * _SECOND_NS
        variant.samples = 0
    bad = set(draw.rows(len(imu), 4))
    if how == "nan":
        gyro[sorted(bad)] = np.nan
    topic, frame = draw.one("/imu/data", "/os/imu", "/imu raw"), plan.imu_frame
    for k, t_ns in enumerate(imu.t_ns.tolist()):
        stamp_ns = 0 if how == "stamp 0" and k in bad else t_ns + offset_ns
        late_ns = 3_000_000 + 30_000_000 * (how == "unsorted" and k in bad)
        yield t_ns + late_ns, ImuMessage(topic, frame, stamp_ns, gyro[k], accel[k], absent)


def _cut(draw: Draw, path: Path, variant: Variant) -> None:
    size = path.stat().st_size
    ratio = draw.one(0.5, 0.9, 0.99)
    with path.open("r+b") as file:
        file.truncate(int(size * ratio))
    variant.say(f"cut at {ratio:.0%}")
    variant.points, variant.damaged = 0, True
    variant.samples = 0
    variant.exact = False
    variant.refusal = "a file that is cut may not be readable" if ratio < 0.9 else ""
