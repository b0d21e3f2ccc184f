"""Which LiDAR's IMU is read: several may have one."""

from __future__ import annotations

from dataclasses import replace

from recon4.model.lidars import lidar_model
from recon4.model.rig import Rig
from recon4.recording.packets.family import PacketSamples
from recon4.recording.report import ImportReport


class LidarImu:
    """Passes the samples of one IMU on and counts those of the others."""

    def __init__(self, rig: Rig, *, other: str, report: ImportReport) -> None:
        """Choose: the LiDAR that the rig names; else an IMU of its own; else the first LiDAR.

        Args:
            rig: The rig.
            other: Where an IMU of its own sends, for messages; empty = there is none.
            report: Receives what was chosen.
        """
        self._report = report
        with_imu = [s.name for s in rig.sensors if s.enabled and lidar_model(s.model).has_imu]
        self._chosen = rig.imu_sensor or ("" if other else next(iter(with_imu), ""))
        left_out = [name for name in with_imu if name != self._chosen]
        if left_out and (self._chosen or other):
            report.derive(
                f"IMU: {self._chosen or other} is read, not that of {', '.join(left_out)} "
                "(another one: [imu] sensor = NAME in the rig file)"
            )

    def of(self, name: str, samples: PacketSamples) -> PacketSamples:
        """The samples of a LiDAR, without those of an IMU that was not chosen."""
        if samples.imu is None or name == self._chosen:
            return samples
        self._report.count("imu_samples_not_read", len(samples.imu.t_ns))
        return replace(samples, imu=None)
