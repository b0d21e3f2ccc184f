"""People and vehicles that stand where other scans see through."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree

from recon4.findings.witnesses.motion import moving_finding
from recon4.findings.wording import text_of
from recon4.geometry.se3 import SE3, Array
from recon4.model.frames import RecordedFrames
from recon4.model.hidden_points import HiddenPoints
from recon4.model.multiframe import Multiframe
from recon4.model.odometry_figures import MovingFigures, MovingOutcome, OdometryFigures
from recon4.model.rig import Rig, Sensor, load_rig
from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Trajectory
from recon4.progress import Silent
from recon4.registration.moving import (
    StandingFrames,
    find_moving,
    hide_moving,
    image_shape,
    with_points_around,
)
from recon4.registration.stage import run_odometry
from recon4.registration.tracked_walk import WalkInputs
from recon4.settings import OdometrySettings, Settings
from recon4.store.arrays import load_record
from recon4.units import STANDARD_GRAVITY_M_S2
from tests.said import odometry_findings, texts

FRAME_NS = 100_000_000
SPEED_M_S, STRIDE_S = 1.2, 4.0
"""The carrier goes and stops by turns, so that an IMU knows of its motion."""
RIG = Rig(
    name="one",
    sensors=(Sensor(name="lidar", model="VLP-16", T_body_sensor=SE3.identity()),),
    T_body_imu=SE3.identity(),
    imu_time_offset_s=0.0,
    p_body_antenna=np.zeros(3),
    gnss_time_offset_s=0.0,
)
RINGS_DEG = np.arange(-29.0, 30.0, 2.0)


def rays(rings_deg: Array) -> Array:
    """Unit directions of a scan, (N, 3)."""
    azimuth, elevation = np.meshgrid(np.deg2rad(np.arange(360.0) + 0.3), np.deg2rad(rings_deg))
    flat = np.cos(elevation)
    directions = [flat * np.cos(azimuth), flat * np.sin(azimuth), np.sin(elevation)]
    return np.stack(directions, axis=-1).reshape(-1, 3)


def room_ranges(origin: Array, d: Array) -> Array:
    """To the walls of a hall of 60 m x 20 m x 6 m, (N,)."""
    low, high = np.array([-30.0, -10.0, -1.5]), np.array([30.0, 10.0, 4.5])
    with np.errstate(divide="ignore"):
        return np.where(d > 0, (high - origin) / d, (low - origin) / d).min(axis=1)


def pillar_ranges(origin: Array, d: Array, center: Array) -> Array:
    """To a pillar of 0.6 m x 1.7 m, inf = beside it, (N,)."""
    to = center[:2] - origin[:2]
    flat2 = (d[:, :2] ** 2).sum(axis=1)
    nearest = d[:, :2] @ to
    miss2 = (to @ to) * flat2 - nearest**2
    entry = (nearest - np.sqrt(np.maximum(0.09 * flat2 - miss2, 0.0))) / flat2
    z = origin[2] + entry * d[:, 2]
    return np.where((miss2 < 0.09 * flat2) & (entry > 0) & (abs(z + 0.65) < 0.85), entry, np.inf)


NONE = np.empty((0, 2))


class Walk:
    """Multiframes of a walk along the hall, with pillars that walk along and others that stand."""

    def __init__(
        self,
        walking: Array = NONE,
        standing: Array = NONE,
        *,
        seconds: float = 8.0,
        model: str = "VLP-16",
        rings_deg: Array = RINGS_DEG,
    ) -> None:
        """Places of pillars by where the carrier is, and by where it begins [m], (M, 2)."""
        self.rig = replace(RIG, sensors=(replace(RIG.sensors[0], model=model),))
        self._walking, self._standing, self._rings_deg = walking, standing, rings_deg
        self._scanned: dict[int, Multiframe] = {}
        t_s = np.arange(0.0, seconds + 0.1, 0.005)
        omega = 2.0 * np.pi / STRIDE_S
        accel = np.zeros((len(t_s), 3))
        accel[:, 0], accel[:, 2] = SPEED_M_S * omega * np.sin(omega * t_s), STANDARD_GRAVITY_M_S2
        self.imu = ImuSamples((1e9 * t_s).astype(np.int64), np.zeros_like(accel), accel)
        self.t_mid_ns = FRAME_NS * np.arange(int(10 * seconds), dtype=np.int64) + FRAME_NS // 2

    def __len__(self) -> int:
        return len(self.t_mid_ns)

    def place(self, t_ns: float) -> Array:
        t_s, omega = 1e-9 * t_ns, 2.0 * np.pi / STRIDE_S
        return np.array([-5.0 + SPEED_M_S * (t_s - np.sin(omega * t_s) / omega), 0.3, 0.0])

    def __getitem__(self, k: int) -> Multiframe:
        """A scan is dearer than the odometry of it, which reads it several times."""
        if k not in self._scanned:
            self._scanned[k] = self._scan(k)
        return self._scanned[k]

    def _scan(self, k: int) -> Multiframe:
        origin, d = self.place(self.t_mid_ns[k]), rays(self._rings_deg)
        room = room_ranges(origin, d)
        begin = self.place(0.0)
        stands = [pillar_ranges(origin, d, begin + np.append(p, 0.0)) for p in self._standing]
        walks = [pillar_ranges(origin, d, origin + np.append(p, 0.0)) for p in self._walking]
        behind = np.minimum.reduce([room, *stands])
        ranges = np.minimum.reduce([behind, *walks])
        n = len(d)
        return Multiframe(
            frame_id=k,
            t_ns=int(self.t_mid_ns[k]) - FRAME_NS // 2,
            duration_ns=FRAME_NS,
            xyz=(ranges[:, None] * d).astype(np.float32),
            intensity=(100 * (ranges < behind)).astype(np.uint16),
            ring=np.repeat(np.arange(len(self._rings_deg)), 360).astype(np.uint8),
            sensor=np.zeros(n, np.uint8),
            echo=np.zeros(n, np.uint8),
            dt_ns=np.full(n, FRAME_NS // 2, np.int32),
        )

    def __iter__(self):
        return (self[k] for k in range(len(self)))

    @property
    def trajectory(self) -> Trajectory:
        t_ns = np.append(self.t_mid_ns - FRAME_NS // 2, len(self) * FRAME_NS)
        places = np.stack([self.place(t) for t in t_ns])
        return Trajectory(t_ns, SE3(np.tile(np.eye(3), (len(t_ns), 1, 1)), places))


GROUP = np.array([[1.3, 0.0], [0.2, 1.3], [-0.2, -1.3], [-0.9, 0.8]])
"""None of them comes to where another one was."""
ROWS = np.array([[x, y] for x in range(-12, 20, 3) for y in (-5.0, -3.0, 3.5, 5.5)], np.float64)
"""Pillars that hold a trajectory along the hall."""
ON_PILLAR = 100
"""Intensity of points on pillars that walk along."""


def ratios(walk: Walk) -> Array:
    piece = np.zeros(len(walk), np.int64)
    return np.array(find_moving(walk, walk.trajectory, piece).ratio)


def test_people_who_walk_along_are_found_with_their_part_of_the_view() -> None:
    walk = Walk(GROUP)
    true = np.mean([np.mean(walk[k].intensity == ON_PILLAR) for k in range(20, 60, 10)])

    found = ratios(walk)[2:6].mean()

    assert true > 0.15
    assert 0.7 * true < found < 1.05 * true


def test_people_are_found_between_rings_that_are_wider_apart() -> None:
    walk = Walk(GROUP, model="OS0-32", rings_deg=np.linspace(-45.0, 45.0, 32))
    true = np.mean([np.mean(walk[k].intensity == ON_PILLAR) for k in range(20, 60, 10)])

    assert ratios(walk)[2:6].mean() > 0.7 * true > 0.1
    assert image_shape(walk.rig) == (62, 124)
    assert image_shape(load_rig("4recon")) == (90, 180)


def test_pillars_that_stand_are_none() -> None:
    walk = Walk(standing=np.array([[3.0, 1.2], [5.0, -1.0], [7.0, 1.3], [2.0, -1.2]]))

    assert ratios(walk).max() < 0.005


def test_an_empty_hall_has_none() -> None:
    assert ratios(Walk()).max() == 0.0


def test_moving_points_are_hidden_and_others_are_not() -> None:
    walk = Walk(GROUP)
    piece = np.zeros(len(walk), np.int64)
    found = find_moving(walk, walk.trajectory, piece)

    seen: RecordedFrames = StandingFrames(
        walk, hide_moving(walk, walk.trajectory, piece, found=found)
    )

    before, after = walk[40].intensity == ON_PILLAR, seen[40].intensity == ON_PILLAR
    assert after.sum() < 0.3 * before.sum()
    assert (~after).sum() > 0.99 * (~before).sum()


def test_feet_that_no_scan_sees_through_are_hidden_with_the_rest() -> None:
    walk = Walk(GROUP)
    frame = walk[40]
    person, z = frame.intensity == ON_PILLAR, frame.xyz[:, 2]
    found = person & (z > -1.1)

    hidden = with_points_around(frame, found, RIG)

    assert hidden[person & (z > -1.3)].all()
    away_m = cKDTree(frame.xyz[found]).query(frame.xyz)[0]
    assert not hidden[away_m > 0.5 * np.sqrt(3.0)].any()


def test_single_points_hide_nothing_around_them() -> None:
    frame = Walk(GROUP)[40]
    found = np.zeros(len(frame), np.bool_)
    found[np.flatnonzero(frame.intensity == ON_PILLAR)[[0, -1]]] = True

    np.testing.assert_array_equal(with_points_around(frame, found, RIG), found)


def odometry_texts(moving: MovingFigures) -> list[str]:
    """What is said of an odometry with these moving objects."""
    return texts(odometry_findings(OdometryFigures(multiframes=9, lost=0, moving=moving)))


def test_multiframes_that_lost_tracking_are_not_compared() -> None:
    walk = Walk(GROUP)

    found = find_moving(walk, walk.trajectory, np.full(len(walk), -1))

    assert found.ratio == () and not found.is_crowded


def test_pieces_are_not_compared_with_each_other() -> None:
    walk = Walk(GROUP, seconds=4.0)
    every_second_its_own = np.arange(len(walk)) // 10

    found = find_moving(walk, walk.trajectory, every_second_its_own)

    assert max(found.ratio) == 0.0


def test_a_crowd_is_announced_with_times_and_ratio() -> None:
    found = MovingFigures(
        t_s=(0.0, 1.0, 2.0, 3.0), ratio=(0.02, 0.11, 0.27, 0.05), outcome=MovingOutcome.LEFT_OUT
    )

    text = text_of(moving_finding(found))

    assert text.startswith(
        "Between 1 s and 2 s moving objects (people, vehicles) fill up to 27 % of the view, most "
        "at 2 s."
    )
    assert not found.is_severe


def test_few_moving_objects_are_not_announced() -> None:
    assert not odometry_texts(MovingFigures(t_s=(0.0, 1.0), ratio=(0.02, 0.09)))


def test_what_does_not_hold_the_trajectory_is_severe() -> None:
    found = MovingFigures(t_s=(0.0,), ratio=(0.6,), outcome=MovingOutcome.NOT_HELD)

    assert found.is_severe and "does not hold the trajectory" in text_of(moving_finding(found))


@pytest.mark.slow
def test_odometry_leaves_moving_objects_out_and_says_so(tmp_path: Path) -> None:
    walk = Walk(GROUP[2:], ROWS, seconds=4.0)

    figures = run_odometry(WalkInputs(walk, Settings(), Silent()), tmp_path)

    assert figures.moving is not None and figures.moving.outcome == MovingOutcome.LEFT_OUT
    assert any("moving objects" in text for text in odometry_texts(figures.moving))
    hidden = load_record(tmp_path / "moving.npz", HiddenPoints)
    seen = np.array([len(hidden.seen(frame)) / len(frame) for frame in walk])
    assert seen.min() < 0.9
    left_out = sum(len(frame) - len(hidden.seen(frame)) for frame in walk)
    assert figures.moving.points_left_out == left_out > 0
    count = f"{left_out:,}".replace(",", "\u202f")
    assert any(f"{count} points are left out" in text for text in odometry_texts(figures.moving))


@pytest.mark.slow
@pytest.mark.study
def test_odometry_keeps_them_if_the_settings_say_so(tmp_path: Path) -> None:
    walk, kept = Walk(GROUP, ROWS, seconds=4.5), OdometrySettings(leave_out_moving=False)

    figures = run_odometry(WalkInputs(walk, Settings(odometry=kept), Silent()), tmp_path)

    assert figures.moving is not None and figures.moving.outcome == MovingOutcome.KEPT
    assert any("Their points are in the map" in text for text in odometry_texts(figures.moving))
    assert not (tmp_path / "moving.npz").exists()
