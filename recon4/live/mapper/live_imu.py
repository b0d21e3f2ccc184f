"""The IMU of a running capture: its last samples, and what the odometry makes of them."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field, replace
from statistics import median

import numpy as np

from recon4.geometry.se3 import Array
from recon4.live.mapper.tuning import LIVE_TRACKER
from recon4.model.imu_repair import ImuRepair
from recon4.model.multiframe import Multiframe
from recon4.model.rig import Rig
from recon4.model.samples import ImuSamples
from recon4.recording.samples.clean import join
from recon4.recording.samples.measured_channels import feels_gravity
from recon4.registration.imu_repairs import ImuRepairs, repairs_of
from recon4.registration.odometry import Odometry
from recon4.registration.step import OdometryStep
from recon4.registration.tuning_imu import GYRO_ALIGNMENT, PREDICTION, TURNED_IMU
from recon4.registration.turned_imu import turned_by
from recon4.settings.reads import OdometryReads


@dataclass(frozen=True, slots=True, eq=False)
class ImuTreatment:
    """What makes recorded samples those that the odometry uses."""

    repair: ImuRepair | None = None
    """Of axes; None = they are right."""
    bias_rad_s: Array = field(default_factory=lambda: np.zeros(3))
    """Of the gyroscope, subtracted."""
    with_forces: bool | None = None
    """Whether the odometry uses accelerations: all samples have them, or none; None = it has not
    begun."""

    def of(self, imu: ImuSamples) -> ImuSamples:
        """The samples as the odometry uses them."""
        imu = imu if self.repair is None else self.repair.of(imu)
        imu = replace(imu, gyro_rad_s=imu.gyro_rad_s - self.bias_rad_s)
        if self.with_forces is None:
            return imu
        if not self.with_forces:
            return replace(imu, accel_m_s2=np.full_like(imu.accel_m_s2, np.nan))
        rows = feels_gravity(imu.accel_m_s2)
        return ImuSamples(imu.t_ns[rows], imu.gyro_rad_s[rows], imu.accel_m_s2[rows])


class LiveImu:
    """The samples that cover the last minute, as they were recorded."""

    def __init__(self, rig: Rig) -> None:
        self._offset_ns = round(rig.imu_clock_offset_s * 1e9)
        self._recorded: deque[ImuSamples] = deque()
        self.treatment = ImuTreatment()
        self._end_ns: int | None = None
        """Time of the last sample that is used."""
        self.hole_ns = 0
        """Longest time without one since this was set to 0."""
        self.turn_rate_changes = False
        """Whether the gyroscope measures: one that does not is not left to be seen by chance."""

    def extend(self, recorded: ImuSamples) -> ImuSamples:
        """Add samples; returns those that the odometry uses, on the clock of the LiDARs."""
        recorded = replace(recorded, t_ns=recorded.t_ns + self._offset_ns)
        used = self.treatment.of(recorded)
        if not len(used):
            return used
        self._recorded.append(recorded)
        begin_ns = recorded.t_ns[-1] - PREDICTION.kept_ns
        while len(self._recorded) > 1 and self._recorded[1].t_ns[0] <= begin_ns:
            self._recorded.popleft()
        first = self._recorded[0].gyro_rad_s[0]
        self.turn_rate_changes |= bool(np.any(recorded.gyro_rad_s != first))
        if self._end_ns is not None:
            self.hole_ns = max(self.hole_ns, int(used.t_ns[0]) - self._end_ns)
        self._end_ns = int(used.t_ns[-1])
        return used

    def recorded(self) -> ImuSamples | None:
        """All that are kept, on the clock of the LiDARs; None = there are none."""
        return join(list(self._recorded))

    def used(self) -> ImuSamples | None:
        """The same as the odometry uses them."""
        recorded = self.recorded()
        return None if recorded is None else self.treatment.of(recorded)

    def around(self, first_ns: int, last_ns: int) -> ImuSamples | None:
        """Samples as they were recorded of a time, and of that by which their clock may be off."""
        recorded, more_ns = self.recorded(), int(2e9 * GYRO_ALIGNMENT.largest_clock_s)
        if recorded is None:
            return None
        rows = (recorded.t_ns > first_ns - more_ns) & (recorded.t_ns < last_ns + more_ns)
        return ImuSamples(recorded.t_ns[rows], recorded.gyro_rad_s[rows], recorded.accel_m_s2[rows])


class AxesWitness:
    """The axes of an IMU by multiframes that were tracked without it.

    While nothing doubts the IMU it is not asked. Where the LiDARs keep moving what the IMU
    predicts, they track some multiframes by themselves beside the walk. A walk that does without
    what contradicted it shows the axes itself.
    """

    def __init__(self, rig: Rig, settings: OdometryReads) -> None:
        self._rig, self._settings = rig, settings
        self._steps: deque[OdometryStep] = deque(maxlen=TURNED_IMU.frames)
        self._offsets_m: deque[float] = deque(maxlen=LIVE_TRACKER.tried_frames)
        self._beside: Odometry | None = None
        """By the LiDARs alone, beside a walk with the IMU."""
        self._pause = LIVE_TRACKER.tried_frames
        """Multiframes between two questions; twice as many after each that accused nothing."""
        self._waits = self._pause

    def restarted(self) -> None:
        """Note that the walk goes on with another odometry."""
        self._offsets_m.clear()
        if self._beside is None:
            self._steps.clear()

    def look(
        self, frame: Multiframe, step: OdometryStep, imu: LiveImu, *, doubted: bool
    ) -> ImuRepairs | None:
        """What the last multiframes say of the axes of an IMU; None = nothing, or not yet.

        Args:
            frame: The newest one.
            step: As it was tracked.
            imu: The samples.
            doubted: Whether it was tracked without what contradicted it.
        """
        self._waits -= 1
        if not doubted:
            self._offsets_m.append(step.prediction_offset_m)
            if self._is_contradicted():
                self._beside = self._beside or Odometry(self._rig, self._settings)
        if self._beside is not None:
            step = self._beside.push(frame)
        elif not doubted:
            return None
        if self._steps and self._steps[-1].piece != step.piece:
            self._steps.clear()  # how the body moved between them is not known
        self._steps.append(step)
        if len(self._steps) < TURNED_IMU.frames or self._waits > 0:
            return None
        repairs = self._repairs(imu)
        if self._beside is not None:
            self._beside = None
            self._steps.clear()
            self._pause *= 2
        self._waits = self._pause
        return repairs

    def _is_contradicted(self) -> bool:
        """Whether the LiDARs moved what the IMU predicts in most of the last multiframes."""
        full = len(self._offsets_m) == LIVE_TRACKER.tried_frames
        return full and self._waits <= 0 and median(self._offsets_m) > LIVE_TRACKER.moved_m

    def _repairs(self, imu: LiveImu) -> ImuRepairs | None:
        steps = [step for step in self._steps if not step.lost]
        samples = imu.around(steps[0].t_mid_ns, steps[-1].t_mid_ns) if steps else None
        turned = None if samples is None else turned_by(steps, samples, self._rig)
        return None if turned is None else repairs_of(turned, self._rig)
