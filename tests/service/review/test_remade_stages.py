"""Which stages a new map needs after a decision."""

import shutil
import sys
from pathlib import Path

import pytest

from recon4.pipeline import remake
from recon4.review.decisions import Decision, DecisionKind
from recon4.review.journal import append
from recon4.store.project import read_artifacts
from recon4.workflows.make_map import PLACE, POSES, SIGHT

CONFIRMED = (17, 77)
"""A loop that the program has accepted."""


@pytest.fixture
def office(made, tmp_path):
    """A copy of the project."""
    return shutil.copytree(made, tmp_path / "office")


def decided(root: Path, kind, pair):
    append(root, Decision(kind=kind, who="Eva", pair=pair))
    return remake(root)


def test_a_confirmed_verdict_makes_no_point_of_the_map_again(office):
    before = read_artifacts(office)
    laz = (office / "map.laz").read_bytes()

    summary = decided(office, DecisionKind.ACCEPT, CONFIRMED)

    assert {one.stage for one in summary.stages if not one.reused} == {"review", "level", "audit"}
    after = read_artifacts(office)
    kept = ("refine", "intensity", "classes", "map")
    assert [after[name] for name in kept] == [before[name] for name in kept]
    assert (office / "map.laz").read_bytes() == laz
    assert '"Eva"' in (office / "edges.json").read_text()


def test_stages_read_no_other_file_of_the_stage_level_than_they_are_given(office):
    opened: dict[str, set[str]] = {}
    stage = ""

    class Watch:
        def start(self, what, total, unit): ...
        def advance(self, n=1): ...
        def event(self, event):
            nonlocal stage
            stage = getattr(event, "stage", stage)

    def watch(event, arguments):
        if watching and event == "open" and isinstance(arguments[0], str):
            opened.setdefault(stage, set()).add(arguments[0])

    watching = True
    sys.addaudithook(watch)
    append(office, Decision(kind=DecisionKind.REJECT, who="Eva", pair=CONFIRMED))
    remake(office, progress=Watch())
    watching = False

    level = read_artifacts(office)["level"]
    read = {
        name: {Path(path).name for path in paths if Path(path).parent == level}
        for name, paths in opened.items()
    }
    for name, given in (("intensity", POSES), ("classes", SIGHT), ("map", PLACE)):
        assert read[name] - {"manifest.json"} <= set(given), name
    assert read["map"] >= set(PLACE)
