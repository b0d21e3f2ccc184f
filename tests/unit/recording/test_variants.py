"""Recordings drawn at random give a map or a reason, and lose nothing in silence."""

import pytest

from tests.first_variants import all_but_first_are_studies
from tests.variants.run import run_variant
from tests.variants.walk import record_walk

SEEDS = {
    3: "VLP-16 in dual return mode as pcapng",
    4: "a relayed copy of the LiDAR in a bag that is cut",
    7: "HDL-32E with tables of IMU and positions",
    9: "2-D laser to and fro, upside down, with odometry",
    11: "profiler in millimeters, its topics named by a rig file",
    18: "parts of revolutions with absurd times and a registered cloud",
    23: "static transforms that contradict each other",
    24: "raw packets in dual return mode in a bag",
    29: "two LiDARs mounted as a rig file says",
    32: "an IMU table of EuRoC, which is refused",
    63: "a folder of clouds with a file of dates",
    68: "frames of another prefix and a copy in the frame of the robot",
}
"""One of each kind, by what is special. More: ``python -m tests.benchmarks.variants``."""


@pytest.fixture(scope="module")
def walk(tmp_path_factory):
    return record_walk(tmp_path_factory.mktemp("walk") / "office", seconds=2.0)


@pytest.mark.parametrize("seed", all_but_first_are_studies(SEEDS, first=3))
def test_a_drawn_recording_gives_a_map_or_a_reason(walk, tmp_path, seed):
    outcome = run_variant(seed, walk, tmp_path)

    assert outcome.findings == [], outcome.text()
