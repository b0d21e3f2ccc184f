"""Real workers of Dask: a killed one loses nothing, and certificates are required."""

from __future__ import annotations

import os
import threading
from contextlib import ExitStack

import dask
import pytest
from msgspec import structs

from recon4.cli.main import main
from recon4.errors import ConfigError
from recon4.executors.cluster import Certificates, Cluster, workers_here, workers_of
from recon4.executors.executor import InOrder
from recon4.executors.tuning import CLUSTER
from tests.cluster_functions import always_die, die_first, double, refuse, until_stopped
from tests.clusters import files_in, remote_cluster, write_certificates
from tests.service.running import wait_for


def ignore(name: str, line: str) -> None:
    pass


@pytest.fixture(scope="module")
def cluster():
    impatient = {"distributed.deploy.lost-worker-timeout": "1 ms"}  # as on a busy computer
    with dask.config.set(impatient), workers_here(2) as cluster:
        yield cluster


def test_workers_and_this_process_give_the_same(cluster):
    said: list[tuple[str, str]] = []

    here = [one.result for one in InOrder().run(double, [1, 2, 3], lambda *one: said.append(one))]
    there = {one.task: one.result for one in cluster.run(double, [1, 2, 3], ignore)}

    assert here == [2, 4, 6]
    assert there == {1: 2, 2: 4, 3: 6}
    assert said == [("1", "doubled"), ("2", "doubled"), ("3", "doubled")]


def test_lines_of_workers_arrive(cluster):
    arrived = threading.Event()

    def say(name: str, line: str) -> None:
        assert (name, line) == ("7", "doubled")
        arrived.set()

    assert [one.result for one in cluster.run(double, [7], say)] == [14]
    assert arrived.wait(20)


def test_a_task_whose_worker_is_killed_is_done_by_another(cluster, tmp_path):
    (ended,) = cluster.run(die_first, [str(tmp_path / "killed")], ignore)

    assert ended.failure == ""
    assert ended.result == (tmp_path / "killed").read_text("ascii")
    assert int(ended.result) != os.getpid()
    wait_for(lambda: cluster.size == 2, "the killed worker is started again", max_s=60)


def test_an_error_of_a_task_is_its_failure(cluster):
    (ended,) = cluster.run(refuse, ["walk"], ignore)

    assert (ended.result, ended.failure) == (None, "CorruptFile: walk: damaged")


def test_who_leaves_early_stops_what_runs(cluster, tmp_path):
    begun, stopped = threading.Event(), tmp_path / "stopped"
    tasks = cluster.run(until_stopped, ["", str(stopped)], lambda *_: begun.set())

    assert next(tasks).task == ""
    assert begun.wait(20)
    tasks.close()

    wait_for(stopped.exists, "the task stops")


def test_the_work_of_a_program_that_is_gone_stops(remote, tmp_path):
    address, folder = remote
    begun, stopped = threading.Event(), tmp_path / "stopped"
    with workers_of(address, files_in(folder), tmp_path) as cluster:
        tasks = cluster.run(until_stopped, ["", str(stopped)], lambda *_: begun.set())
        assert next(tasks).task == ""
        assert begun.wait(20)

    wait_for(stopped.exists, "the task stops")


@pytest.mark.study
def test_a_scheduler_that_lost_its_workers_is_given_up(tmp_path, monkeypatch):
    soon = structs.replace(CLUSTER, without_workers_s=0.5, looks_every_s=0.1)
    monkeypatch.setattr("recon4.executors.cluster.CLUSTER", soon)
    begun = threading.Event()
    with ExitStack() as opened:
        remote = opened.enter_context(remote_cluster(tmp_path))
        workers = workers_of(remote.address, files_in(tmp_path), tmp_path)
        cluster = opened.enter_context(workers)
        stopped = str(tmp_path / "stopped")
        tasks = cluster.run(until_stopped, ["", stopped], lambda *_: begun.set())
        assert next(tasks).task == ""
        assert begun.wait(20)
        remote.workers[0].kill()
        (ended,) = tasks

    assert "no workers any more" in ended.failure


@pytest.mark.study
def test_a_task_that_kills_every_worker_is_given_up_and_the_others_are_done(cluster):
    (ended,) = cluster.run(always_die, ["poison"], ignore)
    (after,) = cluster.run(double, [4], ignore)

    assert ended.result is None
    assert "KilledWorker" in ended.failure
    assert after.result == 8


@pytest.mark.parametrize("count", [0, -1, 100_000])
def test_a_count_of_workers_that_makes_no_sense_is_refused(count):
    with pytest.raises(ConfigError, match="expected 1 to 256"):
        workers_here(count)


@pytest.mark.parametrize("address", ["tcp://127.0.0.1:8786", "127.0.0.1:8786", ""])
def test_a_scheduler_without_certificates_is_refused(address, tmp_path):
    files = Certificates(tmp_path / "ca.pem", tmp_path / "client.pem", tmp_path / "key.pem")

    with pytest.raises(ConfigError, match="expected tls://HOST:PORT"):
        workers_of(address, files, tmp_path)


@pytest.fixture(scope="module")
def remote(tmp_path_factory):
    """A scheduler and a worker as an administrator starts them, and their certificates."""
    folder = tmp_path_factory.mktemp("cluster")
    with remote_cluster(folder) as started:
        yield started.address, folder


def entered(cluster: Cluster) -> None:
    with cluster:
        pass


def test_workers_of_a_scheduler_do_the_work(remote, tmp_path):
    address, folder = remote

    with workers_of(address, files_in(folder), tmp_path) as cluster:
        assert cluster.size == 1
        assert [one.result for one in cluster.run(double, [5], ignore)] == [10]


def test_doctor_looks_at_the_workers_of_a_scheduler(remote, tmp_path, capsys):
    address, folder = remote

    main(["doctor", str(tmp_path), "--scheduler", address, "--tls", str(folder)])

    assert "cluster              1 workers" in capsys.readouterr().out


def test_certificates_of_another_authority_are_refused(remote, tmp_path):
    address, _ = remote
    write_certificates(tmp_path)

    with pytest.raises(ConfigError, match="no scheduler answers"):
        entered(workers_of(address, files_in(tmp_path), tmp_path))
