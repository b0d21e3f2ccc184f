"""External files are keyed by their content, not by their name."""

import os

import pytest

from recon4.errors import RecordingError
from recon4.progress import Silent
from recon4.store.hashing import hash_file, hash_json
from recon4.store.inputs import input_file, input_files
from recon4.store.ledger import Ledger


@pytest.fixture
def ledger(tmp_path_factory):
    with Ledger(tmp_path_factory.mktemp("ledger") / "l.sqlite") as opened:
        yield opened


def test_the_hash_is_the_published_sha256_of_abc(tmp_path):
    (tmp_path / "a").write_bytes(b"abc")

    assert hash_file(tmp_path / "a") == (
        "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
    )


def test_equal_values_hash_alike_whatever_their_order():
    assert hash_json({"a": 1, "b": [2]}) == hash_json({"b": [2], "a": 1})
    assert hash_json({"a": 1}) != hash_json({"a": 2})


def test_a_copy_elsewhere_is_the_same_input(tmp_path, ledger):
    (tmp_path / "a.pcap").write_bytes(b"packets")
    (tmp_path / "copy.pcap").write_bytes(b"packets")

    keys = {input_file(tmp_path / n, ledger, Silent()).key for n in ("a.pcap", "copy.pcap")}

    assert len(keys) == 1


def test_a_large_recording_is_read_once(tmp_path, ledger):
    (tmp_path / "a.pcap").write_bytes(b"packets")
    input_file(tmp_path / "a.pcap", ledger, Silent())
    status = (tmp_path / "a.pcap").stat()
    (tmp_path / "a.pcap").write_bytes(b"PACKETS")
    os.utime(tmp_path / "a.pcap", ns=(status.st_atime_ns, status.st_mtime_ns))

    unread = input_file(tmp_path / "a.pcap", ledger, Silent())
    os.utime(tmp_path / "a.pcap", ns=(status.st_atime_ns, status.st_mtime_ns + 1))
    read = input_file(tmp_path / "a.pcap", ledger, Silent())

    assert unread.key != hash_file(tmp_path / "a.pcap")
    assert read.key == hash_file(tmp_path / "a.pcap")


def test_a_folder_is_its_names_and_contents(tmp_path, ledger):
    for name in ("bag", "same", "renamed"):
        (tmp_path / name).mkdir()
    (tmp_path / "bag" / "0.db3").write_bytes(b"x")
    (tmp_path / "same" / "0.db3").write_bytes(b"x")
    (tmp_path / "renamed" / "1.db3").write_bytes(b"x")

    bag, same, renamed = (
        input_file(tmp_path / name, ledger, Silent()).key for name in ("bag", "same", "renamed")
    )

    assert bag == same != renamed


def test_the_order_of_recordings_counts(tmp_path, ledger):
    (tmp_path / "a").write_bytes(b"a")
    (tmp_path / "b").write_bytes(b"b")
    pair = [tmp_path / "a", tmp_path / "b"]

    assert input_files(pair, ledger, Silent()).key != input_files(pair[::-1], ledger, Silent()).key
    assert input_files(pair, ledger, Silent()).value == tuple(pair)


def test_a_missing_recording_is_named(tmp_path, ledger):
    with pytest.raises(RecordingError, match=r"cannot read .*walk\.pcap: No such file"):
        input_file(tmp_path / "walk.pcap", ledger, Silent())
