"""Sensors on joints that move: where each is in the part that carries the joint, by time.

A bag states a joint that moves in the transforms of ``/tf``, or by positions of a joint of the
robot description, each with its own time. Every point is placed by the pose of its own time. So the
frame that carries the joint, which does not move with it, is the frame of the sensor for everything
that follows.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.distinct import distinct
from recon4.geometry.se3 import SE3, Array, so3_log
from recon4.kernels.imu import place_points
from recon4.model.derived_kinds import DerivedKind
from recon4.model.finding import Value
from recon4.model.trajectory import Times, Trajectory
from recon4.recording.assembly.shots import Shots
from recon4.recording.formats.bags import Bag
from recon4.recording.mounts.frame_graph import FrameGraph, MovingJoint
from recon4.recording.mounts.joint_poses import read_joint_poses
from recon4.recording.mounts.tuning import JOINTS
from recon4.recording.report import ImportReport


@dataclass(frozen=True, slots=True, eq=False)
class MovingMount:
    """Mount of a sensor on a joint that moves, or on several."""

    base: str
    """Frame of the part that carries the joint."""
    T_base_sensor: Trajectory
    """Poses of the sensor."""
    angle_rad: Array
    """How far it has turned about the axis of the joint at each pose, continuous [rad], (K,)."""
    joints: str
    """Names of the frames that the joints connect."""
    source: str
    """Topic that states the first joint."""

    @property
    def values(self) -> dict[str, Value]:
        """Joint, range, number of poses, as values of `DerivedKind.MOUNT_MOVES`."""
        return {
            "base": self.base,
            "joints": self.joints,
            "turned_rad": float(np.ptp(self.angle_rad)),
            "source": self.source,
            "poses": len(self.T_base_sensor),
            "seconds": float(np.ptp(self.T_base_sensor.t_ns)) * 1e-9,
        }

    @property
    def text(self) -> str:
        """The same for messages of errors."""
        seconds = float(np.ptp(self.T_base_sensor.t_ns)) * 1e-9
        return (
            f"{self.joints} turns by {np.rad2deg(np.ptp(self.angle_rad)):.0f}° ({self.source}, "
            f"{len(self.T_base_sensor)} poses in {seconds:.1f} s)"
        )

    def known(self, t_ns: Times) -> NDArray[np.bool_]:
        """Whether the pose is known at each time, (N,)."""
        poses = self.T_base_sensor
        left = np.clip(np.searchsorted(poses.t_ns, t_ns, side="right") - 1, 0, len(poses) - 2)
        beyond_ns = JOINTS.beyond_ns
        inside = (t_ns >= poses.t_ns[0] - beyond_ns) & (t_ns <= poses.t_ns[-1] + beyond_ns)
        return np.asarray(inside & self._sure_steps()[left])

    def _sure_steps(self) -> NDArray[np.bool_]:
        """Whether the pose between two poses is known, (K - 1,)."""
        poses, T = self.T_base_sensor, self.T_base_sensor.T_a_b
        stands_rad, stands_m = JOINTS.stands
        moved = np.linalg.norm(np.diff(T.t, axis=0), axis=1) > stands_m
        turned = np.abs(np.diff(self.angle_rad)) > stands_rad
        return np.asarray(np.diff(poses.t_ns) <= JOINTS.longest_ns) | ~(moved | turned)

    def place(self, shots: Shots) -> tuple[Shots, int]:
        """The points in the frame of the base, and the number of those whose pose is unknown."""
        rows = np.flatnonzero(self.known(shots.t_ns))
        poses, zero_ns = self.T_base_sensor, int(self.T_base_sensor.t_ns[0])
        xyz = place_points(
            1e-9 * (poses.t_ns - zero_ns).astype(np.float64),
            np.ascontiguousarray(poses.T_a_b.R),
            np.ascontiguousarray(poses.T_a_b.t),
            1e-9 * (shots.t_ns[rows] - zero_ns).astype(np.float64),
            shots.xyz[rows].astype(np.float64),
        )
        placed = replace(
            shots,
            t_ns=shots.t_ns[rows],
            xyz=xyz.astype(np.float32),
            intensity=shots.intensity[rows],
            ring=shots.ring[rows],
            echo=shots.echo[rows],
        )
        return placed, len(shots) - len(rows)

    def angle_at(self, t_ns: int) -> float:
        """How far the joint has turned at a time [rad]."""
        t_s = (self.T_base_sensor.t_ns - t_ns) * 1e-9
        return float(np.interp(0.0, t_s, self.angle_rad))


def moving_mount(
    bag: Bag, graph: FrameGraph, frame: str, *, report: ImportReport
) -> MovingMount | None:
    """The mount of a frame on the joints above it; None = none moves, or it is no joint.

    Args:
        bag: An open bag.
        graph: Its frames.
        frame: Of a sensor.
        report: Receives what was read, and counts what is left out.
    """
    joints = graph.joints_above(frame)
    if not joints:
        return None
    poses = read_joint_poses(bag, joints, report)
    for joint in joints:
        why = _why_no_joint(poses[joint.child])
        if why:
            report.derive(
                DerivedKind.JOINT_NONE,
                parent=joint.parent,
                child=joint.child,
                source=joint.source,
                **why,
            )
            return None
    T_base_sensor = _composed(graph, joints, frame, poses=poses)
    if T_base_sensor is None:
        return None
    angle_rad = _turned_rad(T_base_sensor.T_a_b)
    names = ", ".join(f"{j.parent} -> {j.child}" for j in joints)
    return MovingMount(joints[-1].parent, T_base_sensor, angle_rad, names, joints[0].source)


def _why_no_joint(poses: Trajectory) -> dict[str, Value]:
    """Why poses are not those of a joint, as values; empty = they are."""
    if len(poses) < 2:
        return {"untimed": True}
    travel_m = float(np.ptp(poses.T_a_b.t, axis=0).max())
    if travel_m > JOINTS.travel_m:
        return {"travel_m": travel_m}
    off = _off_axis(poses.T_a_b)
    return {"off_axis": off} if off > JOINTS.off_axis else {}


def _turns(T: SE3) -> Array:
    """Turns from pose to pose about the axes of the base [rad], (K - 1, 3)."""
    return np.asarray(so3_log(T.R[1:] @ np.swapaxes(T.R[:-1], 1, 2)), dtype=np.float64)


def _axis(turns: Array) -> Array:
    """The axis that most turns are about, unit vector, (3,)."""
    return np.asarray(np.linalg.eigh(turns.T @ turns)[1][:, -1], dtype=np.float64)


def _off_axis(T: SE3) -> float:
    """Part of the turns that is about other axes than the main one."""
    turns = _turns(T)
    about = turns @ _axis(turns)
    total = float(np.linalg.norm(turns))
    return float(np.linalg.norm(turns - about[:, None] * _axis(turns))) / total if total else 0.0


def _turned_rad(T: SE3) -> Array:
    """Angle about the main axis since the first pose [rad], (K,)."""
    turns = _turns(T)
    return np.concatenate([[0.0], np.cumsum(turns @ _axis(turns))])


def _composed(
    graph: FrameGraph,
    joints: Sequence[MovingJoint],
    frame: str,
    *,
    poses: Mapping[str, Trajectory],
) -> Trajectory | None:
    """Poses of a frame in the part that carries its joints, at the times of all of their poses."""
    chains = [poses[joint.child] for joint in joints]
    first_ns, last_ns = max(c.t_ns[0] for c in chains), min(c.t_ns[-1] for c in chains)
    t_ns = distinct(np.concatenate([chain.t_ns for chain in chains]))
    t_ns = t_ns[(t_ns >= first_ns) & (t_ns <= last_ns)]
    if len(t_ns) < 2:
        return None
    T_at_sensor, at = SE3.identity(len(t_ns)), frame
    for joint in joints:
        T_child_at = graph.T_a_b(joint.child, at)
        if T_child_at is None:
            return None
        T_at_sensor = poses[joint.child].at(t_ns) @ (T_child_at @ T_at_sensor)
        at = joint.parent
    return Trajectory(t_ns, T_at_sensor)
