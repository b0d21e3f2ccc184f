"""Which stages a new map needs after a decision."""

import shutil
import sys
from pathlib import Path

import numpy as np
import pytest
from msgspec.structs import replace

from recon4.geometry.se3 import SE3
from recon4.georeference.tuning import HOLD
from recon4.mapping import carry
from recon4.mapping.tiles import TileSet
from recon4.mapping.tuning import CARRY
from recon4.model.figures import LevelFigures, MapFigures, RefineFigures
from recon4.model.pose_graph import Verdict
from recon4.pipeline import remake
from recon4.pose_graph.files import load_graph
from recon4.review.decisions import Decision, DecisionKind
from recon4.review.journal import append
from recon4.review.row_contents import Measurement, numbers_of
from recon4.store.input_contents import files_of
from recon4.store.project import Project, read_artifacts
from recon4.store.stage import Artifact, read_figures, read_manifest
from recon4.workflows.make_map import PLACE, POSES, SIGHT
from tests.review_project import make

CONFIRMED = (17, 77)
"""A loop that the program has accepted; without it the map moves by half a millimeter."""
WRONG = (20, 90)
"""One that it has rejected; with it the map moves by decimeters."""
OF_POINTS = ("intensity", "classes", "map")
"""Stages that read the points of the multiframes."""


@pytest.fixture
def office(made, tmp_path):
    """A copy of the project."""
    return shutil.copytree(made, tmp_path / "office")


class Watch:
    """Notes the stage that runs, and those that are done."""

    def __init__(self):
        self.stage = ""
        self.done: list[str] = []

    def start(self, what, total, unit): ...

    def advance(self, n=1): ...

    def event(self, event):
        self.stage = getattr(event, "stage", self.stage)
        if getattr(event, "state", "") in {"done", "reused"}:
            self.done.append(event.stage)


def decided(root: Path, kind, pair, **more):
    append(root, Decision(kind=kind, who="Eva", pair=pair))
    return remake(root, **more)


def off_by(off_m: float, root: Path):
    """The decision for another measurement of a loop, off by some centimeters."""
    graph = load_graph(read_artifacts(root)["verification"])
    edge = next(e for e in graph.edges if (e.i, e.j) == CONFIRMED)
    T = SE3(edge.T_i_j.R, edge.T_i_j.t + np.array([0.0, off_m, 0.0]))
    measured = Measurement(
        T_i_j=numbers_of(T),
        information=tuple((100.0 * np.asarray(edge.information)).ravel().tolist()),
        overlap=0.9,
        error_m=0.01,
        limit_m=0.1,
        degeneracy=0.3,
        iterations=5,
    )
    pair = int(graph.frame_ids[edge.i]), int(graph.frame_ids[edge.j])
    return Decision(kind=DecisionKind.REPLACE, who="Eva", pair=pair, measurement=measured)


def ran(summary):
    return {one.stage for one in summary.stages if not one.reused}


def carried(root):
    return read_figures(read_artifacts(root)["refine"], RefineFigures).carried


def bent_ratio(root):
    return read_figures(read_artifacts(root)["map"], MapFigures).bent_ratio


def held(root):
    return read_figures(read_artifacts(root)["level"], LevelFigures).held


def test_a_confirmed_verdict_makes_no_point_of_the_map_again(office):
    before = read_artifacts(office)
    laz = (office / "map.laz").read_bytes()

    summary = decided(office, DecisionKind.ACCEPT, CONFIRMED)

    assert ran(summary) == {"review", "level", "audit"}
    after = read_artifacts(office)
    kept = ("refine", *OF_POINTS)
    assert [after[name] for name in kept] == [before[name] for name in kept]
    assert (office / "map.laz").read_bytes() == laz
    assert '"Eva"' in (office / "edges.json").read_text()


