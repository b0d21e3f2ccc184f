"""Frame store: what is written is what is read, and damage is refused."""

import errno
import pickle
import resource
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest

from recon4.errors import NoSpace, StoreError
from recon4.model.hidden_points import HiddenPoints
from recon4.model.imu_repair import IMU_REPAIR, ImuRepair
from recon4.model.multiframe import COLUMNS, Multiframe
from recon4.model.rig import load_rig
from recon4.model.samples import ImuSamples
from recon4.store.arrays import save_record
from recon4.store.earlier_frames import EARLIER_INDEX
from recon4.store.frames import POINTS, FrameStore, FrameWriter, open_frames
from recon4.store.imu_repair import FORCES_REVERSED
from tests.deadlines import HANG_S


def multiframe(frame_id, count, rng):
    columns = {
        name: rng.integers(0, 200, (count, width) if width > 1 else count).astype(dtype)
        for name, (dtype, width) in COLUMNS.items()
    }
    return Multiframe(frame_id, frame_id * 100_000_000, 100_000_000, **columns)


@pytest.fixture
def written(tmp_path):
    rng = np.random.default_rng(1)
    frames = [multiframe(0, 5, rng), multiframe(1, 0, rng), multiframe(2, 7, rng)]
    imu = ImuSamples(np.array([1, 2], np.int64), np.ones((2, 3)), np.zeros((2, 3)))
    with FrameWriter(tmp_path / "store", load_rig("4recon")) as writer:
        for frame in frames:
            writer.append(frame)
        writer.add(imu=imu, report={"derived": ["ring"]})
    return tmp_path / "store", frames


def test_frames_come_back_as_they_were(written):
    folder, frames = written

    store = FrameStore.open(folder)

    assert len(store) == 3
    assert store.points == 12
    for before, after in zip(frames, store, strict=True):
        assert (after.frame_id, after.t_ns) == (before.frame_id, before.t_ns)
        for name in COLUMNS:
            np.testing.assert_array_equal(getattr(after, name), getattr(before, name))


def test_imu_gnss_and_report_are_read_back(written):
    store = FrameStore.open(written[0])

    assert store.t_mid_ns.tolist() == [50_000_000, 150_000_000, 250_000_000]
    assert store.rig.name == "4RECON"
    assert store.imu is not None
    assert len(store.imu) == 2
    assert store.gnss is None
    assert store.report == {"derived": ["ring"]}


def stored(folder, *frames):
    with FrameWriter(folder, load_rig("4recon")) as writer:
        for frame in frames:
            writer.append(frame)
    return FrameStore.open(folder)


@pytest.mark.parametrize("scale_m", [1.0, 100.0, 2e4, 3e9])
def test_coordinates_are_kept_to_a_quarter_of_a_millimeter_and_the_rest_exactly(tmp_path, scale_m):
    rng = np.random.default_rng(2)
    columns = {
        name: rng.integers(0, 256, 300).astype(dtype) for name, (dtype, _) in COLUMNS.items()
    }
    columns["xyz"] = (scale_m * rng.normal(size=(300, 3))).astype(np.float32)
    columns["intensity"] = rng.integers(0, 1 << 16, 300).astype(np.uint16)
    columns["dt_ns"] = rng.integers(-(1 << 31), 1 << 31, 300).astype(np.int32)
    frame = Multiframe(0, 0, 1, **columns)

    back = stored(tmp_path / "store", frame)[0]

    # Beyond 16 km a float32 itself is coarser than the steps.
    step_m = max(2.0**-11, 8.0 * scale_m * 2.0**-31)
    off_m = np.abs(back.xyz.astype(np.float64) - frame.xyz).max()
    assert off_m <= step_m / 2.0 + 1e-7 * scale_m
    for name in COLUMNS.keys() - {"xyz"}:
        np.testing.assert_array_equal(getattr(back, name), getattr(frame, name))


def test_what_is_read_is_stored_again_as_the_same_bytes(tmp_path):
    rng = np.random.default_rng(3)
    frame = multiframe(0, 50, rng)
    xyz = rng.normal(size=(50, 3)).astype(np.float32)

    once = stored(tmp_path / "once", replace(frame, xyz=xyz))
    stored(tmp_path / "twice", once[0])

    first, second = ((tmp_path / name / POINTS).read_bytes() for name in ("once", "twice"))
    assert first == second


