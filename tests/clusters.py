"""A scheduler with workers as an administrator starts them, with certificates of their own."""

from __future__ import annotations

import datetime as dt
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from cryptography import x509
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.x509.oid import NameOID
from distributed import Client, Security

from recon4.executors.cluster import Certificates
from tests.deadlines import HANG_S

ROOT = Path(__file__).parents[1]


@dataclass(frozen=True)
class RemoteCluster:
    """What was started."""

    address: str
    folder: Path
    """Of the certificates."""
    scheduler: subprocess.Popen[bytes]
    workers: list[subprocess.Popen[bytes]]


@contextmanager
def remote_cluster(folder: Path, workers: int = 1) -> Iterator[RemoteCluster]:
    """A scheduler and workers, until the block ends."""
    write_certificates(folder)
    address = f"tls://127.0.0.1:{free_port()}"
    processes = [start(folder, "scheduler", "--host", address, "--no-dashboard")]
    worker = ("worker", address, "--nthreads", "1", "--no-dashboard")
    processes += [start(folder, *worker) for _ in range(workers)]
    try:
        with Client(address, security=security(folder), timeout=HANG_S) as client:
            if workers:
                client.wait_for_workers(workers, timeout=HANG_S)
        yield RemoteCluster(address, folder, processes[0], processes[1:])
    finally:
        for process in reversed(processes):
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
