"""How a 2-D laser is mounted: upside down, tilted, beside the middle of the robot."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import islice

import numpy as np

from recon4.geometry.se2 import compose
from recon4.geometry.se3 import SE3, Array
from recon4.model.derived_kinds import DerivedKind
from recon4.model.finding import Value
from recon4.model.finding_kinds import FindingKind
from recon4.model.laser_scans import LaserScans
from recon4.model.laser_upright import is_upside_down, turned_round
from recon4.recording.formats.bags import Bag
from recon4.recording.lasers.tuning import LASERS
from recon4.recording.mounts.bag_rig import Mounts, read_mounts, stated_values
from recon4.recording.mounts.frame_graph import last_name, mount_value
from recon4.recording.mounts.transform_messages import frame_name
from recon4.recording.report import ImportReport
from recon4.recording.tuning import PROBE

_OPTICAL = ("_optical", "_optical_frame")
"""Ends of frames whose z axis looks ahead (REP 103)."""


@dataclass(frozen=True, slots=True, eq=False)
class LaserMount:
    """Mount of a 2-D laser on a robot whose z axis points up."""

    T_body_laser: SE3
    T_odometry_laser: SE3
    """Mount in the frame whose poses the odometry gives."""
    stated: Mapping[str, Value]
    """Who states it, as values of `DerivedKind.MOUNT_STATED`."""
    doubted: Mapping[str, Value]
    """The same as values of findings: ``by_rig`` or ``by_recording`` with its frames."""

    @property
    def is_upside_down(self) -> bool:
        """Whether the angles of its beams grow clockwise, seen from above."""
        return is_upside_down(self.T_body_laser)

    @property
    def tilt_rad(self) -> float:
        """Angle between its plane and the level one [rad]."""
        return float(np.arccos(np.clip(abs(self.T_body_laser.R[2, 2]), 0.0, 1.0)))


@dataclass(frozen=True, slots=True, eq=False)
class LaserRecording:
    """What is read of a 2-D laser, as it was measured."""

    scans: LaserScans
    mount: LaserMount | None = None
    """As the recording states it; None = it does not."""
    of_robot: bool = False
    """Whether the odometry is that of the robot, not of the laser."""


@dataclass(frozen=True, slots=True, eq=False)
class MountedScans:
    """Scans whose angles grow counterclockwise seen from above, with the laser's odometry."""

    scans: LaserScans
    mount: LaserMount | None

    @property
    def tilt_deg(self) -> float:
        """Tilt of the laser [°]; 0 if it is not known."""
        return float(np.rad2deg(self.mount.tilt_rad)) if self.mount else 0.0


def mount_of_rig(T_body_laser: SE3) -> LaserMount:
    """The mount that a rig file states; its odometry is that of the body."""
    by_rig = mount_value(T_body_laser)
    stated: dict[str, Value] = {"what": "laser", "by_rig": by_rig}
    return LaserMount(T_body_laser, T_body_laser, stated, {"by_rig": by_rig})


def mount_of_bag(bag: Bag, topic: str, odometry: str, *, report: ImportReport) -> LaserMount | None:
    """The mount that the transforms of an open bag state; None = they do not.

    Args:
        bag: An open bag.
        topic: Of the scans.
        odometry: Topic of the odometry; empty = there is none.
        report: Receives remarks.
    """
    mounts = read_mounts(bag, [topic], report)
    frame = mounts.frame_of(topic)
    if not mounts.any_stated:
        return None
    _doubt_joints(mounts, frame, report)
    body = _body_of(mounts, frame)
    T_body_laser = mounts.graph.T_a_b(body, frame) if body else None
    if T_body_laser is None:
        report.derive(DerivedKind.LASER_MOUNT_UNSTATED, topic=topic, frame=frame or "no-name")
        return None
    moving = mounts.graph.meant_by(_child_frame(bag, odometry) if odometry else "")
    T_odometry_laser = mounts.graph.T_a_b(moving[0], frame) if len(moving) == 1 else None
    stated = stated_values(mounts, body, frame, what="laser")
    place = {name: stated[name] for name in ("parent", "child", "sources")}
    return LaserMount(
        T_body_laser,
        T_body_laser if T_odometry_laser is None else T_odometry_laser,
        stated,
        place | {"by_recording": mount_value(T_body_laser)},
    )


