"""Small recordings that demand unbounded memory or time are rejected, or read within limits.

Figures: 1 GiB of memory beyond the program itself, 10 s of processor time (60 s for a million
honest messages), never a traceback; a refusal says what was expected.
"""

import shutil

import pytest

from tests.security.reader_process import GIB, ReaderProcess
from tests.security.recording_bombs import BOMBS, LINEAR, LONG, SUFFIXES

CASES = [
    pytest.param(kind, build, id=build.__name__, marks=[pytest.mark.study] if build in LONG else [])
    for kind, builds in BOMBS.items()
    for build in builds
]


@pytest.fixture(scope="module")
def outcome_of(tmp_path_factory):
    """Reads a bomb once, however many tests look at its outcome."""
    found = {}
    with ReaderProcess(max_bytes=GIB) as process:

        def read(kind, build):
            if build not in found:
                folder = tmp_path_factory.mktemp("bomb")
                path = folder / f"{build.__name__}{SUFFIXES[kind]}"
                build(path)
                found[build] = process.read(path, deadline_s=60 if build in LINEAR else 10)
                shutil.rmtree(folder)
            return found[build]

        yield read


@pytest.mark.parametrize(("kind", "build"), CASES)
def test_a_bomb_is_refused_or_read_within_limits(kind, build, outcome_of):
    outcome = outcome_of(kind, build)

    assert outcome.sound, outcome
    assert outcome.extra_bytes < GIB
    if outcome.kind == "rejected":
        assert f"{build.__name__}{SUFFIXES[kind]}" in outcome.text or "bag.db3" in outcome.text


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("bag1_bz2", "chunk at byte 4157: expected 786432 bytes when decompressed, got more"),
        ("bag1_lz4", "chunk at byte 4157: expected 786432 bytes when decompressed, got more"),
        ("mcap_zstd", "chunk at byte 82: expected 100 bytes when decompressed, got more"),
        ("db3_view", "expected a table messages, got a view of that name"),
        ("db3_generated", "expected a column data in messages, got one that is computed"),
        ("db3_virtual", "expected a table messages, got a virtual table of that name"),
        ("metadata_brackets", "metadata.yaml, line 1: nested deeper than 20 levels"),
        ("db3_cycle", "expected a tree of pages, got page"),
        ("metadata_aliases", "metadata.yaml, line 2: expected no reference, got *a0"),
        ("metadata_file_zstd", "compressed bytes to become at most"),
        ("db3_many_messages", "compressed bytes to become at most"),
        ("db3_many_files", "compressed bytes to become at most"),
        ("pcap_sparse", "packet at byte 24: expected a length of 1 to 262144 bytes, got 0"),
        ("pcapng_short_block", "block at byte 28: expected a length of 12 to 16777216 bytes"),
    ],
)
def test_a_refusal_says_what_where_expected_and_got(name, words, outcome_of):
    kind, build = next((k, b) for k, builds in BOMBS.items() for b in builds if b.__name__ == name)

    assert words in outcome_of(kind, build).text