def test_points_of_a_scan_take_a_fifth_of_their_size(tmp_path):
    """A wall at 5 m with 15 mm of noise, seen by 16 beams."""
    rng = np.random.default_rng(4)
    ring = np.tile(np.arange(16, dtype=np.uint8), 1800)
    az = np.repeat(np.linspace(-0.8, 0.8, 1800), 16)
    range_m = 5.0 / np.cos(az) + rng.normal(0.0, 0.015, len(az))
    el = np.deg2rad(2.0 * ring - 15.0)
    along = range_m * np.cos(el)
    xyz = np.column_stack([along * np.cos(az), along * np.sin(az), range_m * np.sin(el)])
    zero = np.zeros(len(ring), np.uint8)
    dt_ns = (np.arange(len(ring)) * 2304).astype(np.int32)
    intensity = rng.integers(30, 60, len(ring)).astype(np.uint16)
    frame = Multiframe(0, 0, 1, xyz.astype(np.float32), intensity, ring, zero, zero, dt_ns)

    stored(tmp_path / "store", frame)

    assert (tmp_path / "store" / POINTS).stat().st_size < 4.5 * len(frame)


@pytest.fixture
def earlier(written):
    """The same multiframes as an earlier version stored them."""
    folder, frames = written
    (folder / POINTS).unlink()
    index = np.load(folder / "index.npy")[list(EARLIER_INDEX.names)]
    np.save(folder / "index.npy", index.astype(EARLIER_INDEX))
    for name in COLUMNS:
        np.save(folder / f"{name}.npy", np.concatenate([getattr(f, name) for f in frames]))
    return written


def test_multiframes_of_an_earlier_version_are_read(earlier):
    folder, frames = earlier

    for before, after in zip(frames, FrameStore.open(folder), strict=True):
        for name in COLUMNS:
            np.testing.assert_array_equal(getattr(after, name), getattr(before, name))


@pytest.mark.parametrize("name", COLUMNS)
def test_a_cut_column_of_an_earlier_version_is_refused(earlier, name):
    column = np.load(earlier[0] / f"{name}.npy")
    np.save(earlier[0] / f"{name}.npy", column[:-1])

    with pytest.raises(StoreError, match=rf"{name}\.npy: expected"):
        FrameStore.open(earlier[0])[2]


def test_writing_to_a_frame_does_not_change_the_file(written):
    FrameStore.open(written[0])[0].xyz[:] = -1.0

    assert (FrameStore.open(written[0])[0].xyz >= 0).all()


def test_a_store_can_be_pickled_to_another_process(written):
    store = pickle.loads(pickle.dumps(FrameStore.open(written[0])))

    assert len(store[2]) == 7


def test_a_missing_frame_raises_index_error(written):
    with pytest.raises(IndexError, match="frame 3 of 3"):
        FrameStore.open(written[0])[3]


def test_an_interrupted_writer_leaves_no_store(tmp_path):
    with pytest.raises(KeyboardInterrupt), FrameWriter(tmp_path, load_rig("4recon")) as writer:
        writer.append(multiframe(0, 5, np.random.default_rng(1)))
        raise KeyboardInterrupt

    with pytest.raises(StoreError, match="not a finished frame store"):
        FrameStore.open(tmp_path)


@pytest.mark.parametrize("name", [POINTS, "index.npy"])
def test_a_cut_file_is_refused(written, name):
    path = written[0] / name
    path.write_bytes(path.read_bytes()[:-1])

    with pytest.raises(StoreError, match=name if name == POINTS else "not a finished"):
        FrameStore.open(written[0])


def altered(folder, **fields):
    """Change the row of the last multiframe."""
    index = np.load(folder / "index.npy")
    for name, value in fields.items():
        index[name][-1] = value
    np.save(folder / "index.npy", index)


def test_a_frame_of_another_size_than_listed_is_refused(written):
    altered(written[0], stop=11)

    with pytest.raises(StoreError, match=r"multiframe 2: expected \d+ packed bytes, got \d+"):
        FrameStore.open(written[0])[2]


def test_a_frame_that_claims_a_billion_points_is_refused_before_it_is_expanded(written):
    altered(written[0], stop=1 << 40)

    with pytest.raises(StoreError, match="expected at most 200 times the packed size"):
        FrameStore.open(written[0])[2]


@pytest.mark.parametrize(("field", "value"), [("step", 1000), ("end", 1 << 40), ("start", 3)])
def test_an_index_that_makes_no_sense_is_refused(written, field, value):
    altered(written[0], **{field: value})

    with pytest.raises(StoreError, match="expected"):
        FrameStore.open(written[0])


