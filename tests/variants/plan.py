"""What goes into a bag, and how its sensors are mounted as its transforms say."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from recon4.geometry.se3 import SE3
from recon4.model.rig import Rig, Sensor
from recon4.recording.rigs.choice import Stream, single_rig
from tests.robot_bags import TF1, TF2, RobotBag, mount
from tests.variants.layouts import Layout
from tests.variants.variant import Draw, Variant


@dataclass(slots=True)
class SecondLidar:
    """Another LiDAR of the same robot, which has every second beam."""

    topic: str
    frame: str
    T_first_second: SE3
    stated: str
    """Who states the mounts: ``by tf``, ``by a rig file``, both or ``by nobody``."""


@dataclass(slots=True)
class BagPlan:
    """What goes into a bag."""

    layout: Layout
    kind: str
    topic: str
    lidar_frame: str
    imu_frame: str
    T_imu_lidar: SE3
    lidar: str = "clouds"
    """``clouds``, ``packets`` of a Velodyne or messages of another ``driver``."""
    T_lidar_as_measured: SE3 = field(default_factory=SE3.identity)
    """Turns the points of the walk to those of a LiDAR that is mounted otherwise."""
    second: SecondLidar | None = None
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

    @property
    def upside_down(self) -> bool:
        """Whether the LiDAR hangs."""
        return bool(self.T_lidar_as_measured.R[2, 2] < 0.0)

    @property
    def named(self) -> bool:
        """Whether LiDAR and IMU have frames of their own."""
        return bool(self.lidar_frame.strip("/")) and self.imu_frame != self.lidar_frame


_ANGLES = {
    "turned": {"yaw": 90.0},
    "upside down": {"roll": 180.0},
    "urdf": {"yaw": -90.0},
    "contradictory": {"yaw": 90.0},
    "of another prefix": {},
}


def write_transforms(
    draw: Draw, bag: RobotBag, plan: BagPlan, variant: Variant, *, start_ns: int
) -> None:
    """How the sensors are mounted: stated by tf, a rig file or nobody, and so are their samples."""
    how = draw.one(*_choices(plan)) if plan.named else "none"
    if how == "none":
        return
    if plan.second is not None and plan.second.stated == "by nobody":
        variant.refusal = "nobody says how the LiDARs are mounted"
        variant.remedies = ("--set ingest.lidar_topic=", "[[sensor]]", plan.second.topic)
        return
    variant.say(f"tf: IMU {how}")
    stated = _stated(draw, plan, variant, how=how)
    if plan.second is not None and plan.second.stated != "by tf":
        variant.rig = _rig(plan, stated)
        if plan.second.stated == "by a rig file":
            return
        frame, T = stated[2]
        stated[2] = frame, T @ mount(yaw=20.0)
        variant.must_say.append("differ by")
    if draw.chance(0.3):
        variant.say("recorded at time 0")
        start_ns = 1
    base = draw.one("base_link", _base_of(plan.lidar_frame))
    if how == "urdf":
        bag.description(_urdf(base, stated), t_ns=start_ns)
        return
    if how == "of another prefix":
        stated = [(f"robot1/{frame}", T) for frame, T in stated]
        base = "robot1/base_link"
        variant.exact &= not plan.upside_down
    if how == "contradictory":
        wrong = [(stated[1][0], mount())]
        variant.must_say.append("contradict")
        _state(draw, bag, variant, start_ns=start_ns, base=base, stated=wrong)
    _state(draw, bag, variant, start_ns=start_ns + 9, base=base, stated=stated)


def _choices(plan: BagPlan) -> tuple[str, ...]:
    if plan.second is not None:
        return ("identity", "turned", "upside down", "urdf")
    choices = ("none", "identity", "turned", "upside down", "urdf", "contradictory")
    return choices + ("of another prefix",) * ("/" not in plan.lidar_frame.strip("/"))


def _stated(draw: Draw, plan: BagPlan, variant: Variant, *, how: str) -> list[tuple[str, SE3]]:
    """Frame and mount on the robot of LiDAR, IMU and second LiDAR; sets how they measure."""
    # The body of several LiDARs is the robot, and the truth is that of the first LiDAR.
    height_m = 0.3 if plan.second is None else 0.0
    T_base_lidar = mount(0.0, 0.0, height_m)
    T_base_imu = mount(0.0, 0.0, height_m, **_ANGLES.get(how, {}))
    plan.T_imu_lidar = T_base_imu.inverse() @ T_base_lidar
    if draw.chance(0.25) and plan.lidar == "clouds":
        variant.say("LiDAR upside down")
        T_base_lidar = mount(0.0, 0.0, height_m, roll=180.0)
        plan.T_lidar_as_measured = T_base_lidar.inverse() @ mount(0.0, 0.0, height_m)
    stated = [(plan.lidar_frame.strip("/"), T_base_lidar), (plan.imu_frame.strip("/"), T_base_imu)]
    if plan.second is not None:
        stated.append((plan.second.frame, T_base_lidar @ plan.second.T_first_second))
    return stated


def _rig(plan: BagPlan, stated: list[tuple[str, SE3]]) -> Rig:
    """A rig file with the mounts on the robot."""
    assert plan.second is not None
    sensors = (
        Sensor(name="front", model="generic", T_body_sensor=stated[0][1], topic=plan.topic),
        Sensor(name="rear", model="generic", T_body_sensor=stated[2][1], topic=plan.second.topic),
    )
    plain = single_rig(Stream(plan.topic, "generic"))
    return replace(plain, name="my rig", sensors=sensors, T_body_imu=stated[1][1])


def _base_of(lidar_frame: str) -> str:
    """``robot1/base_link`` for ``robot1/velodyne``: a prefix is that of the whole robot."""
    prefix = lidar_frame.strip("/").rpartition("/")[0]
    return f"{prefix}/base_link".strip("/")


def _state(draw, bag, variant, *, start_ns, base, stated):
    kind = TF1 if bag.ros1 and draw.chance(0.5) else TF2
    slash = "/" * draw.chance(0.3)
    transforms = [(f"{slash}{base}", f"{slash}{frame}", T) for frame, T in stated]
    if draw.chance(0.2) and not variant.must_say:
        variant.say("on /tf")
        for k in range(5):
            bag.tf(*transforms, topic="/tf", kind=kind, t_ns=start_ns + k)
    else:
        bag.tf(*transforms, kind=kind, t_ns=start_ns)


def _urdf(base: str, stated: list[tuple[str, SE3]]) -> str:
    joint = (
        '<joint name="{name}" type="fixed"><parent link="{base}"/><child link="{name}"/>'
        '<origin xyz="0 0 1" rpy="{roll} 0 {yaw}"/></joint><link name="{name}"/>'
    )
    joints = ""
    for name, T in stated:
        roll, _, yaw = T.rpy()
        joints += joint.format(base=base, name=name, roll=roll, yaw=yaw)
    return f'<robot name="r"><link name="{base}"/>{joints}</robot>'
