"""Our readers of bags against the library's, and what damage costs."""

import signal
import struct
import subprocess
import sys
import zlib

import numpy as np
import pytest
import zstandard
from rosbags.rosbag1 import Reader as Reader1
from rosbags.rosbag2 import Reader as Reader2

from recon4.errors import CorruptFile, NoSpace
from recon4.recording.formats import scratch
from recon4.recording.formats.bags import Bag
from recon4.recording.formats.chunks import BagIndex, ChunkMessages, ChunkRef, ChunkStream, Topic
from recon4.recording.formats.limits import decompress
from recon4.recording.info.describe import describe
from recon4.recording.limits import LIMITS
from recon4.recording.report import ImportReport
from tests.builders import bag_path, storage_file, write_room_bag
from tests.security.fuzz.seeds_recordings import SEEDS
from tests.security.mcap_bombs import mcap, mcap_message
from tests.warned import K, warned


def ours(path, report=None):
    with Bag([path], report or ImportReport()) as bag:
        wanted = {topic.name for topic in bag.topics}
        return [(m.topic, m.type, m.t_ns, m.data) for m in bag.messages(wanted)]


def theirs(path):
    reader = Reader1 if path.suffix == ".bag" else Reader2
    with reader(path) as bag:
        return [
            (c.topic, c.msgtype, t, bytes(data)) for c, t, data in bag.messages(bag.connections)
        ]


@pytest.mark.parametrize("kind", ["bag1", "db3", "mcap"])
def test_our_reader_gives_the_same_messages_in_the_same_order_as_the_library(kind, tmp_path):
    path = write_room_bag(tmp_path, kind, seconds=5.0)

    assert ours(path) == theirs(path)


@pytest.mark.parametrize("kind", [kind for kind in SEEDS if kind.startswith(("bag1", "mcap"))])
def test_every_compression_gives_the_same_messages_as_the_library(kind, tmp_path):
    build, _, suffix = SEEDS[kind]
    path = tmp_path / f"seed{suffix}"
    path.write_bytes(build())

    assert ours(path) == theirs(path)
    assert len(ours(path)) == 19


def test_overlapping_chunks_are_merged_by_time():
    chunks = [ChunkRef(k, 1, 1, "", k, 100 + k) for k in range(5)]
    loads = {}
    for chunk in chunks:
        messages = ChunkMessages(b"x")
        for t_ns in range(chunk.offset, 101 + chunk.offset, 5):
            messages.add(t_ns, 1, start=0, stop=1)
        loads[chunk.offset] = messages
    index = BagIndex.of_chunks({1: Topic("/a", "b")}, chunks[::-1])

    stream = ChunkStream("x", index, lambda chunk: loads[chunk.offset], report=ImportReport())
    times = [row[2] for row in stream.messages({"/a"})]

    assert len(times) == 5 * 21
    assert times == sorted(times)


def test_a_damaged_chunk_costs_its_messages_only(tmp_path):
    path = tmp_path / "seed.bag"
    whole = SEEDS["bag1_bz2"][0]()
    path.write_bytes(whole)
    before = ours(path)
    at = whole.index(b"BZh", whole.index(b"BZh") + 10)
    path.write_bytes(whole[: at + 40] + b"\x55" * 8 + whole[at + 48 :])
    report = ImportReport()

    left = ours(path, report)

    assert 0 < len(left) < len(before)
    assert set(left) <= set(before)
    assert report.outcome == "lossy"
    assert report.counts["chunks_damaged"] == 1
    assert warned(report, K.CHUNK_LEFT_OUT, error="bytes when decompressed, got")


def test_a_changed_byte_in_a_chunk_with_a_checksum_is_noticed(tmp_path):
    chunk = mcap_message(b"0" * 100)
    content = bytearray(mcap(chunk))
    at = content.index(chunk)
    crc_at = content.index(len(chunk).to_bytes(8, "little")) + 8
    content[crc_at : crc_at + 4] = zlib.crc32(chunk).to_bytes(4, "little")
    path = tmp_path / "x.mcap"
    path.write_bytes(content)
    assert len(ours(path)) == 1
    content[at + 60] ^= 1
    path.write_bytes(content)

    with pytest.raises(CorruptFile, match=r"expected checksum [0-9a-f]{8}, got"):
        ours(path)


def test_a_directory_that_counts_more_messages_than_there_are_is_said(tmp_path):
    path = write_room_bag(tmp_path, "mcap", seconds=0.5)
    metadata = path / "metadata.yaml"
    text = metadata.read_text()
    count = len(ours(path))
    metadata.write_text(text.replace(f"\n  message_count: {count}", "\n  message_count: 9999"))
    report = ImportReport()

    ours(path, report)

    assert report.outcome == "lossy"
    assert report.counts["messages_missing"] == 9999 - count
    assert warned(report, K.MESSAGES_MISSING, expected=9999, found=count)