def test_damaged_bytes_of_a_frame_are_refused(written):
    path = written[0] / POINTS
    data = bytearray(path.read_bytes())
    data[:4] = b"none"
    path.write_bytes(data)

    with pytest.raises(StoreError, match=f"{POINTS}: multiframe 0: damaged"):
        FrameStore.open(written[0])[0]


def test_an_empty_store_can_be_opened(tmp_path):
    with FrameWriter(tmp_path / "store", load_rig("4recon")):
        pass

    store = FrameStore.open(tmp_path / "store")

    assert (len(store), store.points, len(store.t_mid_ns)) == (0, 0, 0)


def test_a_full_disk_raises_no_space(tmp_path):
    """A real limit on the size of files, in a process of its own."""
    program = f"""
import resource, signal, sys
import numpy as np
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, 100_000))
from recon4.errors import NoSpace
from recon4.model.hidden_points import HiddenPoints
from recon4.model.multiframe import Multiframe
from recon4.model.rig import load_rig
from recon4.store.imu_repair import FORCES_REVERSED
from recon4.store.frames import FrameWriter
from pathlib import Path
n = 20_000
zero = np.zeros(n, np.uint8)
noise = np.random.default_rng(1).normal(size=(n, 3)).astype(np.float32)
frame = Multiframe(0, 0, 1, noise, zero.astype(np.uint16), zero, zero, zero,
                   zero.astype(np.int32))
try:
    with FrameWriter(Path({str(tmp_path / "store")!r}), load_rig("4recon")) as writer:
        writer.append(frame)
except NoSpace as error:
    sys.exit(0 if "cannot write" in str(error) else 3)
sys.exit(4)
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, timeout=HANG_S)

    assert done.returncode == 0, done.stderr.decode()


def test_no_space_left_becomes_no_space(tmp_path, monkeypatch):
    def full(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("recon4.store.frames.os.fsync", full)

    with pytest.raises(NoSpace, match="No space left"), FrameWriter(tmp_path, load_rig("4recon")):
        pass


def test_memory_does_not_depend_on_the_length_of_the_walk(tmp_path):
    rng = np.random.default_rng(1)
    with FrameWriter(tmp_path / "store", load_rig("4recon")) as writer:
        for k in range(60):
            writer.append(multiframe(k, 60_000, rng))
    store = FrameStore.open(tmp_path / "store")
    _ = store[0].xyz.sum()
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

    total = sum(float(frame.xyz.sum()) for frame in store)

    assert total > 0
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 20_000


def test_points_that_a_stage_hides_are_not_there_in_other_processes_either(written, tmp_path):
    folder, frames = written
    mask = np.array([True, False, False, False, True])
    (tmp_path / "odometry").mkdir()
    hidden = HiddenPoints.of([mask, None, None])
    save_record(tmp_path / "odometry" / "moving.npz", hidden)

    opened = open_frames(folder, None, tmp_path / "odometry")

    for store in (opened, pickle.loads(pickle.dumps(opened))):
        np.testing.assert_array_equal(store[0].xyz, frames[0].xyz[~mask])
        assert len(store[2]) == 7


@pytest.mark.parametrize("name", [IMU_REPAIR, FORCES_REVERSED], ids=["today", "before"])
def test_what_the_odometry_repaired_of_an_imu_is_right_wherever_its_folder_is_given(
    written, tmp_path, name
):
    folder = written[0]
    samples = ImuSamples(np.array([1, 2], np.int64), np.ones((2, 3)), np.full((2, 3), 9.8))
    save_record(folder / "imu.npz", samples)
    (tmp_path / "odometry").mkdir()
    save_record(tmp_path / "odometry" / name, ImuRepair.reversed_forces())

    recorded = open_frames(folder, None)
    opened = open_frames(folder, None, tmp_path / "odometry", with_moving=True)

    assert (recorded.imu.accel_m_s2 == 9.8).all()
    turned = opened.with_rig(opened.rig)
    for store in (opened, turned, pickle.loads(pickle.dumps(turned))):
        assert (store.imu.accel_m_s2 == -9.8).all()
        assert (store.imu.gyro_rad_s == 1.0).all()


def test_an_odometry_that_hides_nothing_changes_nothing(written, tmp_path):
    assert len(open_frames(written[0], None, tmp_path)[0]) == 5
