"""Shots to multiframes: cuts, clocks, gaps, silent sensors."""

import time
import tracemalloc
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from recon4.errors import ConfigError
from recon4.model.beams import BeamCorrections
from recon4.model.rig import load_rig
from recon4.recording.assembly.assembler import Assembler, moved
from recon4.recording.assembly.range_limits import drop_invalid
from recon4.recording.assembly.rotation_rate import nominal, rotation_of_head, rotation_rate
from recon4.recording.assembly.shots import Shots
from recon4.recording.report import ImportReport
from recon4.settings import IngestSettings
from tests.builders import T0_NS, spin
from tests.warned import K, derivations, warned

SETTINGS = IngestSettings(min_range_m=0.5)


def rows(shots, chosen):
    names = ("t_ns", "xyz", "intensity", "ring", "echo")
    return Shots(shots.sensor, *(getattr(shots, name)[chosen] for name in names))


def pieces(shots, count=25):
    edges = np.linspace(0, len(shots), count + 1).astype(int)
    return [rows(shots, slice(a, b)) for a, b in pairwise(edges)]


def assemble(streams, *, rig="single-vlp16", settings=SETTINGS, **options):
    """Feed pieces in the order of their times."""
    report = ImportReport()
    assembler = Assembler(load_rig(rig), settings=settings, report=report, **options)
    frames = [frame for shots in streams for frame in assembler.push(shots)]
    return frames + assembler.flush(), assembler, report


def merged(*streams):
    return sorted((p for s in streams for p in pieces(s)), key=lambda p: int(p.t_ns[0]))


