"""Leftovers of a killed server: ended and removed before the next one starts."""

from __future__ import annotations

import logging
import shutil

from recon4.store.atomic import sweep
from recon4.system.processes import ChildRegister
from recon4_app.settings import ServerSettings
from recon4_app.viewer.pool import socket_folder

log = logging.getLogger(__name__)


def child_register(settings: ServerSettings) -> ChildRegister:
    """The register of a server's child processes."""
    return ChildRegister(settings.state / "children")


def sweep_leftovers(settings: ServerSettings) -> None:
    """End processes and remove sockets and unfinished files of an earlier server.

    Call it only while this server has the folder's lock (`listen.only_one`). Workers of
    jobs and processes of a live capture are no leftovers: they go on, and the server adopts them.
    """
    killed = child_register(settings).end_leftovers()
    if killed:
        log.warning("ended %d processes an earlier server left: %s", len(killed), killed)
    shutil.rmtree(socket_folder(settings.state), ignore_errors=True)
    removed = [
        name
        for folder in (settings.state, settings.state / "thumbnails")
        if folder.is_dir()
        for name in sweep(folder)
    ]
    if removed:
        log.warning("removed %d unfinished files: %s", len(removed), removed[:10])
