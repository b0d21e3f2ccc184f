"""Workers of Dask: processes of this machine, or of others by a scheduler with TLS.

Anyone who may talk to a scheduler can run code on its workers. So a scheduler of others is used
with certificates only, and that of this machine has temporary ones.
"""

from __future__ import annotations

import logging
import threading
import time
import uuid
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import CancelledError
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import recon4
from recon4.errors import Cancelled, ConfigError
from recon4.executors.executor import Finished, Result, Say, Task
from recon4.executors.tuning import CLUSTER
from recon4.locales.coded import CodedText

if TYPE_CHECKING:
    from distributed import Client, Worker

log = logging.getLogger(__name__)

_LINES = "recon4-lines-"
"""Topic of the lines that a run's tasks say; its number follows."""
_MISSING = "needs Dask, which is not installed; command: pip install 'recon4[dask]'"


@dataclass(frozen=True, slots=True)
class Certificates:
    """Files by which client, scheduler and workers know each other."""

    authority: Path
    """Certificate of the authority that signed the others (PEM)."""
    certificate: Path
    """Of this client (PEM)."""
    key: Path
    """Its private key (PEM)."""


@dataclass(frozen=True, slots=True)
class SeenWorker:
    """What a worker says of itself."""

    address: str
    version: str
    """Of recon4 there."""
    sees_folder: bool
    """Whether it can read what this machine wrote into the shared folder."""


class Cluster:
    """Workers of a scheduler; ends those that it started itself."""

    def __init__(self, connect: Callable[[ExitStack], Client]) -> None:
        self._connect = connect
        self._open = ExitStack()
        self._client: Client | None = None

    def __enter__(self) -> Cluster:
        with ExitStack() as opened:
            self._client = self._connect(opened)
            self._open = opened.pop_all()
        return self

    def __exit__(self, *_: object) -> None:
        self._open.close()

    def run(
        self, function: Callable[[Task, Say], Result], tasks: Sequence[Task], say: Say
    ) -> Iterator[Finished[Task, Result]]:
        """Yield each task as soon as it has ended; one whose worker dies is run again elsewhere."""
        from distributed import as_completed

        client, topic = self._connected, _LINES + uuid.uuid4().hex
        client.subscribe_topic(topic, lambda event: say(*event[1]))
        # A task writes files, so the same one is never run twice at a time: no copies of it.
        futures = [client.submit(_on_worker, function, task, topic, pure=False) for task in tasks]
        of_future = dict(zip((future.key for future in futures), tasks, strict=True))
        try:
            with _watched(client, futures):
                for future in as_completed(futures):
                    ended = _finished(of_future[future.key], future)
                    future.release()  # else it is run again when its worker dies later
                    yield ended
        finally:
            if client.status == "running":  # else it has cancelled all that it wanted
                with suppress(OSError, TimeoutError):  # the scheduler is gone
                    client.cancel(futures, force=True)  # what still runs stops at its next line
                    client.unsubscribe_topic(topic)

    @property
    def size(self) -> int:
        """Workers that are connected now."""
        return len(self._connected.scheduler_info(n_workers=-1)["workers"])

    @property
    def dashboard(self) -> str:
        """Address of the dashboard of the scheduler; empty = it has none."""
        client = self._connected
        has_one = "dashboard" in client.scheduler_info(n_workers=0).get("services", {})
        return str(client.dashboard_link) if has_one else ""

    @property
    def _connected(self) -> Client:
        assert self._client is not None, "used outside of its with block"
        return self._client


def workers_here(count: int) -> Cluster:
    """Processes of this machine, which end with this one.

    Raises:
        ConfigError: If Dask is not installed, or the count is none.
    """
    _require()
    if not 1 <= count <= CLUSTER.most_workers:
        raise ConfigError(
            CodedText("command-workers", most_workers=CLUSTER.most_workers, count=count)
        )

    def connect(opened: ExitStack) -> Client:
        import dask
        from distributed import Client, LocalCluster, Security

        security = Security.temporary()
        timeout = {"distributed.deploy.lost-worker-timeout": f"{CLUSTER.lost_worker_s} s"}
        opened.enter_context(dask.config.set(timeout))  # read whenever a worker is lost
        cluster = opened.enter_context(
            LocalCluster(
                n_workers=count,
                threads_per_worker=1,
                # No dashboard; its server listens all the same, and here to this computer only, at
                # a free port: with the usual one, a second cluster would warn, or not start.
                dashboard_address="127.0.0.1:0",
                scheduler_kwargs={"dashboard": False},
                security=security,
                protocol="tls://",
                silence_logs=CLUSTER.log_level,
            )
        )
        return opened.enter_context(Client(cluster, security=security))

    return Cluster(connect)


