"""The head of a profiler whose mount moves by the transforms of a bag: a 2-D laser that tilts."""

from __future__ import annotations

from recon4.recording.assembly.shots import Shots
from recon4.recording.clocks.compare import warn_of_other_joint_clock
from recon4.recording.lasers.head_angles import HeadAngles
from recon4.recording.mounts.moving import MovingMount
from recon4.recording.report import ImportReport


class JointHead:
    """Places the lines of a ``LaserScan``, which lie in the x-y plane of its frame.

    All poses of the joint are known before the first line: a transform that was recorded late is
    not missing.
    """

    across = 1

    def __init__(self, name: str, mount: MovingMount, report: ImportReport) -> None:
        """Prepare.

        Args:
            name: What the profiler is called in the report.
            mount: Of the laser.
            report: Receives what is missing.
        """
        self._mount, self._report = mount, report
        self._angles = HeadAngles(name, 0.0, report)

    def ready(self, end_ns: int) -> bool:
        """See `Head.ready`."""
        return True

    def overdue(self, end_ns: int, now_ns: int) -> bool:
        """See `Head.overdue`."""
        return True

    def turn(self, line: Shots) -> tuple[Shots, float] | None:
        """See `Head.turn`; shots whose pose is not known are counted and left out."""
        placed, unknown = self._mount.place(line)
        if not len(placed):
            return None
        self._report.count("points_without_joint", unknown)
        return placed, self._mount.angle_at(int(placed.t_ns[0]))

    def finish(self, seconds: float) -> None:
        """See `Head.finish`."""
        poses = self._mount.T_base_sensor
        for t_ns, angle_rad in zip(
            poses.t_ns.tolist(), self._mount.angle_rad.tolist(), strict=True
        ):
            self._angles.push(t_ns, angle_rad)
        self._angles.finish(seconds)
        warn_of_other_joint_clock(self._mount.text, self._report)
