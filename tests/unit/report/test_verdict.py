"""Unobservable stretches, impossible speeds, and the verdict they lead to."""

from dataclasses import replace

import numpy as np
import pytest

from recon4.findings.verdict import verdict_of
from recon4.findings.walk_record import WalkRecord
from recon4.findings.witnesses.rig import rig_findings
from recon4.findings.witnesses.speed import too_fast
from recon4.findings.witnesses.weak_directions import weak_stretches
from recon4.findings.wording import text_of
from recon4.geometry.se3 import SE3
from recon4.model.calibration_figures import CalibrationFigures, ParameterFigures
from recon4.model.figures import FrameFigures
from recon4.model.finding import Finding, Level
from recon4.model.finding_kinds import FindingKind
from recon4.model.odometry_figures import HeightDoubt, OdometryFigures
from recon4.model.support import SurfaceSupport
from recon4.model.trajectory import Trajectory
from recon4.model.usability import Usability
from recon4.pose_graph.uncertainty import HelpfulPoint, PoseUncertainty
from recon4.settings import preset
from tests.said import found_in, judged, texts


def steps(degeneracy, *, direction=(1.0, 0.0, 0.0), lost=None, converged=None):
    """Columns of ``steps.npz`` at 10 Hz."""
    n = len(degeneracy)
    return {
        "t_mid_ns": np.arange(n) * 100_000_000,
        "degeneracy": np.asarray(degeneracy, float),
        "weak_direction": np.tile(direction, (n, 1)) * np.where(np.arange(n) % 2, 1, -1)[:, None],
        "lost": np.zeros(n, bool) if lost is None else lost,
        "converged": np.ones(n, bool) if converged is None else converged,
    }


def corridor(seconds, *, before=20):
    return [0.1] * before + [0.001] * round(10 * seconds) + [0.1] * before


def test_a_corridor_is_found_with_its_time_and_its_direction():
    (found,) = weak_stretches(steps(corridor(5.0)))

    assert (found.start_s, found.end_s) == pytest.approx((2.0, 6.9))
    assert found.degeneracy == pytest.approx(0.001)
    assert abs(found.direction_odom) == pytest.approx([1.0, 0.0, 0.0])
    assert found.horizontal


def test_an_elevator_shaft_is_weak_vertically():
    (found,) = weak_stretches(steps(corridor(5.0), direction=(0.1, 0.0, 0.995)))

    assert not found.horizontal


def test_a_short_gap_does_not_split_a_stretch_and_short_stretches_do_not_count():
    split = corridor(3.0) + corridor(3.0)
    bridged = [0.1] * 20 + [0.001] * 20 + [0.1] * 5 + [0.001] * 20

    assert len(weak_stretches(steps(split))) == 2
    assert len(weak_stretches(steps(bridged))) == 1
    assert weak_stretches(steps(corridor(1.0))) == []


def test_the_first_multiframe_and_lost_ones_are_no_weak_stretch():
    lost = np.zeros(90, bool)
    lost[20:70] = True

    assert weak_stretches(steps([0.0] + [0.1] * 50)) == []
    assert weak_stretches(steps(corridor(5.0), lost=lost)) == []


@pytest.mark.parametrize(("converged", "stretches"), [(True, 0), (False, 1)])
def test_what_did_not_converge_states_too_small_a_deviation(converged, stretches):
    columns = steps([0.1] * 60, converged=np.full(60, converged))
    columns["weak_sd_m"] = np.full(60, 0.04)

    assert len(weak_stretches(columns)) == stretches


def surfaces(count, *, ratio=0.6, sd_m=0.005):
    """What holds each multiframe of line scans."""
    t_ns = np.arange(count) * 100_000_000
    directions = np.tile([1.0, 0.0, 0.0], (count, 1))
    return SurfaceSupport(t_ns, np.full(count, ratio), np.full(count, sd_m), directions)


def silent(count, first, last):
    lost = np.zeros(count, bool)
    lost[first:last] = True
    return lost


@pytest.mark.parametrize(
    ("gaps", "largest_sd_m", "usability"),
    [
        ([(1, 16)], 0.03, Usability.CHECK),
        ([(1, 16)], 0.06, Usability.DO_NOT_USE),  # the positions there are not known
        ([(50, 71)], 0.03, Usability.DO_NOT_USE),  # for more than two seconds
        ([(10, 20), (40, 50), (90, 105)], 0.03, Usability.DO_NOT_USE),  # too often
    ],
)
def test_tracking_lost_for_a_moment_leaves_a_map_to_check(gaps, largest_sd_m, usability):
    lost = np.logical_or.reduce([silent(200, first, last) for first, last in gaps])
    results = replace(uncertain(largest_sd_m), steps=steps([0.1] * 200, lost=lost))

    verdict = judged(results)

    assert verdict.usability is usability
    assert f"Tracking was lost in {lost.sum()} of 200 multiframes" in verdict.reasons[0]


