"""Bags with several topics of a kind, for tests."""

import numpy as np

from tests.builders import T0_NS, bag_path, noisy, room_cloud
from tests.robot_bags import RobotBag

STEP_NS = 100_000_000
FRAMES = 20


def write(folder, *sources, kind="mcap"):
    """A bag of two seconds; each source writes its messages of each tenth of a second."""
    path = bag_path(folder, kind)
    with RobotBag(path, kind) as bag:
        for k in range(FRAMES):
            for source in sources:
                source(bag, T0_NS + k * STEP_NS, k)
    return path


def lidar(topic="/points", frame="os_lidar", **fields):
    def add(bag, t_ns, k):
        bag.frame = frame
        bag.cloud(topic, t_ns, {**room_cloud(), **fields})

    return add


def cloud(topic, frame, table, *, late_ns=0):
    def add(bag, t_ns, k):
        bag.frame = frame
        bag.cloud(topic, t_ns + late_ns, table)

    return add


def plain(points=2000, *, columns=("x", "y", "z", "intensity")):
    table = room_cloud()
    return {name: table[name][:points] for name in columns}


def camera():
    """Points as of a depth camera in its optical frame: z forward."""
    v, u = np.mgrid[-20:20, -30:30] / 40.0
    z = np.full(u.shape, 2.0)
    axes = {"x": (u * z), "y": (v * z), "z": z}
    table = {name: axis.astype(np.float32).ravel() for name, axis in axes.items()}
    return table | {"rgb": np.zeros(u.size, np.float32)}


def imu(topic, frame, *, rate_hz=100, turns=True, forces=True, gravity=9.81, until=FRAMES):
    count = rate_hz // 10

    def add(bag, t_ns, k):
        bag.frame = frame
        for i in range(count if k < until else 0):
            n = k * count + i
            gyro = noisy((0.0, 0.0, 0.1), n) if turns else (0.0, 0.0, 0.0)
            accel = noisy((0.0, 0.0, gravity), n) if forces else (0.0, 0.0, 0.0)
            bag.imu(topic, t_ns + i * STEP_NS // count, gyro, accel)

    return add


def fix(topic, *, status=0, moves=1e-7, frame="gps"):
    def add(bag, t_ns, k):
        bag.frame = frame
        bag.fix(topic, t_ns, 50.0 + moves * k, 14.0, 300.0, status=status)

    return add


def scan(topic, *, view_deg=270.0, far_m=3.0, frame="laser"):
    beams = 90
    step = np.deg2rad(view_deg) / beams

    def add(bag, t_ns, k):
        bag.frame = frame
        message = bag.make(
            "sensor_msgs/msg/LaserScan",
            header=bag.header(t_ns),
            angle_min=-step * beams / 2,
            angle_max=step * beams / 2,
            angle_increment=step,
            time_increment=0.0,
            scan_time=0.1,
            range_min=0.1,
            range_max=10.0,
            ranges=np.full(beams, far_m, np.float32) + np.float32(0.01 * (k % 3)),
            intensities=np.zeros(0, np.float32),
        )
        bag.write(topic, "sensor_msgs/msg/LaserScan", t_ns, message)

    return add
