"""Times of a recording whose clocks were set ahead, without the jump."""

import numpy as np
import pytest

from recon4.model.clock_jump import ClockJump
from recon4.model.derived_kinds import DerivedKind
from recon4.model.samples import ImuSamples
from recon4.progress import Silent
from recon4.recording.clocks.jumps import exact_length_ns, samples_without_jumps, without_jumps
from recon4.recording.clocks.stamps import StampClock, StampJumps
from recon4.recording.ingest import ingest
from recon4.recording.report import ImportReport
from recon4.recording.sources import Sources
from recon4.settings import IngestSettings
from recon4.store.frames import FrameStore
from recon4.units import SECOND_NS
from tests.builders import T0_NS, Bag, bag_path, noisy, room_cloud
from tests.unit.recording.ingested import frame_folder
from tests.warned import K, derivations, kinds, warned

STEP_NS = 100_000_000
SET_NS = 37 * SECOND_NS


def write_bag(path, set_ns, *, recorded_too):
    """1.6 s of clouds and IMU; the clocks are set in the middle."""
    with Bag(path, "mcap") as bag:
        for k in range(16):
            late_ns = set_ns * (k >= 8)
            t_ns = T0_NS + k * STEP_NS
            for m in range(10):
                at_ns = t_ns + m * STEP_NS // 10
                bag.recorded_ns = at_ns + late_ns * recorded_too
                gyro, accel = (noisy((0.0, 0.0, z), 10 * k + m) for z in (0.1, 9.8))
                bag.imu("/imu", at_ns + late_ns, gyro, accel)
            bag.cloud("/points", t_ns + late_ns, room_cloud())
    return path


def read(path, out, jumps=()):
    sources = Sources((path,), jumps=jumps)
    ingest(sources, out, settings=IngestSettings(), progress=Silent())
    return FrameStore.open(out)


def is_even(store):
    """Whether multiframes and IMU follow each other without a gap, at the same times."""
    starts = store.index["t_ns"].astype(np.int64)
    apart_ns = abs(int(store.imu.t_ns[-1]) - int(starts[-1]))
    return np.all(np.diff(starts) == STEP_NS) and apart_ns < 2 * STEP_NS


def test_a_recording_is_read_without_a_jump_of_all_its_clocks(tmp_path):
    path = write_bag(tmp_path / "bag", SET_NS, recorded_too=True)
    before = read(path, tmp_path / "a")
    # As measured from the last point to the first one.
    jump = ClockJump(T0_NS + 8 * STEP_NS - 300_000, SET_NS + 300_000)

    store = read(path, tmp_path / "b", (jump,))

    assert K.TIME_GAP in kinds(before.report) and not is_even(before)
    assert K.TIME_GAP not in kinds(store.report) and is_even(store)
    assert len(store.imu) == 160 and store.points == before.points
    assert store.report["counts"]["clock_jumps"] == 1 and not store.report["gaps"]
    (said,) = [one for one in store.report["derived"] if one["kind"] == DerivedKind.CLOCKS_SET]
    assert said["values"]["looks"] == "tai-utc" and said["values"]["jump_s"] == 37.0


def test_a_folder_of_frames_is_read_without_a_jump(tmp_path):
    folder = frame_folder(tmp_path / "f", [f"{k}.pcd" for k in range(8)])
    times = [0.1 * k + 37.0 * (k >= 4) for k in range(8)]
    (folder / "times.txt").write_text("".join(f"{t:.3f}\n" for t in times))

    store = read(folder, tmp_path / "o", (ClockJump(400_000_000, SET_NS),))

    assert np.diff(store.index["t_ns"].astype(np.int64)).tolist() == [STEP_NS] * 7
    assert not store.report["gaps"] and K.TIME_GAP not in kinds(store.report)


def test_samples_measured_within_a_jump_keep_their_times():
    jump = ClockJump(T0_NS, SET_NS)
    t_ns = T0_NS + np.arange(-5, 45) * SECOND_NS
    steady = ImuSamples(t_ns, np.zeros((50, 3)), np.zeros((50, 3)))
    rows = np.r_[:6, 43:50]
    jumped = ImuSamples(t_ns[rows], np.zeros((13, 3)), np.zeros((13, 3)))

    assert samples_without_jumps(steady, [jump]).t_ns.tolist() == t_ns.tolist()
    assert np.diff(samples_without_jumps(jumped, [jump]).t_ns).tolist() == [SECOND_NS] * 12


