"""Bounded reading: excessive sizes, lines and nesting are rejected before memory is used."""

import os

import pytest

from recon4.errors import ConfigError, CorruptFile, StoreError
from recon4.store.json_files import read_object
from recon4.untrusted.bounded import (
    lines_limited,
    parse_json,
    read_bytes_limited,
    read_text_limited,
    text_blocks,
)
from recon4.untrusted.limits import LIMITS


def sparse(path, size, head=b""):
    with path.open("wb") as file:
        file.write(head)
        file.truncate(size)
    return path


def test_a_file_over_the_limit_is_refused_unread(tmp_path):
    path = sparse(tmp_path / "large.txt", 7 << 30)
    with pytest.raises(ConfigError, match="expected at most 100 bytes, got 7516192768"):
        read_bytes_limited(path, 100, failure=ConfigError)


def test_a_file_of_the_limit_is_read(tmp_path):
    path = tmp_path / "a.txt"
    path.write_bytes(b"x" * 100)
    assert read_bytes_limited(path, 100) == b"x" * 100


def test_pipes_devices_folders_and_impossible_names_are_refused(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    for path in (tmp_path / "pipe", tmp_path, tmp_path / "none", tmp_path / "a\0b"):
        with pytest.raises(StoreError):
            read_bytes_limited(path, 10, failure=StoreError)
    with pytest.raises(CorruptFile, match="device"):
        read_bytes_limited(type(tmp_path)("/dev/zero"), 10)


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b"a\nb\xff\n", "line 2: expected UTF-8 text, got byte 0xff at offset 3"),
        (b"a\n\0", "line 2: expected text, got a NUL byte at offset 2"),
        ("a,b".encode("utf-16"), "got UTF-16"),
    ],
)
def test_bytes_that_are_not_text_are_reported_with_their_line(tmp_path, data, words):
    path = tmp_path / "a.txt"
    path.write_bytes(data)
    for read in (
        lambda: read_text_limited(path, 100),
        lambda: list(lines_limited(path, max_bytes=100)),
        lambda: list(text_blocks(path, block_bytes=8, max_bytes=100)),
    ):
        with pytest.raises(CorruptFile, match=words.split(" at offset")[0]):
            read()


def test_lines_and_blocks_make_up_the_text(tmp_path):
    path = tmp_path / "a.txt"
    text = "".join(f"line {k} ä\r\n" for k in range(1000)) + "last"
    path.write_bytes(b"\xef\xbb\xbf" + text.encode())
    assert "".join(lines_limited(path, max_bytes=1 << 20)) == text
    for size in (1, 7, 100, 1 << 20):
        assert "".join(text_blocks(path, block_bytes=size, max_bytes=1 << 20)) == text


def test_one_long_line_is_refused(tmp_path):
    path = sparse(tmp_path / "a.csv", 7 << 30, b"a,b\n" + b"1" * (LIMITS.line_bytes + 1))
    with pytest.raises(CorruptFile, match="line 2: expected at most 65536 bytes"):
        list(lines_limited(path, max_bytes=8 << 30))
    with pytest.raises(CorruptFile, match="line 2: expected at most 65536 bytes"):
        list(text_blocks(path, block_bytes=1 << 20, max_bytes=8 << 30))


@pytest.mark.parametrize(
    "text",
    [
        "[" * 100_000,
        "[" * (LIMITS.depth + 2) + "]" * (LIMITS.depth + 2),
        '{"a":' * 500 + "1" + "}" * 500,
        '{"name": "\\ud800"}',
        '{"name": ',
        "1" * 5000,
        b"\xff\xfe[\0",
        "",
    ],
)
def test_json_that_is_damaged_or_too_deep_is_refused(text):
    with pytest.raises(CorruptFile, match=r"p\.json"):
        parse_json(text, "p.json")


def test_json_of_usual_depth_and_paired_surrogates_pass():
    assert parse_json("[" * LIMITS.depth + "]" * LIMITS.depth, "p.json")
    assert parse_json('"\\ud83d\\ude00"', "p.json") == "😀"


@pytest.mark.parametrize(
    ("text", "problem"), [("[1]", "expected an object, got list"), ('{"a": NaN}', "NaN")]
)
def test_a_file_of_ours_is_an_object_of_finite_numbers(tmp_path, text, problem):
    path = tmp_path / "p.json"
    path.write_text(text)
    with pytest.raises(StoreError, match=problem):
        read_object(path, max_bytes=100)
