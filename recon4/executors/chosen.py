"""The workers that an administrator chose for the jobs of a server: a file of its own folder.

The certificates lie beside it and were put there by hand: a person on a page can name a scheduler,
but only one that the same authority has signed.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

import msgspec

from recon4.errors import ConfigError, StoreError
from recon4.executors.tuning import CLUSTER
from recon4.locales.coded import CodedText, at, text_of
from recon4.store.atomic import write_json
from recon4.store.json_files import read_object
from recon4.untrusted.typed import as_type

if TYPE_CHECKING:
    from recon4.executors.cluster import Certificates, Cluster

CERTIFICATES = "cluster"
"""Folder of the certificates: ``ca.pem``, ``client.pem``, ``client-key.pem``."""
_FILE = "workers.json"
_SCHEDULER = re.compile(r"tls://[A-Za-z0-9.\-\[\]:]{1,250}:[0-9]{1,5}")
_DASHBOARD = re.compile(r"https?://[!-~]{1,400}")


class ChosenWorkers(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Who makes the parts of a job that can be divided."""

    count: int = 0
    """Processes of this computer; 0 = none."""
    scheduler: str = ""
    """Address of a scheduler of Dask, ``tls://HOST:PORT``; empty = none."""
    dashboard: str = ""
    """Address of its dashboard, which is shown to administrators; empty = none."""

    @property
    def used(self) -> bool:
        """Whether there are any; without, threads of the job make all."""
        return bool(self.count or self.scheduler)


def checked_choice(chosen: ChosenWorkers) -> ChosenWorkers:
    """A choice that makes sense.

    Raises:
        ConfigError: If the count or an address is none, or both kinds of workers are chosen.
    """
    most = CLUSTER.most_workers
    if not 0 <= chosen.count <= most:
        raise ConfigError(CodedText("workers-count", most=most, got=chosen.count))
    if chosen.scheduler and not _SCHEDULER.fullmatch(chosen.scheduler):
        raise ConfigError(CodedText("workers-scheduler-malformed"))
    if chosen.dashboard and not _DASHBOARD.fullmatch(chosen.dashboard):
        raise ConfigError(CodedText("workers-dashboard-malformed"))
    if chosen.count and chosen.scheduler:
        raise ConfigError(CodedText("workers-both"))
    return chosen


def read_choice(state: Path) -> ChosenWorkers:
    """The choice of a server; nobody if it has none.

    Args:
        state: Folder of the server's own files.

    Raises:
        StoreError: If the file is damaged.
    """
    path = state / _FILE
    if not path.exists():
        return ChosenWorkers()
    try:
        return checked_choice(as_type(read_object(path), ChosenWorkers))
    except (msgspec.ValidationError, ConfigError) as error:
        raise StoreError(at(str(path), text_of(error))) from error


def store_choice(state: Path, chosen: ChosenWorkers) -> None:
    """Keep a choice for the jobs that begin from now on.

    Raises:
        ConfigError: As `checked_choice`.
        StoreError: If it cannot be written.
    """
    write_json(state / _FILE, msgspec.to_builtins(checked_choice(chosen)))


def chosen_cluster(state: Path, chosen: ChosenWorkers, shared: Path) -> Cluster:
    """The workers of a choice that names some; they are checked when the cluster is entered.

    Args:
        state: Folder of the server's own files.
        chosen: The choice.
        shared: Folder that this computer and all workers see under the same name.

    Raises:
        ConfigError: If they cannot be used.
    """
    from recon4.executors.cluster import workers_here, workers_of

    if chosen.scheduler:
        return workers_of(chosen.scheduler, certificates_in(state / CERTIFICATES), shared)
    return workers_here(chosen.count)


def certificates_in(folder: Path) -> Certificates:
    """The files of a folder of certificates."""
    from recon4.executors.cluster import Certificates

    return Certificates(folder / "ca.pem", folder / "client.pem", folder / "client-key.pem")
