"""Odometry of a running capture, with a consistency check of the IMU."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, replace

import numpy as np

from recon4.geometry.se3 import SE3
from recon4.live.mapper.last_known import LastKnown
from recon4.live.mapper.live_attitude import NOT_UPRIGHT, is_upright
from recon4.live.mapper.live_imu import AxesWitness, ImuTreatment, LiveImu
from recon4.live.mapper.tuning import LIVE_TRACKER
from recon4.model.multiframe import Multiframe
from recon4.model.rig import Rig
from recon4.model.samples import ImuSamples
from recon4.recording.samples.measured_channels import imu_channels
from recon4.registration.hypothesis import ImuAssumption
from recon4.registration.imu_choice import (
    AS_RECORDED,
    LESS_USED,
    TrackedWindows,
    choose_imu,
    without_imu,
)
from recon4.registration.imu_repairs import NO_REPAIRS, ImuRepairs
from recon4.registration.odometry import Odometry
from recon4.registration.step import OdometryStep
from recon4.registration.tuning import OdometryTuning
from recon4.settings import Settings
from recon4.settings.reads import OdometryReads, part_of
from recon4.settings.tuning import tuned


class Tracker:
    """Runs `Odometry` with IMU samples that arrive in pieces."""

    def __init__(self, rig: Rig, settings: Settings) -> None:
        # After a pause the walk goes on where a short map shows it; loops correct the drift.
        shorter = replace(
            settings.odometry,
            history=tuned(OdometryTuning, settings.odometry).longest_map(with_imu=False),
        )
        self._rig = rig
        self._settings = replace(part_of(settings, OdometryReads), odometry=shorter)
        self._odometry: Odometry | None = None
        self._recent: deque[tuple[Multiframe, bool]] = deque(maxlen=LIVE_TRACKER.tried_frames)
        self._imu = LiveImu(rig)
        self._axes = AxesWitness(rig, self._settings)
        self._doubted = False
        """Whether something of the IMU contradicts the LiDARs, and is not used."""
        self.repairs = NO_REPAIRS
        """What was repaired of the samples that are used."""
        self._since_check = self._frames = 0
        self._end_ns: int | None = None
        """End of the last multiframe."""
        self.map_reset = False
        """Whether the last multiframe started a new map frame; the map before it is void."""
        self._tracked = SE3.identity()
        """Last ``T_map_body`` before tracking was lost."""
        self.last_known = LastKnown(rig)
        """Set by who knows that a pose is certain; turned on by the IMU."""
        self.T_map_odom = SE3.identity()
        """Pose of the odometry frame in the map; moved by loop closures and relocalization."""
        self.with_imu = False
        """Whether the odometry uses an IMU."""
        self.remark = ""
        """Code of a warning about the IMU, and why; empty = none."""

    def extend_imu(self, imu: ImuSamples) -> None:
        """Add IMU samples."""
        used = self._imu.extend(imu)
        if not len(used):
            return
        self.last_known.extend(used)
        if self._odometry is not None:
            self._odometry.extend_imu(used)

    def interrupted(self, frame: Multiframe) -> bool:
        """Whether the motion between the last multiframe and this one is unknown."""
        blind = not self.with_imu or self._imu.hole_ns > LIVE_TRACKER.interrupted_ns
        return (
            blind
            and self._end_ns is not None
            and frame.t_ns - self._end_ns > LIVE_TRACKER.interrupted_ns
        )

    def push(self, frame: Multiframe) -> OdometryStep:
        """Register the next multiframe; its pose is in the odometry frame (`T_map_odom`)."""
        self._note(frame)
        self._frames, self.map_reset = self._frames + 1, False
        if self._odometry is None:
            self._odometry = self._begin()
        step = self._odometry.push(frame)
        if not step.lost:
            self._tracked = self.T_map_odom @ step.T_odom_body
        self._recent.append((frame, step.lost or not step.error_m < LIVE_TRACKER.far_m))
        self._since_check += 1
        bad = sum(is_bad for _, is_bad in self._recent)
        if (
            self.with_imu
            and (bad >= LIVE_TRACKER.bad_frames or not self._imu.turn_rate_changes)
            and self._since_check >= LIVE_TRACKER.tried_frames
        ):
            self._since_check = 0
            return self._check_imu(step)
        if self.repairs is NO_REPAIRS and (self.with_imu or self._doubted):
            repairs = self._axes.look(frame, step, self._imu, doubted=self._doubted)
            return step if repairs is None else self._repair(repairs, step)
        return step

    def _begin(self) -> Odometry:
        imu = self._imu.recorded()
        if imu is not None:
            channels = imu_channels(imu)
            with_forces = not channels.no_accelerometer
            self._imu.treatment = ImuTreatment(with_forces=with_forces)
            imu = self._imu.used()
            if channels.no_accelerometer:
                self.remark = f"no-accelerometer {channels.no_accelerometer.why}"
        self.with_imu = imu is not None and len(imu) > 1
        if self.with_imu and imu is not None and not _upright(imu, self._rig):
            self.with_imu, imu = False, None
            self.remark, self._doubted = NOT_UPRIGHT, True
        return Odometry(self._rig, self._settings, imu)

    def restart(self, frame: Multiframe) -> OdometryStep:
        """Start a new odometry with a multiframe, at the last tracked pose."""
        self._note(frame)
        last = self._tracked
        self._axes.restarted()
        imu = self._imu.used() if self.with_imu else None
        before, self._odometry = self._odometry, Odometry(self._rig, self._settings, imu)
        if before is not None and before.imu_state is not None:
            self._odometry.remember_imu(before.imu_state)
        step = self._odometry.push(frame)
        self.move(last, step)
        return step

    def _note(self, frame: Multiframe) -> None:
        self._end_ns, self._imu.hole_ns = frame.t_ns + frame.duration_ns, 0

    def move(self, T_map_body: SE3, step: OdometryStep) -> None:
        """Set `T_map_odom` so that the step has this pose in the map."""
        self.T_map_odom = T_map_body @ step.T_odom_body.inverse()

    def _check_imu(self, step: OdometryStep) -> OdometryStep:
        """Choose the IMU again by the last multiframes, and go on with what was chosen."""
        imu = self._imu.used()
        recent = self._with(imu)
        # Certain, so it needs no proof by the LiDARs.
        certain = imu is not None and bool(imu_channels(imu).no_gyroscope)
        if certain:
            found = without_imu(recent, self._settings)
        else:
            found = choose_imu(recent, self._settings, [range(len(recent))])
        if found.best is None or found.imu.choice == AS_RECORDED:
            return step
        if not certain and found.best.score.lost > LIVE_TRACKER.still_lost:
            return step  # LiDARs that see nothing accuse no IMU
        self._use(found.imu)
        self.map_reset = self._frames < LIVE_TRACKER.early_frames
        return self._go_on(found.best, step)

    def _repair(self, repairs: ImuRepairs, step: OdometryStep) -> OdometryStep:
        """Go on with repaired samples, unless they contradict the last multiframes, too."""
        recorded = self._imu.recorded()
        assert recorded is not None, "nothing was repaired"
        with_forces = not imu_channels(recorded).no_accelerometer
        treatment = ImuTreatment(repairs.repair, with_forces=with_forces)
        recent = self._with(treatment.of(recorded))
        found = choose_imu(recent, self._settings, [range(len(recent))])
        if found.best is None or found.imu.choice.outcome in LESS_USED:
            return step
        self.map_reset = self.with_imu and self._frames < LIVE_TRACKER.early_frames
        self._imu.treatment, self.repairs, self.remark = treatment, repairs, ""
        self._use(found.imu)
        self._since_check = 0
        return self._go_on(found.best, step)

    def _with(self, imu: ImuSamples | None) -> _Recent:
        return _Recent(self._rig, [frame for frame, _ in self._recent], imu)

    def _go_on(self, tracked: TrackedWindows, step: OdometryStep) -> OdometryStep:
        """Replace the odometry by one that has tracked the last multiframes, at the same pose."""
        T_map_body, last = self.T_map_odom @ step.T_odom_body, tracked.last
        self._odometry = tracked.odometry
        if self.map_reset:
            self.T_map_odom = SE3.identity()
            self._tracked = last.T_odom_body
        else:
            self.move(T_map_body, last)
        return last

    def _use(self, imu: ImuAssumption) -> None:
        """Treat the samples to come as those of the choice, and say what is wrong with them."""
        self.with_imu = imu.samples is not None
        self._doubted = imu.choice.outcome in LESS_USED
        self._axes.restarted()
        before = self._imu.treatment
        match imu.choice.outcome:
            case "as recorded":
                pass
            case "bias removed":
                bias_rad_s = before.bias_rad_s + np.array(imu.choice.bias_rad_s)
                self._imu.treatment = replace(before, bias_rad_s=bias_rad_s)
                self.remark = "gyroscope-bias"
            case "accelerometer not used":
                self._imu.treatment = replace(before, with_forces=False)
                self.remark = "accelerometer-contradicts"
            case _:
                recorded = self._imu.recorded()
                fault = imu_channels(recorded).no_gyroscope if recorded else None
                self.remark = f"no-gyroscope {fault.why}" if fault else "imu-contradicts"


@dataclass(frozen=True, slots=True, eq=False)
class _Recent:
    """The last multiframes of a live walk, with the IMU samples so far."""

    rig: Rig
    frames: list[Multiframe]
    imu: ImuSamples | None

    def __len__(self) -> int:
        return len(self.frames)

    def __getitem__(self, k: int) -> Multiframe:
        return self.frames[k]


def _upright(imu: ImuSamples, rig: Rig) -> bool:
    """Whether the body's z axis points up by the accelerometer; True without one."""
    force = imu.accel_m_s2 @ rig.T_body_imu.R.T
    if not np.isfinite(force).all():  # gyroscope only
        return True
    return is_upright(force.mean(axis=0))
