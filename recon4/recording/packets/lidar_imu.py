"""Which LiDAR's IMU is read: several may have one."""

from __future__ import annotations

from dataclasses import replace

from recon4.geometry.se3 import SE3
from recon4.model.derived_kinds import DerivedKind
from recon4.model.imu_mounts import with_imu_of
from recon4.model.lidars import lidar_model
from recon4.model.rig import Rig
from recon4.recording.packets.family import PacketSamples
from recon4.recording.report import ImportReport


def rig_of_imu_file(read: Rig, given: Rig | None) -> Rig:
    """The rig for samples of a file: they are of the IMU in a LiDAR only if a rig names it.

    Args:
        read: The rig as the recording was opened with it.
        given: The rig of a person; None = there is none.
    """
    if given is not None:
        return replace(read, imu_sensor=given.imu_sensor, T_body_imu=given.T_body_imu)
    return replace(read, imu_sensor="", T_body_imu=SE3.identity()) if read.imu_sensor else read


class LidarImu:
    """Passes the samples of one IMU on and counts those of the others."""

    def __init__(self, rig: Rig, *, other: str, report: ImportReport) -> None:
        """Choose: an IMU of its own; else the LiDAR that the rig names; else the first LiDAR.

        Args:
            rig: The rig.
            other: Where samples come from that are read in place of those in packets, for
                messages; empty = there are none, or the rig names a LiDAR whose packets have them.
            report: Receives what was chosen.
        """
        self._report = report
        self.rig = rig
        """With the LiDAR whose IMU is read, if it is that of one."""
        with_imu = [s.name for s in rig.sensors if s.enabled and lidar_model(s.model).has_imu]
        self._chosen = "" if other else rig.imu_sensor or next(iter(with_imu), "")
        if self._chosen and not rig.imu_sensor:
            self.rig = with_imu_of(rig, self._chosen)
        left_out = [name for name in with_imu if name != self._chosen]
        if left_out and (self._chosen or other):
            report.derive(
                DerivedKind.IMU_CHOSEN, read=self._chosen or other, others=", ".join(left_out)
            )

    def of(self, name: str, samples: PacketSamples) -> PacketSamples:
        """Samples without those of an IMU that was not chosen.

        Args:
            name: Of the LiDAR that they are of; empty = of an IMU of its own.
            samples: As decoded.
        """
        if samples.imu is None or name == self._chosen:
            return samples
        self._report.count("imu_samples_not_read", len(samples.imu.t_ns))
        return replace(samples, imu=None)
