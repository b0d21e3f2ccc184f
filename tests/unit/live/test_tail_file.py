"""A file that grows is read to the same result as the finished file."""

import shutil
import threading

import numpy as np
import pytest

from recon4.live.mapper.tail_file import TailFile, WriteProgress
from recon4.model.multiframe import COLUMNS
from recon4.model.rig import load_rig
from recon4.progress import Silent
from recon4.recording.ingest import LiveSource, ingest
from recon4.recording.sources import Sources
from recon4.settings import preset
from recon4.store.frames import FrameStore
from tests.deadlines import HANG_S
from tests.unit.recording.packet_builders import spin
from tests.unit.recording.test_pcap_streams import FIRST, SECOND, capture


def walk(path):
    imu = (
        b'{"t_ns": %d, "gx_rad_s": 0.1%03d, "gy_rad_s": 0.0%03d, "gz_rad_s": 0.5%03d, '
        b'"ax_m_s2": 0.0%03d, "ay_m_s2": 0.0%03d, "az_m_s2": 9.8%03d}'
    )
    t_ns, first = spin(3000)
    texts = np.zeros((len(t_ns) // 4, 150), np.uint8)
    for row, t in zip(texts, t_ns[::4].tolist(), strict=True):
        line = imu % (t, *6 * (t // 1000 % 1000,))
        row[: len(line)] = np.frombuffer(line, np.uint8)
    return capture(
        path,
        (FIRST, 2368, (t_ns, first)),
        (SECOND, 2369, spin(3000)),
        (FIRST, 8309, (t_ns[::4][: len(texts)], texts)),
    )


def frames_of(path, out, live=None):
    sources = Sources((path,), load_rig("4recon"))
    ingest(sources, out, settings=preset("indoor").ingest, progress=Silent(), live=live)
    return FrameStore.open(out)


def trouble(t_ns, payloads, *, seed, silent=(0.0, 0.0)):
    """Packets as a bad network delivers them, and none for a while."""
    rng = np.random.default_rng(seed)
    since_s = (t_ns - t_ns[0]) / 1e9
    kept = (rng.random(len(t_ns)) > 0.3) & ~((since_s >= silent[0]) & (since_s < silent[1]))
    rows = np.flatnonzero(kept)
    rows = np.sort(np.concatenate([rows, rng.choice(rows, len(rows) // 20)]))
    return t_ns[rows] + rng.integers(0, 40_000_000, len(rows)), payloads[rows]


def bad_walk(path):
    """Losses, duplicates, late packets; one LiDAR wakes up late, the other one sleeps for 2 s."""
    return capture(
        path,
        (FIRST, 2368, trouble(*spin(7500), seed=1, silent=(4.0, 6.07))),
        (SECOND, 2369, trouble(*spin(7500), seed=2, silent=(0.0, 6.55))),
        ("10.0.0.9", 2368, spin(30)),
        ("10.0.0.9", 2369, (spin(30)[0], np.zeros((30, 99), np.uint8))),
    )


class AwaitedProgress(WriteProgress):
    """Tells the writer that the reader has read all there is: it sees every piece."""

    def __init__(self):
        super().__init__()
        self.awaited = threading.Semaphore(0)

    def wait_beyond(self, offset):
        if offset >= self._bytes:
            self.awaited.release()
        return super().wait_beyond(offset)


@pytest.mark.parametrize("make", [walk, bad_walk])
def test_a_growing_capture_gives_the_frames_of_the_finished_file(tmp_path, make):
    whole = make(tmp_path / "whole.pcap")
    growing = shutil.copy(whole, tmp_path / "growing.pcap")
    growth = AwaitedProgress()
    size = whole.stat().st_size
    cuts = np.unique(np.random.default_rng(5).integers(1, size, 300)).tolist()

    def write():
        for cut in [*cuts, size]:
            assert growth.awaited.acquire(timeout=HANG_S)
            growth.reached(cut)
        growth.complete()

    writer = threading.Thread(target=write)
    writer.start()
    live = frames_of(growing, tmp_path / "live", LiveSource(lambda path: TailFile(path, growth)))
    writer.join()
    later = frames_of(whole, tmp_path / "later")

    assert len(live) == len(later) > 30
    for a, b in zip(live, later, strict=True):
        assert (a.t_ns, a.frame_id) == (b.t_ns, b.frame_id)
        for name in COLUMNS:
            np.testing.assert_array_equal(getattr(a, name), getattr(b, name))
    assert live.report == later.report | {"recordings": ["growing.pcap"]}
    if make is walk:
        assert len(live.imu) == len(later.imu) > 700
        np.testing.assert_array_equal(live.imu.t_ns, later.imu.t_ns)
    else:
        assert {int(k) for frame in live for k in np.unique(frame.sensor)} == {0, 1}
        assert live.report["counts"]["packets_duplicate"] > 200


def test_a_sensor_that_is_silent_from_the_start_holds_the_other_up_for_a_second(tmp_path):
    path = capture(tmp_path / "one.pcap", (FIRST, 2368, spin(5000)))  # 6.6 s
    growth, shown, enough = WriteProgress(), [], threading.Event()

    def watch(frame):
        shown.append(frame)
        if len(shown) == 48:
            enough.set()

    live = LiveSource(lambda path: TailFile(path, growth), watch)
    reading = threading.Thread(target=frames_of, args=(path, tmp_path / "out", live))
    reading.start()
    growth.reached(path.stat().st_size)

    came = enough.wait(20.0)
    growth.complete()
    reading.join()

    assert came


def test_reading_waits_until_there_is_something(tmp_path):
    path = tmp_path / "file"
    path.write_bytes(b"abcdef")
    growth = WriteProgress()
    threading.Timer(0.05, lambda: growth.reached(3)).start()

    file = TailFile(path, growth)

    assert file.read(10) == b"abc"
    growth.complete()
    assert file.read(10) == b""
