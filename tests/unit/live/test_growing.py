"""A file that grows is read to the same result as the finished file."""

import shutil
import threading

import numpy as np

from recon4.live.growing import GrowingFile, Growth
from recon4.model.multiframe import COLUMNS
from recon4.model.rig import load_rig
from recon4.progress import Silent
from recon4.recording.ingest import Live, ingest
from recon4.settings import preset
from recon4.store.frames import FrameStore
from tests.unit.recording.packet_builders import spin
from tests.unit.recording.test_pcap_streams import FIRST, SECOND, capture


def walk(path):
    imu = (
        b'{"t_ns": %d, "gx_rad_s": 0.1, "gy_rad_s": 0, "gz_rad_s": 0.5, '
        b'"ax_m_s2": 0, "ay_m_s2": 0, "az_m_s2": 9.8}'
    )
    t_ns, first = spin(3000)
    texts = np.zeros((len(t_ns) // 4, 150), np.uint8)
    for row, t in zip(texts, t_ns[::4].tolist(), strict=True):
        line = imu % t
        row[: len(line)] = np.frombuffer(line, np.uint8)
    return capture(
        path,
        (FIRST, 2368, (t_ns, first)),
        (SECOND, 2369, spin(3000)),
        (FIRST, 8309, (t_ns[::4][: len(texts)], texts)),
    )


def frames_of(path, out, live=None):
    ingest(
        [path],
        out,
        rig=load_rig("4recon"),
        imu=None,
        gnss=None,
        settings=preset("indoor").ingest,
        progress=Silent(),
        live=live,
    )
    return FrameStore.open(out)


def test_a_growing_capture_gives_the_frames_of_the_finished_file(tmp_path):
    whole = walk(tmp_path / "whole.pcap")
    growing = shutil.copy(whole, tmp_path / "growing.pcap")
    growth = Growth()
    size = whole.stat().st_size
    cuts = np.sort(np.random.default_rng(5).integers(0, size, 300)).tolist()

    def write():
        for cut in [*cuts, size]:
            growth.reached(cut)
        growth.complete()

    writer = threading.Timer(0.05, write)
    writer.start()
    live = frames_of(growing, tmp_path / "live", Live(lambda path: GrowingFile(path, growth)))
    writer.join()
    later = frames_of(whole, tmp_path / "later")

    assert len(live) == len(later) > 30
    for a, b in zip(live, later, strict=True):
        assert (a.t_ns, a.frame_id) == (b.t_ns, b.frame_id)
        for name in COLUMNS:
            np.testing.assert_array_equal(getattr(a, name), getattr(b, name))
    assert len(live.imu) == len(later.imu) > 700
    np.testing.assert_array_equal(live.imu.t_ns, later.imu.t_ns)
    assert live.report["counts"] == later.report["counts"]


def test_reading_waits_until_there_is_something(tmp_path):
    path = tmp_path / "file"
    path.write_bytes(b"abcdef")
    growth = Growth()
    threading.Timer(0.05, lambda: growth.reached(3)).start()

    file = GrowingFile(path, growth)

    assert file.read(10) == b"abc"
    growth.complete()
    assert file.read(10) == b""
