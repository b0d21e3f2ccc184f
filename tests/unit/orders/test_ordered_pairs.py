"""Pairs of a search registered in confined processes of a worker: the same graph as by threads."""

from __future__ import annotations

import re

import pytest

from recon4.errors import StoreError
from recon4.executors.cluster import workers_here
from recon4.geometry.se3 import SE3
from recon4.model.events import Warned
from recon4.model.pose_graph import Edge, EdgeKind, accepted_unseen
from recon4.pose_graph.ordered_pairs import OrderedPairs
from recon4.pose_graph.pair import Pair
from recon4.pose_graph.pair_files import VIEWS, SearchInputs, save_tried, take_tried
from recon4.pose_graph.search import SearchMeans, build_graph
from recon4.progress import Silent
from recon4.registration.stage import run_odometry
from recon4.registration.tracked_walk import WalkInputs
from recon4.settings import Settings
from recon4.settings.reads import GraphReads, part_of
from recon4.store.frame_folders import FrameFolders
from recon4.store.frames import FrameStore, FrameWriter
from recon4.store.unfinished import keeping
from tests.cluster_functions import make_part_and_die_once
from tests.ordered_maps import DirectWorkers, Instead, bytes_of
from tests.scanned_room import strolling, walk
from tests.tuned import with_tuning


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    """The artifacts of a short walk."""
    folder = tmp_path_factory.mktemp("project")
    frames, odometry = folder / "artifacts" / "frames", folder / "artifacts" / "odometry"
    odometry.mkdir(parents=True)
    stroll = walk(strolling, 16)
    with FrameWriter(frames, stroll.rig) as writer:
        for frame in stroll:
            writer.append(frame)
    run_odometry(WalkInputs(FrameStore.open(frames), Settings(), Silent()), odometry)
    return folder


def searched(project, name, workers=None, progress=None):
    """Bytes of the stage."""
    frames, odometry = project / "artifacts" / "frames", project / "artifacts" / "odometry"
    settings = part_of(with_tuning(Settings(), "graph.node_stride=1"), GraphReads)
    folders = FrameFolders.of(frames, odometry, None)
    out = project / "artifacts" / name
    out.mkdir()
    with keeping(project, "graph", name):
        ordered = OrderedPairs.of(workers, SearchInputs(folders=folders, settings=settings))
        build_graph(
            FrameStore.open(frames),
            odometry,
            SearchMeans(out, ordered),
            settings=settings,
            progress=progress or Silent(),
        )
    return bytes_of(out)


@pytest.fixture(scope="module")
def here(project):
    return searched(project, "here")


def warnings(progress):
    return [event.text for event in progress.events if isinstance(event, Warned)]


class Counting(DirectWorkers):
    """Counts the parts that workers make."""

    made = 0

    def make(self, kind, folder, items, *, waiting):
        for answer in super().make(kind, folder, items, waiting=waiting):
            self.made += 1
            yield answer


def test_workers_register_pairs_with_the_same_bytes_as_threads(project, here):
    progress, workers = Silent(), Counting(project)

    assert searched(project, "there", workers, progress) == here
    assert workers.made >= 4  # several rounds
    assert warnings(progress) == []


class Faulty(DirectWorkers):
    """The checksum of what a node sees is wrong in the first round; in the second there are the
    results of the first, in the third half of them.
    """

    def make(self, kind, folder, items, *, waiting):
        number, views = items[0][0], folder / VIEWS
        if number < 2:  # damaged, and as it was
            whole = views.read_bytes()
            views.write_bytes(whole[:8] + bytes([255 - whole[8]]) + whole[9:])
        for answer in super().make(kind, folder, items, waiting=waiting):
            made = folder / "tried_{}_{}".format(*items[answer.item])
            if number == 0 and not answer.failure:
                self.first = made.read_bytes()
            if number == 1:
                made.write_bytes(self.first)
            if number == 2:
                made.write_bytes(made.read_bytes()[:-9])
            yield answer


def test_pairs_that_workers_fail_to_register_are_registered_here(project, here):
    progress = Silent()

    assert searched(project, "faulty", Faulty(project), progress) == here
    said = "\n".join(warnings(progress))
    assert "views: node 0 is missing or damaged" in said
    assert re.search(r"tried_1_\d: .*expected \d+ pairs, got \d|tried_1_\d: \d", said)
    assert "tried_2_0: " in said


def test_what_another_prediction_gave_is_refused(tmp_path):
    T_i_j, moved = SE3.identity(), SE3.from_rpy(0.0, 0.0, 0.0, t=[1e-9, 0.0, 0.0])
    edge = Edge(i=0, j=1, T_i_j=T_i_j, kind=EdgeKind.LOOP, judgments=accepted_unseen())
    path = tmp_path / "tried_0_0"
    save_tried(path, {3: Pair(0, 1, EdgeKind.LOOP, T_i_j)}, {3: edge})

    with pytest.raises(StoreError, match="expected 1 pairs, got 0"):
        take_tried(path, {3: Pair(0, 1, EdgeKind.LOOP, moved)})

    assert take_tried(path, {3: Pair(0, 1, EdgeKind.LOOP, T_i_j)})[3].kind is EdgeKind.LOOP
    assert not path.exists()


@pytest.mark.study
def test_a_worker_of_dask_that_is_killed_changes_nothing(project, here):
    progress = Silent()

    with workers_here(2) as cluster:
        workers = DirectWorkers(project, Instead(cluster, make_part_and_die_once))
        assert searched(project, "dask", workers, progress) == here

    assert (project / "killed").exists()
    assert warnings(progress) == []
