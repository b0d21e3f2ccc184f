"""Mutants of every kind of file: an error message or a complete result, nothing else.

Figure to hold: 0 findings (traceback, death of the reader, hang over 10 s, more than 1 GiB, silent
loss). By hand: ``python -m tests.security.fuzz --count 10000`` (docs/explanation/fuzzing.md).
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from recon4.recording.formats.cloud_files import ENDING_FORMATS
from recon4.recording.formats.cloud_headers import HEADER_FORMATS
from recon4.recording.gnss.files import GNSS_FORMATS
from recon4.recording.packets.families import FAMILIES
from tests.security.fuzz.broken import BROKEN
from tests.security.fuzz.corpus import CORPUS, read_kind
from tests.security.fuzz.kinds import KINDS
from tests.security.fuzz.mutators import mutant
from tests.security.fuzz.runner import Readers, fuzz
from tests.security.measured import DEADLINE_S, LIMIT_BYTES, MeasuredChild, measured_child

MUTANTS = 12
SEED = 22
FINDS = {
    "broken-hang": "HANG",
    "broken-crash": "CRASH",
    "broken-memory": "MEMORY",
    "broken-traceback": "TRACEBACK",
    "broken-wordless": "TRACEBACK",
    "broken-silent-cut": "SILENT",
    "broken-silent-count": "SILENT",
}


@pytest.fixture(scope="module")
def readers() -> Iterator[Readers]:
    with Readers() as made:
        yield made


@pytest.mark.parametrize("kind", sorted(KINDS))
def test_no_mutant_gets_further_than_words(kind: str, readers: Readers) -> None:
    tally = fuzz(kind, readers, count=MUTANTS, seed=SEED)
    assert not tally.findings
    assert tally.mutants == MUTANTS
    assert tally.outcomes["rejected"] + tally.outcomes["salvaged"] >= 1


@pytest.mark.parametrize("kind", sorted(FINDS))
def test_a_broken_reader_is_found(kind: str, readers: Readers) -> None:
    tally = fuzz(kind, readers, count=2 if "silent" not in kind else 40, seed=1, hang_s=0.5)
    assert {finding.outcome for finding in tally.findings} == {FINDS[kind]}


def test_a_reader_in_order_is_not_accused(readers: Readers) -> None:
    tally = fuzz("broken-not", readers, count=40, seed=1)
    assert not tally.findings
    assert tally.mutants == 40


def test_every_format_of_clouds_is_fuzzed() -> None:
    fuzzed = {Path(kind.file_name).suffix for kind in KINDS.values()}
    formats = (*HEADER_FORMATS, *ENDING_FORMATS)

    missing = [one.suffix for one in formats if one.suffix not in fuzzed]
    assert not missing, f"no Kind of tests/security/fuzz/ has a file_name with the ending {missing}"


def test_every_format_of_positions_is_fuzzed() -> None:
    seeds = [
        seed for name, one in KINDS.items() if name.startswith("gnss-") for seed in one.seeds()
    ]

    formats = [one for one in GNSS_FORMATS if not any(one.detects(s, len(s)) for s in seeds)]
    missing = [one.title for one in formats]
    assert not missing, f"no Kind gnss-… of tests/security/fuzz/ has a seed of {missing}"


def test_every_family_of_lidars_is_fuzzed() -> None:
    fuzzed = {name.partition("-")[0] for name in KINDS}

    assert [one.name for one in FAMILIES if one.name.lower() not in fuzzed] == []


def test_a_mutant_depends_on_its_number_alone() -> None:
    kind = KINDS["pcd"]
    seeds = list(kind.seeds())
    first = [mutant(kind, seeds, 1, number).data for number in range(30)]
    assert first == [mutant(kind, seeds, 1, number).data for number in range(30)]
    assert len(set(first)) > 25
    assert BROKEN.keys().isdisjoint(KINDS)


@pytest.fixture(scope="module")
def child():
    with measured_child() as made:
        yield made


@pytest.mark.parametrize("path", CORPUS, ids=lambda path: path.name)
def test_a_mutant_that_once_got_further_does_no_more(
    path: Path, tmp_path: Path, child: MeasuredChild
) -> None:
    outcome = child.call(read_kind, path, tmp_path)
    assert not outcome.error or outcome.refused, f"{outcome.error}: {outcome.words}"
    assert outcome.seconds <= DEADLINE_S
    assert outcome.peak_bytes <= LIMIT_BYTES
