"""What else a robot records beside its LiDAR and its IMU."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tests.robot_bags import RobotBag
from tests.variants.layouts import points_of
from tests.variants.messages import CloudMessage, Fix, ImuMessage, OdometryMessage
from tests.variants.variant import Draw, Variant
from tests.variants.walk import TURN_NS, Cloud, RecordedWalk


def write_unread(draw: Draw, bag: RobotBag, walk: RecordedWalk, variant: Variant) -> None:
    """Topics that are not read, and one without messages."""
    if draw.chance(0.3):
        variant.say("text and an empty topic")
        text = bag.make("std_msgs/msg/String", data="battery 93 %")
        for k in range(5):
            bag.write("/status/…", "std_msgs/msg/String", walk.clouds[k].t_ns, text)
        if "/empty" not in bag.connections:
            bag.writer.add_connection("/empty", "sensor_msgs/msg/Imu", typestore=bag.store)


def others(draw, walk, plan, variant):
    """Messages of other sources, with their times of recording [ns]."""
    found = []
    end_ns = walk.clouds[-1].t_ns
    if draw.chance(0.25):
        variant.say("registered cloud in map")
        plain = replace(plan.layout, organized=False)
        for cloud in walk.clouds[::2]:
            points = points_of(
                _moved(cloud, walk),
                plain,
                stamp_ns=cloud.t_ns + plan.offset_ns,
                t0_ns=cloud.t_ns + plan.offset_ns,
            )
            message = CloudMessage("/cloud_registered", "map", cloud.t_ns + plan.offset_ns, points)
            found.append((cloud.t_ns + 2 * TURN_NS, message))
    if draw.chance(0.25):
        variant.say("depth camera")
        for t_ns in range(walk.clouds[0].t_ns, end_ns, 66_000_000):
            message = CloudMessage(
                "/camera/depth/points",
                "camera_depth_optical_frame",
                t_ns + plan.offset_ns,
                _depth_points(),
            )
            found.append((t_ns + 20_000_000, message))
    if draw.chance(0.25):
        variant.say("gyroscope of a camera")
        for k, t_ns in enumerate(range(walk.clouds[0].t_ns, end_ns, 4_000_000)):
            gyro = np.array([0.01, -0.02, 0.03]) + 0.001 * np.sin(k * np.array([1.0, 2.0, 3.0]))
            stamp_ns = t_ns + plan.offset_ns
            message = ImuMessage(
                "/camera/imu", "camera_imu_optical_frame", stamp_ns, gyro, np.zeros(3)
            )
            found.append((t_ns + 3_000_000, message))
    if draw.chance(0.25):
        status = draw.one(-1, 0, 2)
        place = draw.one((0.0, 0.0, 0.0), (49.2, 16.6, 250.0), (np.nan, np.nan, np.nan))
        variant.say(f"GNSS of status {status} at {place[0]:g}")
        found += [
            (t_ns + 5_000_000, Fix(t_ns + plan.offset_ns, place, status))
            for t_ns in range(walk.clouds[0].t_ns, end_ns, 200_000_000)
        ]
    return found


def odometry(draw, walk, plan, variant):
    """Odometry of wheels or of a program, which is kept for comparison only."""
    if not draw.chance(0.35):
        return []
    frame = draw.one("odom", "odom", "map", "camera_init", "", plan.lidar_frame, "base_link")
    topics = draw.one(("/odom",), ("/odom", "/lio/odometry"))
    child = draw.one("", frame) if frame == plan.lidar_frame else "base_link"
    standing, unstamped = draw.chance(0.2), draw.chance(0.15)
    variant.say(f"odometry {' and '.join(topics)} in {frame!r}")
    variant.say("which never changes") if standing else None
    variant.say("without stamps") if unstamped else None
    return [
        (
            t_ns + 2_000_000,
            OdometryMessage(
                topic,
                frame,
                0 if unstamped else t_ns + plan.offset_ns,
                0.0 if standing else 0.02 * k,
                child,
            ),
        )
        for topic in topics
        for k, t_ns in enumerate(range(walk.clouds[0].t_ns, walk.clouds[-1].t_ns, 50_000_000))
    ]


def _moved(cloud: Cloud, walk: RecordedWalk) -> Cloud:
    T = walk.truth.at(np.array([cloud.t_ns + TURN_NS // 2]))[0]
    return replace(cloud, xyz=(cloud.xyz @ T.R.T + T.t).astype(np.float32))


def _depth_points() -> np.ndarray:
    rows, columns = np.mgrid[0:24, 0:32]
    points = np.zeros((24, 32), [("x", "<f4"), ("y", "<f4"), ("z", "<f4"), ("rgb", "<f4")])
    points["x"], points["y"], points["z"] = (columns - 16) / 16, (rows - 12) / 16, 2.0
    return points
