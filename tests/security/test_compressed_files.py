"""Small compressed clouds and logs that become endless: refused in 10 s and 1 GiB, with words."""

from __future__ import annotations

import bz2
import gzip
from collections.abc import Iterator
from pathlib import Path

import laspy
import pytest

from recon4.recording.formats.carmen import read_carmen
from recon4.recording.formats.reference_clouds import read_points
from recon4.recording.report import ImportReport
from tests.security.e57_files import write_constant, write_sound
from tests.security.fuzz import seeds_clouds as clouds
from tests.security.measured import MeasuredChild, assert_refused, measured_child


@pytest.fixture(scope="module")
def child(tmp_path_factory: pytest.TempPathFactory) -> Iterator[MeasuredChild]:
    path: Path = tmp_path_factory.mktemp("warm") / "a.laz"
    path.write_bytes(clouds.las(compressed=True)[1])
    write_sound(path.with_suffix(".e57"))
    with measured_child((read_points, (path,)), (read_points, (path.with_suffix(".e57"),))) as made:
        yield made


@pytest.mark.parametrize("point_format", [0, 6])
def test_a_laz_of_more_points_than_its_bytes_can_have_is_refused(point_format, tmp_path, child):
    """The same point eight million times takes 80 kB; 400 million become 5 GB on the disk."""
    header = laspy.LasHeader(point_format=point_format, version="1.4")
    points = laspy.ScaleAwarePointRecord.zeros(1_000_000, header=header)
    with laspy.open(tmp_path / "a.laz", "w", header=header) as file:
        for _ in range(8):
            file.write_points(points)

    outcome = child.call(read_points, tmp_path / "a.laz")
    assert_refused(outcome, "compressed bytes, got 8000000")


def test_a_laz_of_equal_points_that_is_small_anyway_is_read(tmp_path, child):
    header = laspy.LasHeader(point_format=6, version="1.4")
    points = laspy.ScaleAwarePointRecord.zeros(1_000_000, header=header)
    with laspy.open(tmp_path / "a.laz", "w", header=header) as file:
        file.write_points(points)

    assert not child.call(read_points, tmp_path / "a.laz").error


def test_a_large_scan_of_e57_is_read_piece_by_piece(tmp_path, child):
    write_sound(tmp_path / "a.e57", points=4_000_000)

    outcome = child.call(read_points, tmp_path / "a.e57")
    assert not outcome.error, outcome.words
    assert outcome.peak_bytes < 200 << 20  # at once it would be 400 MiB


@pytest.mark.parametrize("scans", [1, 50])
def test_an_e57_of_points_that_take_no_bytes_is_refused(scans, tmp_path, child):
    """Coordinates whose least and largest value are equal are stored in 0 bits."""
    write_constant(tmp_path / "a.e57", points=30_000_000 // scans, scans=scans)

    assert (tmp_path / "a.e57").stat().st_size < 1 << 20
    assert_refused(child.call(read_points, tmp_path / "a.e57"), "compressed bytes, got 30000000")


SCAN = b"FLASER 4 1.0 1.0 1.0 1.0 0 0 0 0 0 0 1.0 h 1.0\n"


@pytest.mark.parametrize(
    ("name", "compress", "content", "words"),
    [
        ("a.log.gz", gzip.compress, (b"\0", 100 << 20), "line 6: expected at most 65536 bytes"),
        ("a.log.bz2", bz2.compress, (b"\0", 100 << 20), "line 6: expected at most 65536 bytes"),
        ("a.log.gz", gzip.compress, (b"# a comment\n", 8 << 20), "of text, got more"),
    ],
)
def test_a_log_that_becomes_endless_is_refused(name, compress, content, words, tmp_path, child):
    path = tmp_path / name
    text, times = content
    path.write_bytes(compress(SCAN * 5 + text * times))

    outcome = child.call(read_carmen, path, ImportReport())
    assert_refused(outcome, words)


def test_a_log_of_more_lines_than_any_is_refused(tmp_path, child):
    path = tmp_path / "a.log"
    path.write_bytes(SCAN * 5 + b"\n" * 16_000_000)

    outcome = child.call(read_carmen, path, ImportReport())
    assert_refused(outcome, "expected at most 15000000 lines")


@pytest.mark.parametrize(("name", "compress"), [("a.gz", gzip.compress), ("a.bz2", bz2.compress)])
def test_many_short_streams_take_no_longer_than_their_bytes(name, compress, tmp_path, child):
    """What is behind the end of each is copied: once a mebibyte for 20 bytes."""
    path = tmp_path / name
    path.write_bytes(compress(SCAN * 5) + compress(b"") * 60_000)

    outcome = child.call(read_carmen, path, ImportReport())
    assert not outcome.error, outcome.words
    assert outcome.seconds < 2.0
