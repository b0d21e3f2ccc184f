"""Tiles of a map on real workers of Dask: the same bytes, whatever becomes of them."""

from __future__ import annotations

from contextlib import ExitStack

import pytest

from recon4.executors.cluster import workers_here, workers_of
from recon4.model.events import Warned
from recon4.progress import Silent
from tests.cluster_functions import make_part_and_die_once, make_part_slowly
from tests.clusters import files_in, remote_cluster
from tests.ordered_maps import DirectWorkers, Instead, bytes_of, full_inputs, make_map


@pytest.fixture(scope="module")
def inputs():
    return full_inputs()


@pytest.fixture(scope="module")
def here(inputs, tmp_path_factory):
    """Bytes of the map made by threads."""
    return bytes_of(make_map(tmp_path_factory.mktemp("project"), None, inputs=inputs))


def by(executor, project, inputs) -> tuple[dict[str, str], list[str]]:
    """Bytes of the map made by workers, and warnings."""
    progress = Silent()
    out = make_map(project, DirectWorkers(project, executor), inputs=inputs, progress=progress)
    return bytes_of(out), [one.text for one in progress.events if isinstance(one, Warned)]


def test_two_workers_of_which_one_is_killed_in_a_tile_make_the_same_bytes(inputs, here, tmp_path):
    with workers_here(2) as cluster:
        made, warnings = by(Instead(cluster, make_part_and_die_once), tmp_path, inputs)

    assert (tmp_path / "killed").exists()
    assert made == here
    assert warnings == []


@pytest.mark.study
@pytest.mark.parametrize("count", [1, 2, 8])
def test_any_number_of_workers_makes_the_same_bytes(count, inputs, here, tmp_path):
    with workers_here(count) as cluster:
        assert by(cluster, tmp_path, inputs) == (here, [])


@pytest.mark.study
def test_a_worker_ten_times_slower_changes_nothing(inputs, here, tmp_path):
    with workers_here(2) as cluster:
        assert by(Instead(cluster, make_part_slowly), tmp_path, inputs) == (here, [])


class Killing:
    """An executor whose scheduler is killed after the first part."""

    def __init__(self, executor, scheduler):
        self.executor, self.scheduler = executor, scheduler

    def run(self, function, tasks, say):
        ended = self.executor.run(function, tasks, say)
        yield next(ended)
        self.scheduler.kill()
        yield from ended


@pytest.mark.study
def test_a_killed_scheduler_is_said_and_the_map_is_made_here(inputs, here, tmp_path):
    certificates = tmp_path / "certificates"
    certificates.mkdir()
    with ExitStack() as opened:
        remote = opened.enter_context(remote_cluster(certificates))
        workers = workers_of(remote.address, files_in(certificates), tmp_path)
        cluster = opened.enter_context(workers)
        made, warnings = by(Killing(cluster, remote.scheduler), tmp_path, inputs)

    assert made == here
    assert warnings != []
