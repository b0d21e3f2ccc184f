"""Copies of ``access.sqlite``, and what the server does when the file is damaged.

A server never starts without the people that it had: that would open it to the first who comes.
Either the newest intact copy replaces the file, or the server does not start.
"""

from __future__ import annotations

import logging
from pathlib import Path

from recon4.errors import StoreError
from recon4.locales.coded import CodedText
from recon4_app.state_copies import StateCopies

log = logging.getLogger(__name__)

ACCESS_FILE = "access.sqlite"


def access_copies(state: Path) -> StateCopies:
    """The copies of the access database.

    Without sessions and guest links, so that none that was ended comes back to life.
    """
    return StateCopies(state / ACCESS_FILE, without=("sessions", "browsers", "guest_links"))


def restore_access(state: Path) -> str:
    """Replace a damaged access database by its newest intact copy.

    Returns:
        A notice about what was restored and lost; empty when nothing was damaged.

    Raises:
        StoreError: If there is no intact copy.
    """
    copies = access_copies(state)
    check_access(state, advice=copies.newest_intact() is None)
    restored = copies.restore()
    if restored is None:
        return ""
    notice = CodedText(
        "notice-people-restored",
        file=ACCESS_FILE,
        damage=restored.damage,
        **restored.kept_as(),
        day=restored.day,
    )
    log.error(notice)
    return notice


def check_access(state: Path, *, advice: bool = True) -> None:
    """Refuse a damaged access database.

    Args:
        state: The server's own folder.
        advice: False = do nothing: there is a copy to restore.

    Raises:
        StoreError: If it is damaged.
    """
    copies = access_copies(state)
    if not advice or not (damage := copies.damage()):
        return
    path = state / ACCESS_FILE
    if copies.newest_intact() is not None:
        raise StoreError(CodedText("access-damaged", file=str(path), damage=damage))
    raise StoreError(CodedText("access-lost", file=str(path), damage=damage, stem=path.stem))