def workers_of(scheduler: str, certificates: Certificates, shared: Path) -> Cluster:
    """Workers of a scheduler that runs already; they are checked when the cluster is entered.

    Args:
        scheduler: Its address, ``tls://HOST:PORT``.
        certificates: Of this client.
        shared: Folder that this computer and all workers see under the same name.

    Raises:
        ConfigError: If Dask is not installed, the address has no TLS, or a certificate is missing;
            when entered, if no scheduler answers, it has no workers, or one has another version or
            does not see the folder.
    """
    _require()
    if not scheduler.startswith("tls://"):
        raise ConfigError(CodedText("command-scheduler", scheduler=scheduler))
    for path in (certificates.authority, certificates.certificate, certificates.key):
        if not path.is_file():
            raise ConfigError(CodedText("scheduler-certificate", file=str(path)))

    def connect(opened: ExitStack) -> Client:
        from distributed import Client, Security

        security = Security(
            tls_ca_file=str(certificates.authority),
            tls_client_cert=str(certificates.certificate),
            tls_client_key=str(certificates.key),
            require_encryption=True,
        )
        # Else a scheduler that is lost is a traceback; parts say it.
        logging.getLogger("distributed.client").setLevel(CLUSTER.log_level)
        try:
            client = Client(scheduler, security=security, timeout=CLUSTER.connects_within_s)
        except (OSError, TimeoutError) as error:
            raise ConfigError(
                CodedText("scheduler-silent", scheduler=scheduler, why=str(error))
            ) from error
        opened.callback(_close, client)
        require_workers(seen_workers(client, shared), shared)
        return client

    return Cluster(connect)


def seen_workers(client: Client, shared: Path) -> list[SeenWorker]:
    """Ask all workers for their version, and whether they see a folder of this computer."""
    token = uuid.uuid4().hex
    probe = shared / f".seen-{token}"
    probe.write_text(token, "utf-8")
    try:
        found = client.run(_look, str(probe), token)
    finally:
        probe.unlink()
    return [SeenWorker(address, *said) for address, said in sorted(found.items())]


def require_workers(workers: Sequence[SeenWorker], shared: Path) -> None:
    """Check that workers can do the work of this machine.

    Raises:
        ConfigError: If there are none, one has another version, or does not see the folder.
    """
    if not workers:
        raise ConfigError(CodedText("scheduler-no-workers"))
    for worker in workers:
        if worker.version != recon4.__version__:
            raise ConfigError(
                CodedText(
                    "scheduler-version",
                    address=worker.address,
                    expected=recon4.__version__,
                    got=worker.version,
                )
            )
        if not worker.sees_folder:
            raise ConfigError(
                CodedText("scheduler-folder", address=worker.address, shared=str(shared))
            )


@contextmanager
def _watched(client: Client, futures: Sequence[Any]) -> Iterator[None]:
    """Cancel tasks when there have been no workers for a while; Dask would wait for ever."""
    over = threading.Event()

    def watch() -> None:
        latest_s = time.monotonic() + CLUSTER.without_workers_s
        while not over.wait(CLUSTER.looks_every_s):
            with suppress(Exception):  # a client without its scheduler has errors of any kind
                if client.scheduler_info(n_workers=1)["workers"]:
                    latest_s = time.monotonic() + CLUSTER.without_workers_s
                elif time.monotonic() > latest_s:
                    client.cancel(futures, force=True)
                    return

    threading.Thread(target=watch, daemon=True).start()
    try:
        yield
    finally:
        over.set()


def _close(client: Client) -> None:
    """Close a client; one that lost its scheduler may fail to, by errors of any kind."""
    try:
        client.close()
    except Exception as error:
        log.debug("a client that lost its scheduler could not be closed: %s", error)
        client.status = "closed"  # else this is tried again at the end of the process


def _require() -> None:
    try:
        import distributed  # noqa: F401
    except ImportError as error:
        raise ConfigError(_MISSING) from error


def _look(probe: str, token: str) -> tuple[str, bool]:
    try:
        sees = Path(probe).read_text("utf-8") == token
    except OSError:
        sees = False
    return recon4.__version__, sees


def _on_worker(function: Callable[[Task, Say], Result], task: Task, topic: str) -> Result:
    from distributed import get_worker

    worker = get_worker()
    key = worker.get_current_task()

    def say(name: str, line: str) -> None:
        if not _is_wanted(worker, key):
            raise Cancelled("stopped by the program that sent the task")
        if line:
            worker.log_event(topic, (name, line))

    return function(task, say)


def _is_wanted(worker: Worker, key: Any) -> bool:
    """Whether a task is to go on: its program has neither cancelled it nor ended.

    Asked of this process, not of the scheduler, which may be out of reach.
    """
    state = worker.state.tasks.get(key)
    return state is not None and state.state == "executing"


def _finished(task: Task, future: Any) -> Finished[Task, Any]:
    if future.status == "finished":
        try:
            return Finished(task, future.result())
        except CancelledError:  # this moment
            pass
        except OSError as error:  # the scheduler is gone, and the result with it
            return Finished(task, None, f"its result is lost: {error}")
    if future.status in ("finished", "cancelled"):
        return Finished(task, None, "the scheduler has no workers any more, has ended or lost it")
    return Finished(task, None, f"{type(future.exception()).__name__}: {future.exception()}")