def test_a_summary_that_counts_more_messages_than_the_chunks_hold_is_said(tmp_path):
    path = tmp_path / "x.mcap"
    content = mcap(mcap_message(b"0" * 100))
    path.write_bytes(content.replace(struct.pack("<IHQ", 10, 1, 1), struct.pack("<IHQ", 10, 1, 7)))
    report = ImportReport()

    assert len(ours(path, report)) == 1
    assert report.outcome == "lossy"
    assert report.counts["messages_missing"] == 6


@pytest.mark.parametrize("how", ["bz2", "lz4", "zstd"])
def test_a_size_beyond_the_ratio_is_refused_before_any_work(how):
    with pytest.raises(
        CorruptFile, match="expected 10 compressed bytes to become at most 16777216"
    ):
        decompress(how, b"not at all", expected=1 << 30, where="x: chunk at byte 9")


# -- copies


def compressed_bag(folder):
    """A rosbag2 whose storage file is compressed as a whole."""
    path = write_room_bag(folder, "db3", seconds=0.5)
    plain = ours(path)
    storage = storage_file(path)
    storage.with_suffix(".db3.zstd").write_bytes(
        zstandard.ZstdCompressor().compress(storage.read_bytes())
    )
    storage.unlink()
    metadata = path / "metadata.yaml"
    text = metadata.read_text().replace("compression_mode: ''", "compression_mode: file")
    text = text.replace("compression_format: ''", "compression_format: zstd")
    metadata.write_text(text.replace(storage.name, f"{storage.name}.zstd"))
    return path, plain


@pytest.fixture
def temporary(tmp_path, monkeypatch):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "tmp"))
    (tmp_path / "tmp").mkdir()
    return tmp_path / "tmp"


def left_over(temporary):
    return [path for path in temporary.rglob("*") if path.is_file()]


def test_a_compressed_storage_file_is_read_and_its_copy_removed(tmp_path, temporary):
    path, plain = compressed_bag(tmp_path)

    assert ours(path) == plain
    assert left_over(temporary) == []


def test_a_killed_readers_copy_is_swept_by_the_next_and_a_living_ones_is_kept(tmp_path, temporary):
    path, plain = compressed_bag(tmp_path)
    script = (
        "import sys, tempfile; from pathlib import Path; tempfile.tempdir = sys.argv[2]\n"
        "from recon4.recording.formats.bags import Bag\n"
        "from recon4.recording.report import ImportReport\n"
        "with Bag([Path(sys.argv[1])], ImportReport()):\n"
        "    print('open', flush=True); sys.stdin.read()\n"
    )
    command = [sys.executable, "-c", script, str(path), str(temporary)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as reader:
        assert reader.stdout.readline() == b"open\n"
        assert ours(path) == plain
        assert [f.suffix for f in left_over(temporary) if f.name != "lock"] == [".db3"]
        reader.send_signal(signal.SIGKILL)
        reader.wait()
        assert len(left_over(temporary)) == 2
        assert scratch.sweep_scratch() == 1
    assert left_over(temporary) == []


def test_no_copy_is_begun_on_a_disk_without_space(temporary):
    with pytest.raises(NoSpace, match="of free space for a temporary copy, got"), \
            scratch.scratch_folder(1 << 60):  # fmt: skip
        pass
    assert left_over(temporary) == []


def test_a_cut_database_is_read_without_a_copy(tmp_path, temporary):
    path = storage_file(write_room_bag(tmp_path, "db3"))
    cut = tmp_path / "cut.db3"
    cut.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    report = ImportReport()

    assert ours(cut, report)
    assert report.counts["messages_salvaged"] > 10
    assert list(temporary.rglob("*")) == []


# -- words


def test_poses_and_a_single_sample_are_described_without_a_time_span(tmp_path):
    kitti = tmp_path / "poses.txt"
    kitti.write_text("1 0 0 0 0 1 0 0 0 0 1 0\n" * 3)
    imu = tmp_path / "imu.csv"
    imu.write_text("t_ns,gx_rad_s,gy_rad_s,gz_rad_s\n1700000000000000000,0,0,0\n")

    assert describe(kitti).lines()[1] == "samples   poses (KITTI)"
    assert describe(imu).lines()[1] == "time      2023-11-14 22:13:20.000 UTC, 0.00 s"


def test_remarks_without_end_are_counted_not_kept():
    report = ImportReport()

    for k in range(LIMITS.texts + 1000):
        report.warn(K.MESSAGES_DAMAGED, row=k)

    assert len(report.findings) == LIMITS.texts
    assert report.counts["remarks_more"] == 1000


def test_a_bag_with_its_messages_out_of_order_is_read_by_time(tmp_path):
    from tests.builders import T0_NS
    from tests.builders import Bag as BagFile

    for kind in ("bag1", "db3", "mcap"):
        path = bag_path(tmp_path, kind)
        with BagFile(path, kind) as bag:
            for k in np.random.default_rng(3).permutation(500):
                bag.imu("/imu", T0_NS + int(k), (0.0,) * 3, (0.0,) * 3)

        assert [row[2] - T0_NS for row in ours(path)] == list(range(500))
