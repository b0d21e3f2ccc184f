"""Bags of robots: messages with names of frames, transforms and a description. Deterministic."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from recon4.geometry.se3 import SE3
from tests.builders import T0_NS, Bag, bag_path, noisy, room_cloud

TF2, TF1 = "tf2_msgs/msg/TFMessage", "tf/msg/tfMessage"
MESSAGE = "geometry_msgs/TransformStamped[] transforms\n"


class RobotBag(Bag):
    """Writes messages in the frame ``frame``, and transforms."""

    def __init__(self, path: Path, kind: str) -> None:
        from rosbags.typesys import get_types_from_msg

        super().__init__(path, kind)
        for name in (TF1, TF2):
            if name not in self.store.types:
                self.store.register(get_types_from_msg(MESSAGE, name))

    def tf(self, *transforms, topic="/tf_static", t_ns=T0_NS, kind=TF2):
        """Write transforms: parent, child and mount, or numbers x y z qx qy qz qw."""
        self.write(topic, kind, int(t_ns), self.stated(transforms, t_ns=t_ns, kind=kind))

    def stated(self, transforms, *, t_ns=T0_NS, kind=TF2):
        """A message of transforms."""
        listed = [self._transform(int(t_ns), *one) for one in transforms]
        return self.make(kind, transforms=listed)

    def description(self, urdf, *, topic="/robot_description", t_ns=T0_NS):
        """Write the description of a robot."""
        self.write(topic, "std_msgs/msg/String", t_ns, self.make("std_msgs/msg/String", data=urdf))

    def positions(self, topic, t_ns, stated):
        """Write positions of joints: name -> rad or m."""
        kind = "sensor_msgs/msg/JointState"
        message = self.make(
            kind,
            header=self.header(t_ns, ""),
            name=list(stated),
            position=np.array([*stated.values()], np.float64),
            velocity=np.zeros(0),
            effort=np.zeros(0),
        )
        self.write(topic, kind, int(t_ns), message)

    def laser(self, topic, t_ns, ranges, *, angles):
        """Write a scan of a 2-D laser with a beam at each angle [rad]; NaN = no return."""
        message = self.make(
            "sensor_msgs/msg/LaserScan",
            header=self.header(t_ns),
            angle_min=float(angles[0]),
            angle_max=float(angles[-1]),
            angle_increment=float(angles[1] - angles[0]),
            time_increment=0.0,
            scan_time=0.0,
            range_min=0.1,
            range_max=30.0,
            ranges=np.where(np.isnan(ranges), np.inf, ranges).astype(np.float32),
            intensities=np.zeros(0, np.float32),
        )
        self.write(topic, "sensor_msgs/msg/LaserScan", int(t_ns), message)

    def walk(self, topic, t_ns, pose):
        """Write planar odometry: x [m], y [m], yaw [rad]."""
        x, y, yaw = (float(v) for v in pose)
        turn = (0.0, 0.0, np.sin(yaw / 2), np.cos(yaw / 2))
        message = self.make(
            "nav_msgs/msg/Odometry",
            header=self.header(t_ns, "odom"),
            child_frame_id=self.frame,
            pose=self.make(
                "geometry_msgs/msg/PoseWithCovariance",
                pose=self.make(
                    "geometry_msgs/msg/Pose",
                    position=self.make("geometry_msgs/msg/Point", x=x, y=y, z=0.0),
                    orientation=self._quaternion(turn),
                ),
                covariance=np.zeros(36),
            ),
            twist=self.make(
                "geometry_msgs/msg/TwistWithCovariance",
                twist=self.make(
                    "geometry_msgs/msg/Twist",
                    linear=self.make("geometry_msgs/msg/Vector3", x=0.0, y=0.0, z=0.0),
                    angular=self.make("geometry_msgs/msg/Vector3", x=0.0, y=0.0, z=0.0),
                ),
                covariance=np.zeros(36),
            ),
        )
        self.write(topic, "nav_msgs/msg/Odometry", int(t_ns), message)

    def _transform(self, t_ns, parent, child, T):
        numbers = (*T.t, *T.quat_xyzw()) if isinstance(T, SE3) else T
        x, y, z, *quat = (float(v) for v in numbers)
        return self.make(
            "geometry_msgs/msg/TransformStamped",
            header=self.header(t_ns, parent),
            child_frame_id=child,
            transform=self.make(
                "geometry_msgs/msg/Transform",
                translation=self.make("geometry_msgs/msg/Vector3", x=x, y=y, z=z),
                rotation=self._quaternion(quat),
            ),
        )

    def _quaternion(self, quat):
        x, y, z, w = (float(v) for v in quat)
        return self.make("geometry_msgs/msg/Quaternion", x=x, y=y, z=z, w=w)


def mount(x=0.0, y=0.0, z=0.0, *, roll=0.0, pitch=0.0, yaw=0.0):
    """A mount: position [m] and angles [°]."""
    return SE3.from_rpy(*np.deg2rad([roll, pitch, yaw]), t=[x, y, z])


def write_walk(folder, transforms=(), *, kind="db3", lidars=("os_lidar",), seconds=1.0, **frames):
    """A second of clouds, IMU samples and positions, with static transforms.

    Args:
        folder: Where the bag goes.
        transforms: Parent, child and mount of each.
        kind: Of the bag.
        lidars: Frame of each LiDAR; its topic is ``/<frame>/points``.
        seconds: Duration.
        frames: Frames ``imu`` and ``gnss`` of the samples; without, there are none.
    """
    path = bag_path(folder, kind)
    with RobotBag(path, kind) as bag:
        if transforms:
            bag.tf(*transforms)
        for k in range(round(10 * seconds)):
            t_ns = T0_NS + k * 100_000_000
            for lidar in lidars:
                bag.frame = lidar
                bag.cloud(f"/{lidar.strip('/')}/points", t_ns, room_cloud())
            bag.frame = frames.get("imu", "")
            for i in range(10 * ("imu" in frames)):
                gyro, accel = (noisy((0.0, 0.0, z), 10 * k + i) for z in (0.0, 9.81))
                bag.imu("/imu", t_ns + i * 10_000_000, gyro, accel)
            if "gnss" in frames:
                bag.frame = frames["gnss"]
                bag.fix("/fix", t_ns, 50.0 + 1e-7 * k, 14.0, 300.0)
    return path
