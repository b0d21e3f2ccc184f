"""Real workers of Dask: a killed one loses nothing, and certificates are required."""

from __future__ import annotations

import datetime as dt
import os
import socket
import subprocess
import sys
import threading
from pathlib import Path

import pytest
from cryptography import x509
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.x509.oid import NameOID
from distributed import Client, Security

from recon4.cli.main import main
from recon4.errors import ConfigError
from recon4.executors.cluster import Certificates, Cluster, workers_here, workers_of
from recon4.executors.executor import InOrder
from tests.cluster_functions import always_die, die_first, double, refuse, until_stopped
from tests.deadlines import HANG_S
from tests.service.running import wait_for

ROOT = Path(__file__).parents[3]


def ignore(name: str, line: str) -> None:
    pass


@pytest.fixture(scope="module")
def cluster():
    with workers_here(2) as cluster:
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
    write_certificates(folder)
    address = f"tls://127.0.0.1:{free_port()}"
    scheduler = start(folder, "scheduler", "--host", address, "--no-dashboard")
    worker = start(folder, "worker", address, "--nthreads", "1", "--no-dashboard")
    try:
        with Client(address, security=security(folder), timeout=HANG_S) as client:
            client.wait_for_workers(1, timeout=HANG_S)
        yield address, folder
    finally:
        for process in (worker, scheduler):
            process.terminate()
            process.wait()


def security(folder: Path) -> Security:
    return Security(
        tls_ca_file=str(folder / "ca.pem"),
        tls_client_cert=str(folder / "client.pem"),
        tls_client_key=str(folder / "client-key.pem"),
        require_encryption=True,
    )


def start(folder: Path, what: str, *arguments: str) -> subprocess.Popen[bytes]:
    names = {"ca-file": "ca.pem", "cert": "client.pem", "key": "client-key.pem"}
    tls = [word for name, file in names.items() for word in (f"--tls-{name}", str(folder / file))]
    return subprocess.Popen(
        [sys.executable, "-m", "dask", what, *arguments, *tls],
        cwd=ROOT,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )


def free_port() -> int:
    with socket.socket() as bound:
        bound.bind(("127.0.0.1", 0))
        return int(bound.getsockname()[1])


def write_certificates(folder: Path) -> None:
    """An authority, and one certificate that it signed for all."""
    authority, of_authority = ec.generate_private_key(ec.SECP256R1()), named("authority")
    own, of_all = ec.generate_private_key(ec.SECP256R1()), named("workers")
    root = signed(authority.public_key(), of_authority, of_authority, authority, is_authority=True)
    one = signed(own.public_key(), of_all, of_authority, authority, is_authority=False)
    (folder / "ca.pem").write_bytes(root.public_bytes(serialization.Encoding.PEM))
    (folder / "client.pem").write_bytes(one.public_bytes(serialization.Encoding.PEM))
    (folder / "client-key.pem").write_bytes(
        own.private_bytes(
            serialization.Encoding.PEM,
            serialization.PrivateFormat.PKCS8,
            serialization.NoEncryption(),
        )
    )


def named(name: str) -> x509.Name:
    return x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, name)])


def signed(key, subject, issuer, by, *, is_authority):
    now = dt.datetime.now(dt.UTC)
    return (
        x509.CertificateBuilder()
        .subject_name(subject)
        .issuer_name(issuer)
        .public_key(key)
        .serial_number(x509.random_serial_number())
        .not_valid_before(now - dt.timedelta(hours=1))
        .not_valid_after(now + dt.timedelta(days=1))
        .add_extension(x509.BasicConstraints(ca=is_authority, path_length=None), critical=True)
        .sign(by, hashes.SHA256())
    )


def files_in(folder: Path) -> Certificates:
    return Certificates(folder / "ca.pem", folder / "client.pem", folder / "client-key.pem")


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
