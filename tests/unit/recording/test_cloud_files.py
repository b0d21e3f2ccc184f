"""PCD, PLY and BIN files: every encoding, and every cut."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from recon4.errors import CorruptFile, RecordingError, UnknownFormat
from recon4.kernels.lzf import lzf_decompress
from recon4.recording.formats.cloud_files import cloud_fields, is_cloud_file, read_cloud
from tests.builders import room_cloud, write_bin, write_pcd, write_ply

WRITERS = {
    "pcd ascii": lambda path, table: write_pcd(path, table, encoding="ascii"),
    "pcd binary": lambda path, table: write_pcd(path, table, encoding="binary"),
    "pcd padded": lambda path, table: write_pcd(path, table, encoding="binary", padding=10),
    "pcd compressed": lambda path, table: write_pcd(path, table, encoding="binary_compressed"),
    "ply ascii": lambda path, table: write_ply(path, table, encoding="ascii"),
    "ply little": lambda path, table: write_ply(path, table),
}
BINARY = [name for name in WRITERS if "ascii" not in name]


@pytest.fixture(scope="module")
def table():
    return {key: column[:200] for key, column in room_cloud().items()}


@pytest.mark.parametrize("kind", WRITERS)
def test_every_encoding_gives_the_same_columns(kind, table, tmp_path):
    path = WRITERS[kind](tmp_path / "cloud", table)

    read = read_cloud(path)

    assert is_cloud_file(path)
    assert list(read) == list(table) == cloud_fields(path)
    for key, column in table.items():
        np.testing.assert_array_equal(read[key], column)
        assert read[key].dtype == column.dtype


def test_a_big_endian_ply_is_read(tmp_path):
    path = tmp_path / "cloud.ply"
    header = "ply\nformat binary_big_endian 1.0\nelement vertex 1\n"
    header += "".join(f"property float {axis}\n" for axis in "xyz") + "end_header\n"
    path.write_bytes(header.encode() + np.array([1, 2, 3], ">f4").tobytes())

    assert {key: float(column[0]) for key, column in read_cloud(path).items()} == {
        "x": 1.0,
        "y": 2.0,
        "z": 3.0,
    }


def test_a_kitti_bin_file_is_read(table, tmp_path):
    path = write_bin(tmp_path / "000000.bin", table)

    assert is_cloud_file(path)
    np.testing.assert_array_equal(read_cloud(path)["y"], table["y"])


@pytest.mark.parametrize("unit", [1.0, 1 / 255], ids=["0-255", "0-1"])
@pytest.mark.parametrize("order", ["firing", "shuffled"])
@pytest.mark.parametrize("width", [4, 5, 6])
def test_bin_files_with_rings_and_times_are_read_by_their_width(width, order, unit, tmp_path):
    room = room_cloud()
    rows = np.arange(len(room["x"]) // 4 * 4)  # of any width the file is whole rows of four
    if order == "shuffled":
        rows = np.random.default_rng(1).permutation(rows)
    room["intensity"] = room["intensity"] * unit
    names = ("x", "y", "z", "intensity", "ring", "time")[:width]
    columns = {name: room[name][rows].astype("<f4") for name in names}
    path = tmp_path / "000000.bin"
    path.write_bytes(np.column_stack(list(columns.values())).tobytes())

    read = read_cloud(path)

    assert list(read) == list(names)
    for name in names:
        np.testing.assert_array_equal(read[name], columns[name])


def test_a_fifth_number_that_is_no_ring_is_not_read(table, tmp_path):
    path = tmp_path / "000000.bin"
    columns = [table[k].astype("<f4") for k in ("x", "y", "z", "intensity")]
    path.write_bytes(np.column_stack([*columns, columns[0] + 7.5]).tobytes())

    read = read_cloud(path)

    assert list(read) == ["x", "y", "z", "intensity"]
    np.testing.assert_array_equal(read["y"], table["y"])


def test_fields_of_ply_files_by_cloudcompare_are_those_of_their_names(table, tmp_path):
    renamed = {name if name in "xyz" else f"scalar_{name}": c for name, c in table.items()}
    path = write_ply(tmp_path / "cloud.ply", renamed)

    assert set(read_cloud(path)) == set(table)


@pytest.mark.parametrize("kind", BINARY)
@settings(max_examples=40)
@given(share=st.floats(0.0, 0.999))
def test_a_file_cut_anywhere_is_refused(kind, table, tmp_path_factory, share):
    path = WRITERS[kind](tmp_path_factory.mktemp("cut") / "cloud", table)
    data = path.read_bytes()
    path.write_bytes(data[: int(share * len(data))])

    with pytest.raises(RecordingError):
        read_cloud(path)


@settings(max_examples=60)
@given(where=st.floats(0.0, 0.999), value=st.integers(0, 255))
@pytest.mark.parametrize("kind", BINARY)
def test_a_changed_byte_gives_all_points_or_an_error(kind, table, tmp_path_factory, where, value):
    path = WRITERS[kind](tmp_path_factory.mktemp("bad") / "cloud", table)
    data = bytearray(path.read_bytes())
    data[int(where * len(data))] = value
    path.write_bytes(data)

    try:
        read = read_cloud(path)
    except RecordingError:
        return
    assert len({len(column) for column in read.values()}) == 1


def test_a_bin_file_of_odd_length_says_by_how_much(table, tmp_path):
    path = write_bin(tmp_path / "000000.bin", table)
    path.write_bytes(path.read_bytes()[:-3])

    with pytest.raises(CorruptFile, match="13 too many"):
        read_cloud(path)


def test_a_header_that_promises_a_trillion_points_allocates_nothing(table, tmp_path):
    path = write_pcd(tmp_path / "cloud.pcd", table)
    text = path.read_bytes().replace(b"WIDTH 200", b"WIDTH 1000000000000")
    path.write_bytes(text.replace(b"POINTS 200", b"POINTS 1000000000000"))

    with pytest.raises(CorruptFile, match="need"):
        read_cloud(path)


def test_width_times_height_must_be_points(table, tmp_path):
    path = write_pcd(tmp_path / "cloud.pcd", table)
    path.write_bytes(path.read_bytes().replace(b"HEIGHT 1", b"HEIGHT 2"))

    with pytest.raises(CorruptFile, match="WIDTH x HEIGHT is 400, POINTS is 200"):
        read_cloud(path)


def test_another_kind_of_file_is_refused(tmp_path):
    path = tmp_path / "photo.pcd"
    path.write_bytes(b"\xff\xd8\xff\xe0 a photo")

    assert not is_cloud_file(path)
    with pytest.raises(UnknownFormat, match=r"photo\.pcd"):
        read_cloud(path)


def test_lzf_worked_out_by_hand():
    """Two literals "ab", then a reference of 6 bytes, 2 back: "ababab" behind them."""
    packed = np.frombuffer(bytes([1]) + b"ab" + bytes([4 << 5, 1]), np.uint8)
    out = np.zeros(8, np.uint8)

    assert lzf_decompress(packed, out) == 8
    assert out.tobytes() == b"abababab"


@pytest.mark.parametrize(
    "packed",
    [b"\x05ab", b"\x20\x00", b"\xe0", b"\x01ab\x80", b"\x1f" + bytes(32)],
    ids=["short literal", "before the start", "no length", "no offset", "too long"],
)
def test_lzf_refuses_damage(packed):
    assert lzf_decompress(np.frombuffer(packed, np.uint8), np.zeros(8, np.uint8)) == -1


def test_padded_fields_of_a_real_recording_are_skipped(data):
    read = read_cloud(data("sequences/vlp16-corridor") / "8.pcd")

    assert list(read) == ["x", "y", "z", "intensity", "ring"]
    assert len(read["x"]) == 28208
    assert np.bincount(read["ring"]).shape == (16,)


def test_a_compressed_file_of_a_real_recording_is_read(data):
    read = read_cloud(data("calibration/0001") / "top.pcd")

    assert len(read["x"]) == 92677
    assert np.ptp(read["timestamp"]) == pytest.approx(0.1, abs=1e-3)


@pytest.mark.parametrize("kind", ["ply ascii", "ply little"])
@pytest.mark.parametrize("first", [b"ply\r\n", b"ply \t \n"])
def test_spaces_behind_the_first_word_of_a_ply_file_mean_nothing(kind, first, table, tmp_path):
    path = WRITERS[kind](tmp_path / "cloud.ply", table)
    path.write_bytes(first + path.read_bytes().removeprefix(b"ply\n"))

    assert is_cloud_file(path)
    np.testing.assert_array_equal(read_cloud(path)["x"], table["x"])
