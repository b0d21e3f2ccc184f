"""Keeps the server's record of the newest approval of each project (`newest_approval`)."""

from __future__ import annotations

import logging
from pathlib import Path

from recon4.errors import StoreError
from recon4.review.approved import newest_counts
from recon4.review.newest_approval import record_newest, replace_record
from recon4.store.project import is_project

log = logging.getLogger(__name__)


def record_signed(project: Path, state: Path) -> None:
    """Record the approval that was just signed; a failure is logged, `record_all` tries again.

    Who approves an older state takes it as it is, so an earlier record gives way.
    """
    try:
        replace_record(project, state)
    except (StoreError, OSError):
        log.exception("could not record the approval of %s", project.name)


def record_all(root: Path, state: Path) -> None:
    """Record what a killed server, or one of an earlier version, did not.

    Args:
        root: The folder of the projects.
        state: The server's own files.
    """
    for project in sorted(root.iterdir()):
        try:
            if is_project(project) and newest_counts(project):
                record_newest(project, state)
        except (StoreError, OSError) as error:
            log.warning("the approval of %s is not recorded: %s", project.name, error)
