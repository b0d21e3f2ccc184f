"""Points classified in confined processes of a worker: the same classes as by threads."""

from __future__ import annotations

import pytest
from msgspec import structs

from recon4.classes import stage
from recon4.classes.class_parts import ClassedWalk, OrderedClasses
from recon4.classes.stage import classify, write_classes
from recon4.executors.executor import InOrder
from recon4.mapping.mirrors import save_mirrors
from recon4.model.events import Warned
from recon4.progress import Silent
from recon4.store.arrays import save_trajectory
from recon4.store.frame_folders import FrameFolders
from recon4.store.frames import FrameWriter
from recon4.store.unfinished import keeping
from tests.ordered_maps import DirectWorkers, bytes_of
from tests.unit.classes.scanned_scenes import ROOM, box, cylinder, scanned


@pytest.fixture(autouse=True)
def _short_parts(monkeypatch):
    """Parts of two seconds, of which this process decides."""
    monkeypatch.setattr(stage, "VIEWS", structs.replace(stage.VIEWS, part_ns=2_000_000_000))


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    """The artifacts of a walk during which a person crosses the room."""
    folder = tmp_path_factory.mktemp("project")
    artifacts = folder / "artifacts"
    person = cylinder("person", lambda t_s: (7.0, -2.5 + 0.4 * t_s), 0.25)
    walk, _ = scanned(box("room", *ROOM), person, seconds=7.0)
    for name in ("odometry", "level"):
        (artifacts / name).mkdir(parents=True)
    with FrameWriter(artifacts / "frames", walk.rig) as writer:
        for k in range(len(walk)):
            writer.append(walk[k])
    save_trajectory(artifacts / "level" / "trajectory.npz", walk.trajectory)
    save_mirrors(artifacts / "level" / "mirrors.npz", [])
    return folder


def classified(project, name, workers=None, progress=None):
    """Bytes of the stage, and how many points have each class."""
    artifacts = project / "artifacts"
    folders = FrameFolders.of(artifacts / "frames", artifacts / "odometry", None)
    walk = ClassedWalk(folders=folders, level=str(artifacts / "level"))
    out = artifacts / name
    out.mkdir()
    with keeping(project, "classes", name):
        found = classify(
            folders.open(),
            stage.load_trajectory(artifacts / "level" / "trajectory.npz"),
            progress=progress or Silent(),
            ordered=OrderedClasses.of(workers, walk),
        )
        figures = write_classes(found, out)
    return bytes_of(out), figures


@pytest.fixture(scope="module")
def here(project):
    return classified(project, "here")


def warnings(progress):
    return [event.text for event in progress.events if isinstance(event, Warned)]


class Backward:
    """An executor that takes the last part first."""

    def run(self, function, tasks, say):
        return InOrder().run(function, tasks[::-1], say)


class Disturbed(DirectWorkers):
    """The second part of the order fails, the file of the third is half there."""

    def make(self, kind, folder, items, *, waiting):
        assert len(items) == 4
        for answer in super().make(kind, folder, items, waiting=waiting):
            if answer.item == 2:
                made = folder / "classes_{}_{}".format(*items[2])
                made.write_bytes(made.read_bytes()[:-100])
            yield type(answer)(item=answer.item, failure="lost" if answer.item == 1 else "")


def test_workers_find_the_same_classes_as_threads(project, here):
    progress = Silent()

    there = classified(project, "there", DirectWorkers(project, Backward()), progress)

    assert here[1].classes["moving"] > 100
    assert warnings(progress) == []
    assert there == here


def test_classes_that_workers_fail_to_find_are_found_here(project, here):
    progress = Silent()

    assert classified(project, "disturbed", Disturbed(project), progress) == here
    assert len(warnings(progress)) == 2
