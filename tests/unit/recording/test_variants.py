"""Recordings drawn at random give a map or a reason, and lose nothing in silence."""

import pytest

from tests.variants.run import run_variant
from tests.variants.walk import record_walk

SEEDS = range(1, 13)
"""More: ``python -m tests.benchmarks.variants``."""


@pytest.fixture(scope="module")
def walk(tmp_path_factory):
    return record_walk(tmp_path_factory.mktemp("walk") / "office", seconds=2.0)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_drawn_recording_gives_a_map_or_a_reason(walk, tmp_path, seed):
    outcome = run_variant(seed, walk, tmp_path)

    assert outcome.findings == [], outcome.text()
