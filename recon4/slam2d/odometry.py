"""2-D odometry: each scan is registered to a sliding local map of lines."""

from __future__ import annotations

from collections import deque
from dataclasses import fields

import numpy as np

from recon4.geometry.se2 import between, compose, transform, wrap
from recon4.geometry.se3 import Array
from recon4.model.laser_scans import LaserScans
from recon4.model.trajectory import Trajectory
from recon4.model.tuning import OBSERVATION
from recon4.progress import Progress, track
from recon4.slam2d.correlative import LikelihoodField
from recon4.slam2d.line_map import LineMap, Match2d, Prior2d, stack_points
from recon4.slam2d.observability import Observed, observed
from recon4.slam2d.prediction import MotionPredictor, Predicted, VarianceGrowth
from recon4.slam2d.scan_points import ScanPoints, leveling, scan_points
from recon4.slam2d.steps import Steps2d, empty_steps
from recon4.slam2d.tuning import Slam2dTuning
from recon4.slam2d.tuning_matching import ODOMETRY_2D


class Odometry2d:
    """Registers scans one after the other; `push` them in order of time."""

    def __init__(
        self,
        scans: LaserScans,
        *,
        attitude: Trajectory | None = None,
        settings: Slam2dTuning | None = None,
    ) -> None:
        """Prepare; no scan is registered yet.

        Args:
            scans: All scans.
            attitude: Attitude of the laser at all scans, as of an IMU; None = the laser is level.
            settings: None = the defaults.
        """
        self._settings = settings or Slam2dTuning()
        self._take(scans, attitude)
        extent_m = 2.0 * self._settings.max_range_m + ODOMETRY_2D.window_path_m
        self._map = LineMap(cell_m=self._settings.cell_m, extent_m=extent_m)
        self._window: deque[tuple[Array, Array]] = deque()
        self._field: LikelihoodField | None = None
        self._key_pose = np.zeros(3)
        """Pose of the last keyframe."""
        self._growth = VarianceGrowth()
        self._lost_in_a_row = 0
        self.steps = empty_steps(scans.t_ns)
        self.seen = ScanPoints(np.zeros((0, 2)), np.zeros(0))
        """Returns of the last scan that was pushed, level and undistorted."""

    def advance(self, scans: LaserScans, *, known: int, attitude: Trajectory | None = None) -> None:
        """Continue with more scans, as they come in: rows that are no longer needed are dropped.

        Args:
            scans: The last ``known`` scans that were pushed, and new ones. The scans of the last
                quarter of a second give the velocity.
            known: How many were pushed.
            attitude: As at the start, for these scans.
        """
        self._take(scans, attitude)
        before, self.steps = self.steps, empty_steps(scans.t_ns)
        for name in (field.name for field in fields(Steps2d) if known):
            getattr(self.steps, name)[:known] = getattr(before, name)[-known:]

    def _take(self, scans: LaserScans, attitude: Trajectory | None) -> None:
        self._scans = scans
        self._predictor = MotionPredictor(scans, attitude, settings=self._settings)
        self._leveling: Array | None = None
        if attitude is not None:
            self._leveling = leveling(attitude.at(scans.t_ns, slack_ns=1_000_000_000))

    def push(self, k: int) -> None:
        """Register scan ``k``; the scans before it were pushed already."""
        steps = self.steps
        predicted = self._predict(k)
        self.seen = scan = self._points(k)
        start = compose(steps.pose[k - 1], predicted.motion) if k else np.zeros(3)
        if not self._window:
            steps.pose[k] = start
            steps.lost[k] = len(scan.points) < ODOMETRY_2D.fewest_points
            if not steps.lost[k]:
                self._insert(k, scan)
            return
        self._growth.add(predicted)
        match = self._register(k, scan, start, predicted=predicted)
        found = observed(match.H, self._settings.normal_noise_rad) if match else None
        if match is None or found is None or match.match_ratio < self._settings.min_match_ratio:
            self._lose(k, start, scan)
        else:
            self._accept(k, match, found)
            if self._is_keyframe(k):
                self._insert(k, scan)

    def _predict(self, k: int) -> Predicted:
        if k == 0:
            return Predicted(np.zeros(3), 0.0, 0.0, drift_m=0.0, drift_rad=0.0)
        return self._predictor.predict(k, self.steps.pose)

    def _points(self, k: int) -> ScanPoints:
        motion = self._predictor.velocity(k, self.steps.pose) if k > 1 else None
        level = None if self._leveling is None else self._leveling[k]
        return scan_points(
            self._scans, k, settings=self._settings, R_level_laser=level, motion=motion
        )

    def _register(
        self, k: int, scan: ScanPoints, start: Array, *, predicted: Predicted
    ) -> Match2d | None:
        if len(scan.points) < ODOMETRY_2D.fewest_points:
            return None
        loose = ODOMETRY_2D.loose_prior * np.array(
            [predicted.sd_rad, predicted.sd_m, predicted.sd_m]
        )
        prior = Prior2d(start, np.diag(loose**-2.0))
        sd_m = self._settings.noise_sd_m
        match = self._map.register(scan.points, scan.weights, start=start, prior=prior, sd_m=sd_m)
        if match.match_ratio >= self._settings.search_match_ratio:
            return match
        return self._search(k, scan, start=start, match=match, predicted=predicted)

    def _search(
        self, k: int, scan: ScanPoints, *, start: Array, match: Match2d, predicted: Predicted
    ) -> Match2d:
        """Look for a pose with a higher match ratio around the predicted one."""
        if self._field is None:
            self._field = LikelihoodField.of(stack_points([points for _, points in self._window]))
        reach = 3.0 * (1 + self._lost_in_a_row)
        found = self._field.search(
            scan.points,
            initial_pose=start,
            half_window_m=min(0.1 + reach * predicted.sd_m, ODOMETRY_2D.widest_search_m),
            half_window_rad=min(0.05 + reach * predicted.sd_rad, np.pi),
            min_score=ODOMETRY_2D.search_score,
        )
        if found is None:
            return match
        better = self._map.register(
            scan.points, scan.weights, start=found.pose, sd_m=self._settings.noise_sd_m
        )
        if better.match_ratio < match.match_ratio + 0.1:
            return match
        self.steps.searched[k] = True
        return better

    def _accept(self, k: int, match: Match2d, found: Observed) -> None:
        steps = self.steps
        steps.pose[k] = match.pose
        steps.match_ratio[k] = match.match_ratio
        steps.degeneracy[k] = found.degeneracy
        steps.weak_sd_m[k] = found.weak_sd_m
        steps.weak_direction[k] = found.weak_direction
        steps.motion_information[k] = self._in_scan_axes(match.pose, found.information)
        self._lost_in_a_row = 0
        self._growth.observed(position=found.weak_sd_m <= OBSERVATION.weak_sd_m)

    def _in_scan_axes(self, pose: Array, information: Array) -> Array:
        """Information of lines and prediction together, in the axes of the scan."""
        c, s = np.cos(pose[2]), np.sin(pose[2])
        turn = np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])
        return np.asarray(turn.T @ (information + np.diag(1.0 / self._growth.variance)) @ turn)

    def _lose(self, k: int, start: Array, scan: ScanPoints) -> None:
        """Keep the prediction; after many lost scans start another local map."""
        steps = self.steps
        steps.pose[k], steps.lost[k] = start, True
        steps.motion_information[k] = self._in_scan_axes(start, np.zeros((3, 3)))
        self._lost_in_a_row += 1
        if (
            self._lost_in_a_row >= ODOMETRY_2D.reset_after
            and len(scan.points) >= ODOMETRY_2D.fewest_points
        ):
            steps.resets[k] = True
            while self._window:
                self._map.remove(self._window.popleft()[1])
            self._insert(k, scan)
            self._lost_in_a_row = 0
        elif self._growth.sd_m > ODOMETRY_2D.loose_sd_m or self._is_keyframe(k):
            self._mark_keyframe(k)  # a node for the path, without returns

    def _is_keyframe(self, k: int) -> bool:
        if (
            len(self._window) < ODOMETRY_2D.first_keyframes
            or self._growth.sd_m > ODOMETRY_2D.loose_sd_m
        ):
            return True
        moved = between(self._key_pose, self.steps.pose[k])
        far = float(np.hypot(moved[0], moved[1])) > self._settings.keyframe_m
        return far or abs(float(wrap(moved[2]))) > self._settings.keyframe_rad

    def _insert(self, k: int, scan: ScanPoints) -> None:
        pose = self.steps.pose[k].copy()
        points = transform(pose, scan.points)
        self._map.add(points)
        self._window.append((pose, points))
        while self._is_too_large():
            self._map.remove(self._window.popleft()[1])
        self._field = None
        self._mark_keyframe(k)

    def _mark_keyframe(self, k: int) -> None:
        self.steps.keyframe[k] = True
        self._key_pose = self.steps.pose[k].copy()
        self._growth.restart()

    def _is_too_large(self) -> bool:
        (first, _), (last, _) = self._window[0], self._window[-1]
        distance = float(np.hypot(first[0] - last[0], first[1] - last[1]))
        return len(self._window) > self._settings.window or distance > ODOMETRY_2D.window_path_m


def run_odometry_2d(
    scans: LaserScans,
    *,
    attitude: Trajectory | None,
    settings: Slam2dTuning,
    progress: Progress,
) -> Steps2d:
    """Register all scans.

    Args:
        scans: At least one.
        attitude: As for `Odometry2d`.
        settings: As for `Odometry2d`.
        progress: Counts scans.
    """
    odometry = Odometry2d(scans, attitude=attitude, settings=settings)
    for k in track(range(len(scans)), progress, what="2-D odometry", unit="scans"):
        odometry.push(k)
    return odometry.steps
