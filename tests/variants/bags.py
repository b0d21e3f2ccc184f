"""Bags of a LiDAR with an IMU, and of whatever else a robot records."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from recon4.geometry.se3 import SE3
from tests.builders import bag_path, storage_file
from tests.robot_bags import TF1, TF2, RobotBag, mount
from tests.variants.companions import others, write_unread
from tests.variants.layouts import Layout, draw_layout, points_of
from tests.variants.messages import CloudMessage, ImuMessage
from tests.variants.variant import Draw, Variant
from tests.variants.walk import TURN_NS, Cloud, RecordedWalk, turned

_SECOND_NS = 1_000_000_000
_CLOCKS = {
    "UTC": 0,
    "TAI": 37 * _SECOND_NS,
    "GPS time since 1980": (18 - 315_964_800) * _SECOND_NS,
}


@dataclass(slots=True)
class BagPlan:
    """What goes into a bag."""

    layout: Layout
    kind: str
    topic: str
    lidar_frame: str
    imu_frame: str
    T_imu_lidar: SE3
    T_lidar_as_measured: SE3 = field(default_factory=SE3.identity)
    """Turns the points of the walk to those of a LiDAR that is mounted otherwise."""
    parts: int = 1
    """Messages of a revolution."""
    offset_ns: int = 0
    """Clock of the stamps minus UTC."""
    late_ns: int = 40_000_000
    """From the end of a cloud to its recording."""
    skipped: set[int] = field(default_factory=set)
    """Clouds that were not recorded."""
    repeated: set[int] = field(default_factory=set)
    unstamped: set[int] = field(default_factory=set)
    swapped: set[int] = field(default_factory=set)
    """Clouds recorded behind the next one."""
    ahead_ns: int = 0
    """Clock of the recorder minus UTC."""
    absurd: set[int] = field(default_factory=set)
    """Clouds with three points of absurd times."""


def write_bag(draw: Draw, walk: RecordedWalk, folder: Path) -> Variant:
    """Draw and write a bag."""
    kind = draw.one("bag1", "db3", "mcap")
    variant = Variant(kind, bag_path(folder, kind))
    plan = _plan(draw, walk, variant)
    with RobotBag(variant.path, kind) as bag:
        _transforms(draw, bag, plan, variant, start_ns=walk.clouds[0].t_ns)
        messages = [*_clouds(draw, walk, plan, variant), *_imu(draw, walk, plan, variant)]
        messages += others(draw, walk, plan, variant)
        write_unread(draw, bag, walk, variant)
        for t_ns, write in sorted(messages, key=lambda one: one[0]):
            write(bag, t_ns + plan.ahead_ns)
    if draw.chance(0.1):
        _cut(draw, storage_file(variant.path), variant)
    return variant


def _plan(draw: Draw, walk: RecordedWalk, variant: Variant) -> BagPlan:
    layout = draw_layout(draw)
    lidar = draw.one("velodyne", "/velodyne", "os_sensor", "base/laser 3d", "")
    plan = BagPlan(
        layout,
        variant.kind,
        draw.one("/velodyne_points", "/points_raw", "/robot_1/os1/points", "/a/b/c/d_e/cloud"),
        lidar,
        draw.one(lidar, "imu_link", "/imu"),
        SE3.identity(),
    )
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


# -- transforms


def _transforms(
    draw: Draw, bag: RobotBag, plan: BagPlan, variant: Variant, *, start_ns: int
) -> None:
    """How the IMU is mounted: stated by tf or not, and so are its samples."""
    named = bool(plan.lidar_frame.strip("/")) and plan.imu_frame != plan.lidar_frame
    how = draw.one("none", "identity", "turned", "upside down", "urdf") if named else "none"
    if how == "none":
        return
    variant.say(f"tf: IMU {how}")
    T_base_lidar = mount(0.0, 0.0, 1.0)
    angles = {"turned": {"yaw": 90.0}, "upside down": {"roll": 180.0}, "urdf": {"yaw": -90.0}}
    T_base_imu = mount(0.0, 0.0, 1.0, **angles.get(how, {}))
    plan.T_imu_lidar = T_base_imu.inverse() @ T_base_lidar
    lidar, imu = plan.lidar_frame.strip("/"), plan.imu_frame.strip("/")
    if draw.chance(0.25):
        variant.say("LiDAR upside down")
        T_base_lidar = mount(0.0, 0.0, 1.0, roll=180.0)
        plan.T_lidar_as_measured = T_base_lidar.inverse() @ mount(0.0, 0.0, 1.0)
    if draw.chance(0.3):
        variant.say("recorded at time 0")
        start_ns = 1
    if how == "urdf":
        roll = np.pi * (T_base_lidar.R[2, 2] < 0.0)
        bag.description(_urdf(lidar, imu, roll), t_ns=start_ns)
        return
    kind = TF1 if bag.ros1 and draw.chance(0.5) else TF2
    slash = "/" * draw.chance(0.3)
    both = (
        (f"{slash}base_link", f"{slash}{lidar}", T_base_lidar),
        (f"{slash}base_link", f"{slash}{imu}", T_base_imu),
    )
    if draw.chance(0.2):
        variant.say("on /tf")
        for k in range(5):
            bag.tf(*both, topic="/tf", kind=kind, t_ns=start_ns + k)
    else:
        bag.tf(*both, kind=kind, t_ns=start_ns)


def _urdf(lidar: str, imu: str, roll: float) -> str:
    joint = (
        '<joint name="{name}" type="fixed"><parent link="base_link"/><child link="{name}"/>'
        '<origin xyz="0 0 1" rpy="{roll} 0 {yaw}"/></joint><link name="{name}"/>'
    )
    joints = joint.format(name=lidar, roll=roll, yaw=0)
    joints += joint.format(name=imu, roll=0, yaw=-np.pi / 2)
    return f'<robot name="r"><link name="base_link"/>{joints}</robot>'


# -- clouds


def _clouds(draw, walk, plan, variant):
    for k, cloud in enumerate(walk.clouds):
        if k in plan.skipped:
            continue
        variant.points += len(cloud.xyz) - 3 * (k in plan.absurd)
        late_ns = 130_000_000 * (k in plan.swapped)
        for part, t0_ns in _parts(_as_measured(cloud, plan.T_lidar_as_measured), plan.parts):
            at_end = plan.layout.time == "s before the stamp"
            stamp_ns = t0_ns + plan.offset_ns + TURN_NS // plan.parts * at_end
            points = points_of(
                part, plan.layout, stamp_ns=stamp_ns, t0_ns=cloud.t_ns + plan.offset_ns
            )
            if k in plan.absurd and t0_ns == cloud.t_ns:
                _make_absurd(points, plan.layout)
            recorded = t0_ns + TURN_NS // plan.parts + plan.late_ns + late_ns
            stamp_ns = 0 if k in plan.unstamped else stamp_ns
            for again in range(1 + (k in plan.repeated)):
                message = CloudMessage(
                    plan.topic, plan.lidar_frame, stamp_ns, points, plan.layout.dense
                )
                yield recorded + again, message


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
    flat[name][rows] = np.iinfo(flat[name].dtype).max if flat[name].dtype.kind == "u" else 3e30


# -- IMU


def _imu(draw, walk, plan, variant):
    if draw.chance(0.1):
        variant.say("no IMU")
        return
    imu = walk.imu
    gyro = turned(imu.gyro_rad_s, plan.T_imu_lidar.R)
    accel = turned(imu.accel_m_s2, plan.T_imu_lidar.R)
    how = draw.one("", "", "", "in g", "zeros", "cov", "nan", "stamp 0", "unsorted", "other clock")
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