def test_a_profiler_observes_what_a_2d_laser_does_not():
    columns = steps(corridor(30.0))

    assert weak_stretches(columns, surfaces(340)) == []
    (stretch,) = weak_stretches(columns, surfaces(340, sd_m=3.0))
    assert stretch.start_s == pytest.approx(2.0)
    findings = found_in(WalkRecord(steps=columns, support=surfaces(340)))
    assert "the profiler does" in " ".join(texts(findings))


@pytest.mark.parametrize(
    ("there", "usability", "words"),
    [
        ({}, Usability.CHECK, "hold the map"),
        ({"ratio": 0.2}, Usability.DO_NOT_USE, "In 20 of them the profiler saw too little"),
        ({"sd_m": 0.5}, Usability.DO_NOT_USE, "In 20 of them the profiler saw too little"),
    ],
)
def test_a_silent_2d_laser_spoils_a_map_only_if_the_profiler_does_not_hold_it(
    there, usability, words
):
    lost, held = silent(200, 80, 100), surfaces(200)
    seen = surfaces(200, **there)
    held.match_ratio[lost], held.weak_sd_m[lost] = seen.match_ratio[lost], seen.weak_sd_m[lost]
    results = WalkRecord(steps=steps([0.1] * 200, lost=lost), support=held)

    verdict = judged(results)

    assert verdict.usability is usability
    assert words in " ".join(verdict.reasons)
    assert "20 of 200 multiframes" in " ".join(verdict.reasons)


def test_files_of_earlier_versions_have_no_direction():
    columns = steps(corridor(5.0))
    del columns["weak_direction"]

    (found,) = weak_stretches(columns)

    assert np.isnan(found.direction_odom).all()


def walk(speed_m_s, *, seconds=10):
    t_s = np.arange(0.0, seconds, 0.1)
    t_m = np.stack([speed_m_s * t_s, 0 * t_s, 0 * t_s], axis=1)
    R = np.tile(np.eye(3), (len(t_s), 1, 1))
    return Trajectory((t_s * 1e9).astype(np.int64), SE3(R, t_m))


def test_a_person_does_not_walk_at_thirteen_meters_a_second():
    assert too_fast(walk(1.5)) is None

    found = too_fast(walk(13.0))

    assert found.fastest_m_s == pytest.approx(13.0)
    assert found.seconds == 9


@pytest.mark.parametrize(
    ("results", "usability", "reason"),
    [
        (WalkRecord(steps=steps([0.1] * 50)), Usability.GOOD, ""),
        (WalkRecord(steps=steps(corridor(5.0))), Usability.CHECK, "Between 2 s and 7 s"),
        (WalkRecord(steps=steps(corridor(30.0))), Usability.DO_NOT_USE, "a horizontal direction"),
        (
            WalkRecord(
                steps=steps(corridor(30.0)),
                georeference={"georeference": {"georeferenced": True}},
            ),
            Usability.CHECK,
            "GNSS",
        ),
        (
            WalkRecord(steps=steps([0.1] * 50, converged=np.arange(50) < 20)),
            Usability.DO_NOT_USE,
            "converged in only 20 of 50",
        ),
        (WalkRecord(odometry=walk(13.0)), Usability.DO_NOT_USE, "13.0 m/s"),
    ],
)
def test_what_makes_a_map_unusable_is_announced(results, usability, reason):
    verdict = judged(results)

    assert verdict.usability is usability
    assert reason in " ".join(verdict.reasons)


@pytest.mark.parametrize(
    ("count", "heights", "usability"),
    [
        ("gnss_heights_unstated", "as_recorded", Usability.CHECK),
        ("gnss_heights_orthometric", "as_recorded", Usability.DO_NOT_USE),
        ("gnss_heights_unstated", "ellipsoidal", Usability.GOOD),
        ("gnss_samples", "as_recorded", Usability.GOOD),
    ],
)
@pytest.mark.parametrize("georeferenced", [True, False])
def test_heights_that_may_be_above_sea_level_are_announced(
    count, heights, usability, georeferenced
):
    settings = preset("outdoor")
    results = WalkRecord(
        imported={"counts": {count: 201}},
        steps=steps([0.1] * 50),
        georeference={"georeference": {"georeferenced": georeferenced}},
    )

    given = replace(settings, gnss=replace(settings.gnss, heights=heights))
    verdict = judged(results, given)

    assert verdict.usability is (usability if georeferenced else Usability.GOOD)
    assert len(verdict.reasons) == int(verdict.usability is not Usability.GOOD)


def uncertain(largest_sd_m: float, *, point_sd_m: float = 0.01) -> WalkRecord:
    """A walk of 13.5 m whose last pose is known least."""
    final = walk(1.5)
    sd_m = np.linspace(0.001, largest_sd_m, len(final))
    cov = np.zeros((len(final), 6, 6))
    cov[:, 3, 3] = sd_m**2
    helpful = HelpfulPoint(7_000_000_000, 9_000_000_000, point_sd_m)
    known = PoseUncertainty(final.t_ns, cov, False, cov[:, 3:, 3:], helpful)
    return WalkRecord(final=final, uncertainty=known)


