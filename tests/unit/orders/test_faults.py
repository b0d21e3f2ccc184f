"""Faults of a cluster while it makes a map: the same bytes, clear words, nothing half written."""

from __future__ import annotations

import threading
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from urllib.parse import urlsplit

import pytest
from distributed import Client
from msgspec import structs

from recon4.executors.cluster import workers_here, workers_of
from recon4.executors.tuning import CLUSTER
from tests.cluster_functions import make_part_with_full_disk
from tests.clusters import files_in, remote_cluster, security, start
from tests.deadlines import HANG_S
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


NO_WORKERS = (
    "made here instead of by a worker: the scheduler has no workers any more, has ended or lost it"
)


@pytest.mark.parametrize(("fault", "said"), [("held", []), ("broken once", [NO_WORKERS])])
def test_the_link_between_a_worker_and_the_scheduler_has_a_fault(
    fault, said, inputs, here, tmp_path, monkeypatch
):
    """A worker whose connection breaks ends, and nobody starts it again."""
    soon = structs.replace(CLUSTER, without_workers_s=2.0, looks_every_s=0.2)
    monkeypatch.setattr("recon4.executors.cluster.CLUSTER", soon)
    certificates = tmp_path / "certificates"
    certificates.mkdir()
    with ExitStack() as opened:
        remote = opened.enter_context(remote_cluster(certificates, workers=0))
        link = opened.enter_context(cuttable(urlsplit(remote.address).port))
        address = f"tls://127.0.0.1:{link.port}"
        worker = start(certificates, "worker", address, "--nthreads", "1", "--no-dashboard")
        opened.callback(worker.wait)
        opened.callback(worker.terminate)
        with Client(remote.address, security=security(certificates), timeout=HANG_S) as client:
            client.wait_for_workers(1, timeout=HANG_S)
        workers = workers_of(remote.address, files_in(certificates), tmp_path)
        cluster = opened.enter_context(workers)

        def release() -> None:
            wait_for(lambda: list(tmp_path.rglob("made_*")), "the worker makes what it has")
            link.release()

        faults = {"held": (link.hold, release), "broken once": (link.cut, link.restore)}
        made, warnings = by(Faulty(cluster, *faults[fault]), tmp_path, inputs)

    assert made == here
    assert warnings == said


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


def test_the_connection_to_the_scheduler_breaks_for_good(inputs, here, tmp_path, capfd):
    made, warnings = on_a_faulty_link(tmp_path, inputs, lambda link: (link.cut, lambda: None))

    assert made == here
    assert warnings
    assert "Traceback" not in capfd.readouterr().err
