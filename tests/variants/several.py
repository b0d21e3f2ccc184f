"""Several LiDARs in one bag, and copies of what one of them measured."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from tests.robot_bags import mount
from tests.variants.messages import CloudMessage
from tests.variants.plan import BagPlan, SecondLidar
from tests.variants.variant import Draw, Variant
from tests.variants.walk import Cloud, turned

_T_BASE_COPY = mount(0.1, 0.0, 0.3, pitch=10.0)
Copy = Callable[[int, int, CloudMessage], Iterator[tuple[int, CloudMessage]]]
"""Number of the cloud, time of recording and message -> copies with their times of recording."""


def add_lidar(draw: Draw, plan: BagPlan, variant: Variant) -> None:
    """Give the robot a second LiDAR, mounted as tf or a rig file says, or as nobody says."""
    if plan.lidar_frame.strip("/") == "" or plan.imu_frame == plan.lidar_frame:
        return
    T_first_second = draw.one(
        mount(0.2, -0.1, 0.3, pitch=90.0), mount(0.0, 0.3, 0.0, yaw=180.0), mount(-0.3, roll=30.0)
    )
    stated = draw.one("by tf", "by tf", "by a rig file", "by a rig file against tf", "by nobody")
    plan.second = SecondLidar("/rear/points", "rear_lidar", T_first_second, stated)
    variant.say(f"two LiDARs, mounts stated {stated}")


def lidars_of(cloud: Cloud, plan: BagPlan) -> list[tuple[str, str, Cloud]]:
    """Topic, frame and cloud of each LiDAR: the first has every second beam if there are two."""
    second = plan.second
    if second is None:
        return [(plan.topic, plan.lidar_frame, cloud)]
    even = cloud.ring % 2 == 0
    T = second.T_first_second.inverse()
    others = _rows(cloud, ~even)
    moved = (turned(others.xyz, T.R) + T.t).astype(np.float32)
    return [
        (plan.topic, plan.lidar_frame, _rows(cloud, even)),
        (second.topic, second.frame, replace(others, xyz=moved)),
    ]


def _rows(cloud: Cloud, rows: np.ndarray) -> Cloud:
    return Cloud(
        cloud.t_ns, cloud.dt_ns[rows], cloud.xyz[rows], cloud.intensity[rows], cloud.ring[rows]
    )


# -- copies


def draw_copy(draw: Draw, plan: BagPlan, variant: Variant) -> Copy | None:
    """A topic made of that of the first LiDAR; None = there is none."""
    copies: dict[str, Copy] = {
        "relayed": _relayed,
        "every second cloud": _throttled,
        "every second point": _thinned,
        "only x y z": _plain,
        "near points": _near,
        "in the frame of the robot": _in_robot,
    }
    if not draw.chance(0.3) or plan.layout.organized:
        return None
    how = draw.one(*copies)
    variant.say(f"a copy of the LiDAR, {how}")
    return copies[how]


def _in_robot(k, recorded, message):
    points = message.points.copy()
    xyz = np.column_stack([points[axis] for axis in "xyz"])
    moved = turned(xyz, _T_BASE_COPY.R) + _T_BASE_COPY.t
    for axis, values in zip("xyz", moved.T, strict=True):
        points[axis] = values
    yield (
        recorded + 3_000_000,
        replace(_named(message, "base", points), frame="base_link"),
    )


def _named(message: CloudMessage, name: str, points: np.ndarray) -> CloudMessage:
    return replace(message, topic=f"{message.topic}_{name}", points=points)


def _relayed(k, recorded, message):
    yield recorded + 1_000_000, _named(message, "relay", message.points)


def _throttled(k, recorded, message):
    if k % 2 == 0:
        yield recorded + 1_000_000, _named(message, "throttle", message.points)


def _thinned(k, recorded, message):
    yield recorded + 3_000_000, _named(message, "filtered", message.points[::2])


def _plain(k, recorded, message):
    points = message.points[list("xyz")].copy()
    yield recorded + 3_000_000, _named(message, "xyz", points)


def _near(k, recorded, message):
    p = message.points
    near = np.hypot(p["x"], p["y"]) < 4.0
    yield recorded + 3_000_000, _named(message, "crop", p[near])