def mounted_scans(
    recording: LaserRecording, by_rig: LaserMount | None, *, report: ImportReport
) -> MountedScans:
    """The scans as seen from above, with the odometry of the laser.

    Args:
        recording: As read.
        by_rig: The mount by a rig file, which counts; None = there is none.
        report: Receives what was done, and contradictions.
    """
    mount = by_rig or recording.mount
    if by_rig is not None and recording.mount is not None:
        _compare(by_rig, recording.mount, report)
    scans = recording.scans
    if mount is None:
        if recording.of_robot and scans.odometry is not None:
            report.derive(DerivedKind.LASER_MOUNT_UNSTATED, of_odometry=True)
        return MountedScans(scans, None)
    if recording.of_robot and scans.odometry is not None:
        T_odometry_laser = _planar(mount.T_odometry_laser)
        scans = replace(scans, odometry=compose(scans.odometry, T_odometry_laser[None]))
        if T_odometry_laser.any():
            report.derive(DerivedKind.ODOMETRY_MOVED)
            report.derive(DerivedKind.MOUNT_STATED, **mount.stated)
    if mount.is_upside_down:
        report.derive(DerivedKind.LASER_UPSIDE_DOWN)
        report.derive(DerivedKind.MOUNT_STATED, **mount.stated)
        scans = turned_round(scans)
    if mount.tilt_rad > LASERS.tilted_rad:
        longer = 1.0 / max(np.cos(mount.tilt_rad), 1e-3) - 1.0
        report.warn(
            FindingKind.LASER_TILTED,
            tilt_rad=mount.tilt_rad,
            longer=min(longer, 9.99),
            **mount.doubted,
        )
    return MountedScans(scans, mount)


def _compare(by_rig: LaserMount, by_bag: LaserMount, report: ImportReport) -> None:
    """Compare the vertical; which frame is the body of a rig file is not known."""
    up_rig, up_bag = by_rig.T_body_laser.R[2], by_bag.T_body_laser.R[2]
    angle_rad = float(np.arccos(np.clip(up_rig @ up_bag, -1.0, 1.0)))
    if angle_rad > LASERS.different_rad:
        report.warn(
            FindingKind.LASER_CONTRADICTED,
            angle_rad=angle_rad,
            **by_rig.doubted,
            **by_bag.doubted,
        )


def _doubt_joints(mounts: Mounts, frame: str, report: ImportReport) -> None:
    """Say which joints tilt the laser during the recording: a flat map assumes that none does."""
    for joint in mounts.graph.joints_above(frame):
        if joint.tilt_rad > LASERS.tilted_rad:
            report.warn(
                FindingKind.LASER_ON_JOINT,
                parent=joint.parent,
                child=joint.child,
                tilt_rad=joint.tilt_rad,
                source=joint.source,
            )


def _body_of(mounts: Mounts, frame: str) -> str:
    """A frame with z up that carries the laser; empty = none is known."""
    if frame not in mounts.graph:
        return ""
    body = mounts.graph.body_of(frame)
    if body:
        return body
    top = mounts.graph.top_of(frame)
    return "" if top == frame or last_name(top).endswith(_OPTICAL) else top


def _child_frame(bag: Bag, topic: str) -> str:
    """The frame whose poses an odometry gives."""
    for message in islice(bag.messages([topic]), PROBE.messages):
        content = bag.decode(message)
        if content is not None:
            return frame_name(content.child_frame_id)
    return ""


def _planar(T_body_laser: SE3) -> Array:
    """Position and heading of the x axis of a laser: x [m], y [m], yaw [rad], (3,)."""
    x, y, _ = T_body_laser.t
    return np.array([x, y, np.arctan2(T_body_laser.R[1, 0], T_body_laser.R[0, 0])])