def test_a_map_that_a_decision_hardly_moves_stays_where_it_was(office):
    before = read_artifacts(office)
    line = (office / "trajectory.tum").read_bytes()

    seen = Watch()
    summary = decided(office, DecisionKind.REJECT, CONFIRMED, progress=seen)

    assert ran(summary) == {"review", "refine", "level", "audit"}
    assert seen.done == [one.stage for one in summary.stages]
    after = read_artifacts(office)
    assert [after[name] for name in OF_POINTS] == [before[name] for name in OF_POINTS]
    assert (office / "trajectory.tum").read_bytes() == line
    assert 1e-5 < held(office).moved_m < HOLD.moved_m
    assert 1e-5 < carried(office).moved_m < HOLD.moved_m
    edge = next(e for e in load_graph(after["level"]).edges if (e.i, e.j) == CONFIRMED)
    assert (edge.verdict, edge.decided_by) == (Verdict.REJECTED, "Eva")


def test_what_scans_see_stays_where_a_decision_moves_the_map_by_centimeters(office):
    before = read_artifacts(office)

    append(office, off_by(0.03, office))
    summary = remake(office)

    assert ran(summary) == {"review", "refine", "level", "map", "audit"}
    moved = read_figures(read_artifacts(office)["level"], LevelFigures).moved
    assert HOLD.moved_m < moved.moved_m < HOLD.seen_m
    after = read_artifacts(office)
    undecided = Artifact("level", before["level"].name, before["level"])
    for name, given in (("classes", SIGHT), ("map", PLACE)):
        recipe = read_manifest(after[name])["recipe"]["inputs"]
        is_seen = recipe["level"] == files_of(undecided, given).key
        assert is_seen == (name == "classes")
    assert 0.0 < bent_ratio(office) <= CARRY.bent_ratio
    assert read_manifest(after["map"])["recipe"]["inputs"]["undecided"]
    assert len(TileSet.open(after["map"])) == len(TileSet.open(before["map"]))


def test_a_map_that_a_decision_bends_by_centimeters_is_made_again(office, monkeypatch):
    monkeypatch.setattr(carry, "CARRY", replace(CARRY, bent_ratio=1e-4))
    append(office, off_by(0.03, office))
    remake(office)

    assert bent_ratio(office) is None
    assert read_figures(read_artifacts(office)["map"], MapFigures).points > 0


@pytest.mark.study
@pytest.mark.parametrize("kind", [DecisionKind.ACCEPT, DecisionKind.REJECT])
@pytest.mark.parametrize("pair", [CONFIRMED, WRONG])
def test_a_project_made_with_its_decisions_has_the_artifacts_of_one_made_again(
    kind, pair, office, tmp_path
):
    assert_no_history(office, tmp_path / "cold", Decision(kind=kind, who="Eva", pair=pair))


@pytest.mark.study
def test_a_map_moved_by_centimeters_does_not_depend_on_the_maps_before(office, tmp_path):
    assert_no_history(office, tmp_path / "cold", off_by(0.03, office))


def assert_no_history(office: Path, cold: Path, decision: Decision):
    """A project made with a decision has the bytes of one that was made again with it."""
    with Project.open(cold):
        pass
    append(cold, decision)
    make(cold)
    append(office, decision)
    remake(office)

    again, first = read_artifacts(office), read_artifacts(cold)
    assert {k: folder.name for k, folder in again.items()} == {
        k: folder.name for k, folder in first.items()
    }
    for stage in set(first) - {"audit"}:
        files = [(read_manifest(at[stage])["files"]) for at in (again, first)]
        assert files[0] == files[1], stage


def test_stages_read_no_other_file_of_the_stage_level_than_they_are_given(office):
    opened: dict[str, set[str]] = {}
    seen, watching = Watch(), True

    def watch(event, arguments):
        if watching and event == "open" and isinstance(arguments[0], str):
            opened.setdefault(seen.stage, set()).add(arguments[0])

    sys.addaudithook(watch)
    assert set(OF_POINTS) < ran(decided(office, DecisionKind.ACCEPT, WRONG, progress=seen))
    watching = False

    assert held(office) is None
    assert carried(office) is None
    level = read_artifacts(office)["level"]
    read = {
        name: {Path(path).name for path in paths if Path(path).parent == level}
        for name, paths in opened.items()
    }
    leveled = Artifact("level", level.name, level)
    for name, given in (("intensity", POSES), ("classes", SIGHT), ("map", PLACE)):
        assert read[name] - {"manifest.json"} <= set(given), name
        recipe = read_manifest(read_artifacts(office)[name])["recipe"]
        assert recipe["inputs"]["level"] == files_of(leveled, given).key, name
    assert read["map"] >= set(PLACE)
