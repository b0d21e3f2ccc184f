"""Lines of a profiler on the live map: placed by laser and IMU; the plan shows what they saw."""

import numpy as np
import pytest

from recon4.live.mapper.live_attitude import LiveAttitude
from recon4.live.mapper.scan_map import ScanMap
from recon4.live.mapper.swept_lines import SweptLines
from recon4.live.preview.coverage import CoverageClass
from recon4.model.laser_scans import LaserScans
from recon4.model.multiframe import Multiframe
from recon4.model.rig import load_rig
from recon4.model.samples import ImuSamples
from recon4.settings import Settings

RIG = load_rig("wuerzburg")
TENTH_NS = 100_000_000
START_NS = 10**12


def samples(first_ns, last_ns, turn_rad_s=0.0):
    t_ns = np.arange(first_ns, last_ns, 5_000_000, dtype=np.int64)
    gyro = np.zeros((len(t_ns), 3))
    gyro[:, 2] = turn_rad_s
    return ImuSamples(t_ns, gyro, np.tile([0.0, 0.0, 9.81], (len(t_ns), 1)))


def lines(k, xyz):
    """A multiframe with these points of the profiler [m], evenly in time."""
    count = len(xyz)
    return Multiframe(
        frame_id=k,
        t_ns=START_NS + k * TENTH_NS,
        duration_ns=TENTH_NS,
        xyz=np.asarray(xyz, np.float32),
        intensity=np.full(count, 40, np.uint16),
        ring=np.zeros(count, np.uint8),
        sensor=np.ones(count, np.uint8),
        echo=np.zeros(count, np.uint8),
        dt_ns=np.linspace(0, TENTH_NS - 1, count).astype(np.int32),
    )


def attitude(turn_rad_s=0.0):
    found = LiveAttitude(RIG)
    found.extend(samples(START_NS - TENTH_NS, START_NS + 4 * TENTH_NS, turn_rad_s))
    return found


def test_points_are_placed_by_the_pose_and_attitude_of_their_time():
    """The body walks 1 m/s along x and turns by 0.4 rad/s; all points hit one place of the map."""
    level = attitude(0.4)
    R = level.trajectory().at(START_NS + np.linspace(0, TENTH_NS - 1, 50).astype(np.int64)).R
    T = RIG.sensors[1].T_body_sensor
    target = np.array([5.0, 2.0, 1.0])
    p = np.zeros((50, 3))
    p[:, 0] = np.linspace(0.0, 0.1, 50)
    p_body = np.einsum("nji,nj->ni", R, target - p)
    swept = SweptLines(RIG, min_range_m=1.5)
    swept.push(lines(0, (p_body - T.t) @ T.R))

    waits = swept.ready(level)
    swept.add_pose(START_NS - TENTH_NS, 0.0, np.array([-0.1, 0.0]))
    swept.add_pose(START_NS + 2 * TENTH_NS, 0.0, np.array([0.2, 0.0]))
    (placed,) = swept.ready(level)

    assert waits == []
    np.testing.assert_allclose(placed.points, np.tile(target, (50, 1)), atol=2e-3)
    assert placed.from_m == pytest.approx([0.05 - 0.15, 0.0, 0.05], abs=0.02)


def test_the_person_is_not_on_the_map():
    swept = SweptLines(RIG, min_range_m=1.5)
    swept.push(lines(0, [[1.0, 0.0, 0.0]] * 20))
    for k in (-1, 2):
        swept.add_pose(START_NS + k * TENTH_NS, 0.0, np.zeros(2))

    assert swept.ready(attitude()) == []


@pytest.mark.parametrize("poses", [(3, 4), (-20, 2)])
def test_lines_without_poses_of_their_time_are_not_placed(poses):
    swept = SweptLines(RIG, min_range_m=1.5)
    swept.push(lines(0, [[3.0, 0.0, 0.0]] * 20))
    for k in poses:
        swept.add_pose(START_NS + k * TENTH_NS, 0.0, np.zeros(2))

    assert swept.ready(attitude()) == []
    assert not swept._waiting


def room_scan(k):
    """A 2-D laser in the middle of a room of 10 m."""
    angles = np.linspace(-np.pi, np.pi, 361)
    ranges = 5.0 / np.maximum(np.abs(np.cos(angles)), np.abs(np.sin(angles)))
    return LaserScans.of_rows(
        np.array([START_NS + k * TENTH_NS], np.int64),
        ranges[None].astype(np.float32),
        angles=(-np.pi, float(angles[1] - angles[0])),
        range_max_m=30.0,
    )


def test_a_wall_is_covered_only_where_the_profiler_was():
    """The laser sees four walls; the lines sweep only the one behind the body, at x = -5 m."""
    live = ScanMap(RIG, Settings())
    live.extend_imu(samples(START_NS - TENTH_NS, START_NS + 40 * TENTH_NS))
    along, height = np.tile(np.linspace(-4.0, 4.0, 200), 3), np.repeat([0.0, 0.5, 1.0], 200)
    wall = np.stack([np.full(600, 4.85), along, height], axis=1)
    for k in range(30):
        live.sweep(lines(k, wall))
        live.push(room_scan(k))
    first, seen = live._coverage.seen()

    def kinds(x, ys):
        cells = np.floor(np.stack([np.full(len(ys), x), ys], axis=1) / 0.25).astype(int) - first
        return set(seen[tuple(cells.T)].tolist())

    ys = np.arange(-3.5, 3.6, 0.5)
    assert kinds(-4.99, ys) | kinds(-5.01, ys) >= {CoverageClass.WELL}
    assert CoverageClass.WELL not in kinds(4.9, ys) | kinds(5.1, ys)
    assert kinds(3.0, ys) == {CoverageClass.FREE}
    assert len(live._preview) > 300
    assert live._gaps.gaps
