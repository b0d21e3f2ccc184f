"""Versions of our own file formats.

A file says its version, and a reader refuses another one: nothing is misread. Raise a number with
the change that makes older programs misread the file.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class FileFormats:
    """What is written, and read."""

    project: int = 1
    """``project.json``."""
    ledger: int = 1
    """The ledger of the stages (``PRAGMA user_version``)."""
    seal: int = 1
    """Hashes of the files of an artifact."""
    tiles: int = 3
    """``tiles.json`` and the blocks of the tiles."""
    coarse_tiles: int = 2
    """The same with positions in steps of 0.49 mm, which are only read."""
    earlier_tiles: int = 1
    """Tiles in plain columns, which are only read."""
    summary: int = 3
    """``summary.json``; those of formats 1 and 2 are shown, too."""
    approval: int = 4
    """What is signed."""
    newest_approval: int = 1
    """What a user's computer remembers of the newest approval of a project."""
    trusted_key: int = 1
    """The key of a person whose approvals are trusted."""
    backup: int = 1
    """The list of a backup."""
    delivery: int = 1
    """``manifest.json`` of a delivery."""

    @property
    def read_tiles(self) -> tuple[int, ...]:
        """Formats of tiles that are read."""
        return self.earlier_tiles, self.coarse_tiles, self.tiles


FORMATS = FileFormats()