def test_one_revolution_becomes_one_frame():
    shots = spin(seconds=1.0)

    frames, assembler, report = assemble(pieces(shots))

    assert [len(frame) for frame in frames] == [len(shots) // 10] * 10
    assert [frame.frame_id for frame in frames] == list(range(10))
    assert [frame.t_ns - T0_NS for frame in frames] == [k * 100_000_000 for k in range(10)]
    assert assembler.rotation_hz["lidar"] == pytest.approx(10.0, abs=0.02)
    assert any("10 Hz" in text for text in derivations(report))


def test_no_point_is_lost_or_changed():
    shots = spin(seconds=0.95)

    frames, _, _ = assemble(pieces(shots, 7))

    np.testing.assert_array_equal(np.concatenate([f.xyz for f in frames]), shots.xyz)
    times = np.concatenate([f.t_ns + f.dt_ns.astype(np.int64) for f in frames])
    np.testing.assert_array_equal(times, shots.t_ns)


def test_corrections_of_beams_in_the_rig_file_are_applied():
    shots, rig = spin(seconds=0.5), load_rig("single-vlp16")
    beams = BeamCorrections.of(np.full((3, 8), 0.01))
    sensor = replace(rig.sensors[0], beams=beams)
    report = ImportReport()
    assembler = Assembler(replace(rig, sensors=(sensor,)), settings=SETTINGS, report=report)

    frames = [*assembler.push(shots), *assembler.flush()]

    expected, unknown = beams.apply(shots.xyz, shots.ring)
    np.testing.assert_array_equal(np.concatenate([f.xyz for f in frames]), expected)
    assert 0 < unknown == report.counts["points_of_beams_without_correction"]
    assert not np.array_equal(expected, shots.xyz)


def test_a_faster_sensor_is_cut_at_its_own_rate():
    frames, _, _ = assemble(pieces(spin(seconds=1.0, rate_hz=20.0)))

    assert len(frames) == 20
    assert frames[0].duration_ns == 50_000_000


def test_two_sensors_are_cut_by_the_slower():
    fast, slow = spin(rate_hz=20.0), spin(sensor=1, rate_hz=10.0)

    frames, _, _ = assemble(merged(fast, slow), rig="4recon")

    assert len(frames) == 10
    assert all(set(f.sensor.tolist()) == {0, 1} for f in frames)


def test_a_rate_that_splits_revolutions_is_said():
    frames, _, report = assemble(
        pieces(spin(rate_hz=10.0)), settings=replace(SETTINGS, rate_hz=15.0)
    )

    assert len(frames) == 15
    assert warned(report, K.RATE_UNFIT)


def test_frames_are_given_out_while_reading():
    assembler = Assembler(load_rig("single-vlp16"), settings=SETTINGS, report=ImportReport())

    given = [len(assembler.push(p)) for p in pieces(spin(seconds=4.0), 40)]

    assert given[-1] >= 1
    assert sum(given) >= 37


def test_a_silent_sensor_does_not_hold_the_frames_up():
    report = ImportReport()
    assembler = Assembler(load_rig("4recon"), settings=SETTINGS, report=report, wait_s=1.0)

    given = [len(assembler.push(p)) for p in pieces(spin(seconds=5.0), 50)]

    assert sum(given) >= 37
    assert report.counts["frames_without_vertical"] >= 37


def test_a_sensor_that_falls_silent_is_counted():
    frames, _, report = assemble(
        merged(spin(seconds=4.0), spin(sensor=1, seconds=2.0)), rig="4recon", wait_s=1.0
    )

    assert len(frames) == 40
    assert report.counts["frames_without_vertical"] == 20


def test_batches_of_one_sensor_at_a_time_lose_nothing():
    first, second = spin(seconds=6.0), spin(sensor=1, seconds=6.0)
    streams = [p for pair in zip(pieces(first, 2), pieces(second, 2), strict=True) for p in pair]

    frames, _, report = assemble(streams, rig="4recon")

    assert sum(len(f) for f in frames) == len(first) + len(second)
    assert report.counts["points_late"] == 0


def test_a_gap_is_a_value_with_its_time_and_frames_go_on_without_holes():
    shots = spin(seconds=3.0)
    t_s = (shots.t_ns - T0_NS) / 1e9
    shots = rows(shots, (t_s < 1.0) | (t_s >= 2.0))

    frames, assembler, report = assemble(pieces(shots))

    (gap,) = assembler.gaps
    assert gap.seconds == pytest.approx(1.0, abs=0.01)
    assert (gap.t_ns - T0_NS) / 1e9 == pytest.approx(1.0, abs=0.01)
    assert [f.frame_id for f in frames] == list(range(20))
    assert frames[10].t_ns - T0_NS == 2_000_000_000
    assert report.counts["frames_empty"] == 10


def test_a_clock_that_goes_back_an_hour_is_carried_on():
    before, after = spin(seconds=1.0), spin(seconds=1.0, t0_ns=T0_NS - 3600 * 10**9)

    frames, assembler, report = assemble([*pieces(before), *pieces(after)])

    assert report.counts["clock_jumps_back"] == 1
    assert assembler.gaps[0].seconds == pytest.approx(-3601.0, abs=0.1)
    assert sum(len(f) for f in frames) == len(before) + len(after)
    starts = [f.t_ns for f in frames]
    assert (np.diff(starts) > 0).all()
    assert starts[-1] - starts[0] < 2_100_000_000


def test_sensors_whose_clocks_jump_together_stay_together():
    hour = 3600 * 10**9
    streams = merged(spin(seconds=1.0), spin(sensor=1, seconds=0.85))
    late = T0_NS + 1_000_000_000 - hour
    streams += merged(
        spin(seconds=1.05, t0_ns=late), spin(sensor=1, seconds=1.05, t0_ns=late + 2_000_000)
    )

    frames, _, report = assemble(streams, rig="4recon")

    assert report.counts["clock_jumps_back"] == 2
    ends = [
        max(f.t_ns + int(f.dt_ns[f.sensor == k].max()) for f in frames if k in f.sensor)
        for k in (0, 1)
    ]
    assert ends[1] - ends[0] == pytest.approx(2_000_000, abs=300_000)


@pytest.mark.parametrize(
    ("ahead_s", "words"),
    [
        (3600, r"vertical is ahead of horizontal by \+3600\.000 s \(whole hours"),
        (37.1, r"\+37\.100 s \(TAI against UTC\)\. In the rig file give vertical .* = -37\.000"),
        (-37, r"-37\.000 s \(TAI against UTC\).* vertical time_offset_s = 37\.000"),
        (25, r"by \+25\.000 s\. In the rig file give vertical time_offset_s = about -25\.000"),
    ],
)
def test_clocks_that_have_nothing_in_common_are_refused_with_their_name_and_remedy(ahead_s, words):
    late_ns = T0_NS + round(ahead_s * 1e9)
    with pytest.raises(ConfigError, match=words):
        assemble(
            [spin(seconds=2.0), spin(sensor=1, seconds=2.0, t0_ns=late_ns)],
            rig="4recon",
        )


def test_scraps_at_the_ends_are_left_out_and_counted():
    main = spin(seconds=1.0)
    first = rows(main, np.r_[0:50, len(main) // 10 : len(main)])
    tail = rows(moved(main, 1_000_000_000), slice(0, 50))

    frames, _, report = assemble([first, tail])

    assert [f.frame_id for f in frames] == list(range(9))
    assert report.counts["frames_incomplete_dropped"] == 2
    assert report.counts["points_of_incomplete_frames"] == 100


def test_what_is_left_of_a_missing_cloud_makes_no_frame():
    """Clouds do not begin where frames do: some points of their neighbors lie in the gap."""
    first, *clouds = pieces(spin(seconds=1.0), 10)
    first = rows(first, slice(len(first) // 10, None))
    clouds[7] = rows(clouds[7], slice(0, None, 20))  # few points, but of the whole time

    frames, _, report = assemble([first, *clouds[:3], *clouds[4:]])

    assert len(frames) == 9
    assert all(len(frame) > 0.04 * len(frames[0]) for frame in frames)
    assert report.counts["frames_incomplete_dropped"] == 1


def test_half_a_revolution_at_the_end_is_kept():
    frames, _, _ = assemble(pieces(spin(seconds=1.05)))

    assert len(frames) == 11
    assert len(frames[-1]) == pytest.approx(len(frames[0]) / 2, rel=0.05)


def test_bad_points_are_dropped_by_reason():
    shots = spin(seconds=0.1)
    xyz = shots.xyz.copy()
    xyz[0], xyz[1], xyz[2], xyz[3], xyz[4] = np.nan, np.inf, 0.0, 0.1, 500.0
    report = ImportReport()

    kept = drop_invalid(
        Shots(0, shots.t_ns, xyz, shots.intensity, shots.ring, shots.echo),
        settings=SETTINGS,
        report=report,
    )

    assert len(kept) == len(shots) - 5
    expected = {"points_invalid": 3, "points_near": 1, "points_far": 1}
    assert report.counts == expected


@pytest.mark.parametrize(
    ("model", "range_m", "dropped"),
    [
        ("Avia", 0.9, {"points_blind": 1}),  # it measures from 1 m on
        ("Avia", 1.1, {}),
        ("VLP-16", 0.9, {}),
        ("Avia", 0.3, {"points_near": 1}),  # of the carrier
        ("VLP-16", 0.3, {"points_near": 1}),
    ],
)
def test_points_nearer_than_their_lidar_measures_well_are_dropped(model, range_m, dropped):
    rig, report, shots = load_rig("single-vlp16"), ImportReport(), spin(seconds=0.1)
    rig = replace(rig, sensors=(replace(rig.sensors[0], model=model),))
    shots.xyz[7] = [range_m, 0.0, 0.0]

    Assembler(rig, settings=SETTINGS, report=report).push(shots)

    assert report.counts == dropped


def test_nothing_in_gives_nothing_out():
    assert assemble([])[0] == []


@pytest.mark.parametrize("rate_hz", [5.0, 9.04, 10.0, 11.775, 20.0])
def test_the_rotation_is_measured_with_half_of_the_view_blocked(rate_hz):
    shots = spin(seconds=0.8, rate_hz=rate_hz)
    seen = rows(shots, shots.xyz[:, 0] > 0.5)

    assert rotation_rate(seen.t_ns, seen.xyz) == pytest.approx(rate_hz, rel=0.002)


def test_a_damaged_time_far_before_the_others_does_not_change_the_rotation():
    """Nor does it take minutes: the longer the time, the finer the rates that are compared."""
    shots = spin(seconds=0.8, rate_hz=11.775)
    shots.t_ns[0] -= 5 * 10**12

    begun_s = time.process_time()
    assert rotation_rate(shots.t_ns, shots.xyz) == pytest.approx(11.775, rel=0.002)
    assert time.process_time() - begun_s < 2.0


def test_a_sensor_that_does_not_turn_has_no_rate():
    rng = np.random.default_rng(5)
    t_ns = np.sort(rng.integers(0, 10**9, 5000))

    assert np.isnan(rotation_rate(t_ns, rng.normal(size=(5000, 3)).astype(np.float32)))


def test_the_rotation_of_the_head_is_measured_without_a_copy_of_its_points():
    shots = spin(seconds=1.5)
    head = rows(shots, shots.t_ns <= shots.t_ns[0] + 10**9)
    parts = [rows(shots, slice(0, 0)), *pieces(shots)]

    tracemalloc.start()
    rate_hz = rotation_of_head(parts, 10**9)
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()

    assert rate_hz == rotation_rate(head.t_ns, head.xyz)
    assert most < 8 * len(shots)  # all points and times: 20 bytes, and as much for the head


def test_the_frames_of_the_first_second_are_made_one_by_one():
    assembler = Assembler(load_rig("single-vlp16"), settings=SETTINGS, report=ImportReport())
    shots = spin(seconds=2.0)

    frames = assembler.pushed(shots)
    first = next(frames)

    assert first.frame_id == 0
    left = sum(map(len, assembler._streams[0].waiting))
    assert left == len(shots) - 2 * len(first), "that, and the one that shows that it is whole"
    assert len(list(frames)) > 10


@pytest.mark.parametrize(("kept", "gaps"), [(range(0, 40, 3), 0), ((0, 3, 6, 9, 12, 21, 24), 6)])
def test_clouds_that_were_left_out_evenly_are_one_statement(kept, gaps):
    parts = pieces(spin(seconds=4.0), 40)

    _, assembler, report = assemble([parts[k] for k in kept])

    assert len(assembler.gaps) == report.counts["gaps"] == gaps
    assert warned(report, K.TIME_GAP, sensor="lidar") == bool(gaps)
    stated = [
        text for text in derivations(report) if "nothing for 0.200 s of every 0.300 s" in text
    ]
    assert len(stated) == (not gaps)


def test_a_frame_is_given_as_soon_as_it_is_cut():
    assembler = Assembler(load_rig("single-vlp16"), settings=SETTINGS, report=ImportReport())

    parts = pieces(spin(seconds=2.0), 20)

    given = [[frame.frame_id for frame in assembler.push(part)] for part in parts]

    assert given[-1] == [18]
    assert [frame.frame_id for frame in assembler.flush()] == [19]


@pytest.mark.parametrize("seconds", [0.031, 0.04, 0.08])
def test_a_wall_in_front_for_a_moment_gives_no_rate_out_of_range(seconds):
    t_ns = np.linspace(0, seconds * 1e9, 801).astype(np.int64)
    y = np.random.default_rng(3).uniform(-4.0, 4.0, 801)
    rate_hz = rotation_rate(t_ns, np.column_stack([np.full(801, 6.0), y, 0 * y]).astype(np.float32))

    assert np.isnan(rate_hz) or 1.0 < rate_hz < 31.0


def test_a_pattern_that_does_not_repeat_is_cut_by_time():
    turning = spin(seconds=1.0, rate_hz=7.0)
    pattern = load_rig("single-vlp16")
    pattern = replace(pattern, sensors=(replace(pattern.sensors[0], model="Mid-360"),))
    assembler = Assembler(pattern, settings=SETTINGS, report=ImportReport())
    assembler.push(turning)
    assembler.flush()

    assert assembler.duration_ns == 100_000_000


def test_a_rate_near_a_whole_number_is_that_number():
    assert (nominal(9.98), nominal(11.775)) == (10.0, 11.775)