@pytest.mark.parametrize(("measured_s", "exact_s"), [(37.003, 37.0), (-18.02, -18.0), (9.4, 9.4)])
def test_a_jump_near_a_known_difference_of_clocks_is_that(measured_s, exact_s):
    length_ns = round(measured_s * SECOND_NS)

    assert exact_length_ns(ClockJump(0, length_ns)) == round(exact_s * SECOND_NS)


def test_every_jump_counts_for_the_times_after_it():
    jumps = [ClockJump(10, 100), ClockJump(200, 50)]

    assert without_jumps(np.array([5, 10, 110, 200, 250]), jumps).tolist() == [5, 10, 10, 100, 100]


@pytest.mark.parametrize("set_s", [37, -18])
def test_stamps_that_jump_against_the_times_of_recording_go_on_without_it(tmp_path, set_s):
    path = write_bag(tmp_path / "bag", set_s * SECOND_NS, recorded_too=False)

    store = read(path, tmp_path / "o")

    assert is_even(store) and not store.report["gaps"]
    assert warned(store.report, K.CLOCK_JUMP, whose="sensor", jump_s=float(set_s))
    assert store.report["counts"]["clock_jumps"] == 1  # of both topics


def test_stamps_that_go_on_while_the_recorder_pauses_are_right():
    clock = StampClock([(T0_NS, T0_NS)])
    times = [
        (T0_NS + k * STEP_NS, T0_NS + k * STEP_NS + 60 * SECOND_NS * (k > 3)) for k in range(8)
    ]

    assert all(clock.is_sound(stamp_ns, recorded_ns) for stamp_ns, recorded_ns in times)
    assert clock.shift_ns == 0


@pytest.mark.parametrize("kind", ["bag1", "mcap", "db3"])
def test_a_bag_that_was_recorded_backward_is_read_from_its_end(tmp_path, kind):
    paths = [bag_path(tmp_path / name, kind) for name in ("on", "back")]
    for path, sign in zip(paths, (1, -1), strict=True):
        path.parent.mkdir()
        with Bag(path, kind) as bag:
            for k in range(12)[::sign]:
                bag.recorded_ns = T0_NS + STEP_NS * (k if sign > 0 else 11 - k)
                bag.cloud("/points", T0_NS + k * STEP_NS, room_cloud(start_turn=0.01 * k))
                for part in range(3)[::sign]:
                    stamp = T0_NS + k * STEP_NS + part * STEP_NS // 4
                    bag.imu("/imu", stamp, (0.01 * k, 0.0, part), (0.0, 0.0, 9.8 + 0.01 * k))

    on, back = (read(path, tmp_path / name) for path, name in zip(paths, "ab", strict=True))

    assert "Its 48 messages are read from the last to the first" in " ".join(
        derivations(back.report)
    )
    assert back.index["t_ns"].tolist() == on.index["t_ns"].tolist()
    assert back.report["counts"] == on.report["counts"]
    assert all(np.array_equal(a.xyz, b.xyz) for a, b in zip(on, back, strict=True))
    assert np.array_equal(on.imu.t_ns, back.imu.t_ns)


def test_a_message_on_its_way_when_all_clocks_are_set_changes_nothing():
    clock = StampClock([(T0_NS, T0_NS)])
    jumps = [(0, 0), (0, 0), (0, 0), (0, SET_NS), *[(SET_NS, SET_NS)] * 5]
    times = [
        (T0_NS + k * STEP_NS + stamps_ns, T0_NS + k * STEP_NS + recorded_ns)
        for k, (stamps_ns, recorded_ns) in enumerate(jumps)
    ]

    assert all(clock.is_sound(stamp_ns, recorded_ns) for stamp_ns, recorded_ns in times)
    assert clock.shift_ns == 0


def test_topics_share_a_jump_that_is_measured_a_little_differently():
    report, jumps = ImportReport(), StampJumps()

    found = [jumps.exact_ns("/a", ns, report) for ns in (9_400_000_000, 9_412_000_000)]

    assert found == [9_400_000_000] * 2 and report.counts["clock_jumps"] == 1