@pytest.mark.parametrize(
    ("largest_sd_m", "usability", "words"),
    [
        (0.03, Usability.GOOD, "the shape of the map is known to ± 3.5 cm (2σ)"),
        (0.06, Usability.DO_NOT_USE, "the shape of the map is known to ± 7.0 cm (2σ)"),
    ],
)
def test_a_direction_that_no_lidar_observes_is_no_fault_where_something_else_holds_it(
    largest_sd_m, usability, words
):
    walked = replace(uncertain(largest_sd_m), steps=steps(corridor(30.0)))

    found = found_in(walked)

    (weak,) = [one for one in found if one.kind is FindingKind.WEAK_DIRECTION]
    assert verdict_of(found).usability is usability
    assert words in text_of(weak)


@pytest.mark.parametrize(
    ("imu", "level"), [(False, Level.NOTE), (True, Level.CHECK)], ids=["no IMU", "an IMU"]
)
def test_a_map_that_is_not_leveled_is_a_fault_only_if_an_imu_could_have_done_it(imu, level):
    frames = FrameFigures(multiframes=9, points=900, rig="rig", imu=imu, gnss=False)

    found = found_in(WalkRecord(frames=frames, georeference={"levelling": {"source": "none"}}))

    assert [one.level for one in found if one.kind is FindingKind.NOT_LEVELED] == [level]


def off(sensor, quantity, change):
    unit = {"rotation": "rad", "clock": "s", "position": "m"}[quantity]
    return ParameterFigures(
        sensor=sensor, quantity=quantity, axis="z", unit=unit, change=change, sd=1e-4, status="off"
    )


@pytest.mark.parametrize(
    ("rows", "level"),
    [
        ([off("imu", "rotation", 0.0031)], Level.NOTE),  # 0.18°
        ([off("imu", "rotation", 0.0031), off("imu", "clock", -0.002)], Level.NOTE),
        ([off("imu", "rotation", 0.0031), off("imu", "clock", -0.006)], Level.CHECK),
        ([off("imu", "rotation", 0.006)], Level.CHECK),  # it tilts a leveled map by 0.34°
        ([off("imu", "rotation", 0.02)], Level.DO_NOT_USE),
        ([off("imu", "position", 0.02)], Level.CHECK),
        ([off("vertical", "rotation", 0.0031)], Level.CHECK),
    ],
)
def test_what_the_odometry_corrects_of_an_imu_is_no_fault_of_the_map(rows, level):
    (found,) = rig_findings(CalibrationFigures(parameters=tuple(rows)))

    assert found.level is level


def test_each_sensor_has_the_level_of_its_own_errors():
    rows = (off("vertical", "rotation", 0.03), off("imu", "rotation", 0.0031))

    found = rig_findings(CalibrationFigures(parameters=rows))

    assert {one.sensor: one.level for one in found} == {
        "vertical": Level.DO_NOT_USE,
        "imu": Level.NOTE,
    }


@pytest.mark.parametrize(
    ("largest_sd_m", "usability"),
    [
        (0.055, Usability.GOOD),  # RMS 3.2 cm; twice that may be 5 cm and 0.1 % of 14.9 m
        (0.058, Usability.CHECK),
        (0.550, Usability.CHECK),
        (0.580, Usability.DO_NOT_USE),
    ],
)
def test_positions_that_are_not_known_are_announced(largest_sd_m, usability):
    verdict = judged(uncertain(largest_sd_m))

    assert verdict.usability is usability


def test_the_control_point_that_helps_most_is_proposed():
    (reason,) = judged(uncertain(0.2)).reasons
    (nothing_helps,) = judged(uncertain(0.2, point_sd_m=0.19)).reasons
    (lost,) = judged(uncertain(500.0)).reasons

    assert "known to ± 40.0 cm (2σ) relative to the start at worst, 10 s after the start" in reason
    assert "A control point between 7 s and 9 s would reduce this to ± 2.0 cm." in reason
    assert "control point" not in nothing_helps
    assert "more than 100 m" in lost


def test_a_map_nothing_is_known_of_is_not_good():
    assert verdict_of([]).usability is Usability.CHECK
    assert "could be checked" in verdict_of([]).reasons[0]
    assert verdict_of([Finding(kind=FindingKind.TRACKING_KEPT, level=Level.GOOD)]).reasons == ()


@pytest.mark.parametrize(
    ("rise_m", "usability"), [(3.4, Usability.DO_NOT_USE), (0.6, Usability.CHECK)]
)
def test_heights_that_are_wrong_by_meters_forbid_the_map(rise_m, usability):
    ride = HeightDoubt(start_s=3.0, end_s=9.0, rise_m=rise_m)
    figures = OdometryFigures(multiframes=100, lost=0, heights=(ride,))

    verdict = judged(WalkRecord(odometry_figures=figures))

    assert verdict.usability is usability
    assert f"a ride of about {rise_m:.1f} m up" in verdict.reasons[0]
