"""Faults of a cluster while it makes a map: the same bytes, clear words, nothing half written."""

from __future__ import annotations

import threading
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from urllib.parse import urlsplit

import pytest

from recon4.executors.cluster import workers_here, workers_of
from tests.cluster_functions import make_part_with_full_disk
from tests.clusters import files_in, remote_cluster
from tests.ordered_maps import bytes_of, full_inputs, make_map
from tests.service.cuttable import Cuttable, cuttable
from tests.service.running import wait_for
from tests.unit.orders.test_dask_workers import Instead, by

pytestmark = pytest.mark.study


@pytest.fixture(scope="module")
def inputs():
    return full_inputs()


@pytest.fixture(scope="module")
def here(inputs, tmp_path_factory):
    """Bytes of the map made by threads."""
    return bytes_of(make_map(tmp_path_factory.mktemp("project"), None, inputs=inputs))


def test_the_disk_of_one_worker_is_full(inputs, here, tmp_path):
    with workers_here(2) as cluster:
        made, warnings = by(Instead(cluster, make_part_with_full_disk), tmp_path, inputs)

    assert (tmp_path / "full").exists()
    assert made == here
    assert warnings
    assert all("no space left" in text for text in warnings)
    assert [path for path in tmp_path.rglob(".tmp-*")] == []


class Faulty:
    """An executor with a fault after its first part, until something has happened."""

    def __init__(self, executor, begin: Callable[[], None], until: Callable[[], object]) -> None:
        self.executor, self.begin, self.until = executor, begin, until

    def run(self, function, tasks, say):
        ended = self.executor.run(function, tasks, say)
        yield next(ended)
        self.begin()
        healing = threading.Thread(target=self.until)
        healing.start()
        yield from ended
        healing.join()


def on_a_faulty_link(
    project: Path, inputs, fault: Callable[[Cuttable], tuple[Callable, Callable]]
) -> tuple[dict[str, str], list[str]]:
    """Bytes and warnings of a map made by a worker, while the link to the scheduler has a fault."""
    certificates = project / "certificates"
    certificates.mkdir()
    with ExitStack() as opened:
        remote = opened.enter_context(remote_cluster(certificates))
        link = opened.enter_context(cuttable(urlsplit(remote.address).port))
        address = f"tls://127.0.0.1:{link.port}"
        cluster = opened.enter_context(workers_of(address, files_in(certificates), project))
        return by(Faulty(cluster, *fault(link)), project, inputs)


def several_made(project: Path) -> bool:
    return len(list(project.rglob("made_*"))) > 4


@pytest.mark.parametrize("held_s", [0.0, 60.0])
def test_nothing_passes_between_this_computer_and_the_scheduler(held_s, inputs, here, tmp_path):
    """Workers go on meanwhile, here until they have made some tiles and for a time."""

    def release(link: Cuttable) -> None:
        wait_for(lambda: several_made(tmp_path), "the worker goes on")
        threading.Event().wait(held_s)
        link.release()

    made = on_a_faulty_link(tmp_path, inputs, lambda link: (link.hold, lambda: release(link)))

    assert made == (here, [])


def test_the_connection_to_the_scheduler_breaks_and_comes_back(inputs, here, tmp_path):
    made, warnings = on_a_faulty_link(tmp_path, inputs, lambda link: (link.cut, link.restore))

    assert made == here
    assert [text for text in warnings if "lost" not in text and "gone" not in text] == []


def test_the_connection_to_the_scheduler_breaks_for_good(inputs, here, tmp_path):
    made, warnings = on_a_faulty_link(tmp_path, inputs, lambda link: (link.cut, lambda: None))

    assert made == here
    assert warnings
