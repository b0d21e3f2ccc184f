"""Files and folders of this computer that requests may name and list."""

from __future__ import annotations

import os
import stat
import sys
from collections.abc import Iterable
from pathlib import Path

from recon4.locales.coded import CodedText
from recon4.untrusted.names import is_unnameable, visible
from recon4_app.errors import NotFound, Refused
from recon4_app.projects.model import FolderEntry
from recon4_app.projects.tuning import IMPORT_FOLDERS

SYSTEM = tuple(map(Path, ("/boot", "/dev", "/etc", "/proc", "/run", "/sys")))
"""Never recordings, even where a folder of recordings contains them (``/``)."""
RENAME = "rename it: its name is no UTF-8 text"


class ImportFolders:
    """The folders for recordings, without hidden, private and system files.

    A path is resolved first, links included. Then it must lie in one of the folders, with no hidden
    name (``.recon4``, ``.ssh``) between that folder and the file.
    """

    def __init__(self, folders: Iterable[Path], *, private: Iterable[Path] = ()) -> None:
        """Resolve the folders.

        Args:
            folders: Folders of recordings.
            private: Files and folders that are never accessible, such as the server's own.
        """
        self._folders = tuple(dict.fromkeys(folder.resolve() for folder in folders))
        self._private = tuple(path.resolve() for path in private)

    def checked(self, path: str) -> Path:
        """The real path of a file or folder, if requests may name it.

        Raises:
            Refused: If it is outside of the folders, hidden, or neither a file nor a folder.
            NotFound: If it does not exist.
        """
        try:
            real = Path(path).resolve()
        except (OSError, ValueError, RuntimeError) as error:
            raise NotFound(CodedText("path-unknown", path=path[:200])) from error
        if is_unnameable(real):
            raise Refused(CodedText("path-no-utf8", path=visible(str(real))))
        if not self._within(real):
            folders = ", ".join(str(folder) for folder in self._folders)
            raise Refused(CodedText("path-not-allowed", folders=folders))
        if not self._visible(real):
            raise Refused(CodedText("path-hidden", path=path[:200]))
        mode = _mode(real)
        if mode is None:  # also for a name that no file can have
            raise NotFound(CodedText("path-unknown", path=path[:200]))
        if not (stat.S_ISREG(mode) or stat.S_ISDIR(mode)):
            raise Refused(CodedText("path-special", path=path[:200]))
        return real

    def shows(self, path: Path) -> bool:
        """Whether requests may name a path."""
        try:
            self.checked(str(path))
        except (NotFound, Refused):
            return False
        return True

    def entries(self, folder: str) -> list[FolderEntry]:
        """List a folder, folders first; for an empty path the folders of recordings.

        Raises:
            Refused: If requests may not name it.
            NotFound: If it is not a folder, or cannot be read.
        """
        if not folder:
            return [_entry(one, str(one)) for one in self._folders if self.shows(one)]
        real = self.checked(folder)
        try:
            inside = [path for path in real.iterdir() if not path.name.startswith(".")]
        except OSError as error:
            raise NotFound(
                CodedText("folder-unreadable", folder=folder[:200], reason=error.strerror or "")
            ) from error
        shown = [path for path in inside if self.shows(path)]
        shown.sort(key=lambda path: (not path.is_dir(), path.name.lower()))
        unnameable = sorted(path for path in inside if is_unnameable(path))
        found = [_entry(path, path.name) for path in shown]
        return [*found, *map(_unnameable_entry, unnameable)][: IMPORT_FOLDERS.max_entries]

    def _within(self, real: Path) -> bool:
        return any(real.is_relative_to(folder) for folder in self._folders)

    def _visible(self, real: Path) -> bool:
        if any(real.is_relative_to(path) for path in self._private):
            return False
        return any(
            _openly_below(folder, real) for folder in self._folders if real.is_relative_to(folder)
        )


def _openly_below(folder: Path, real: Path) -> bool:
    """Whether nothing hidden and no system folder lies between a folder and a path in it."""
    if any(part.startswith(".") for part in real.relative_to(folder).parts):
        return False
    return not any(real.is_relative_to(one) and not folder.is_relative_to(one) for one in SYSTEM)


def _mode(path: Path) -> int | None:
    try:
        return os.stat(path).st_mode
    except (OSError, ValueError):
        return None


def _entry(path: Path, name: str) -> FolderEntry:
    folder = path.is_dir()
    return FolderEntry(
        name=name, path=str(path), folder=folder, bytes=0 if folder else path.stat().st_size
    )


def _unnameable_entry(path: Path) -> FolderEntry:
    """Listed, so that nobody misses it; to open it is refused with the same words."""
    name = f"{visible(path.name)} ({RENAME})"
    return FolderEntry(name=name, path=visible(str(path), most=sys.maxsize), folder=False, bytes=0)
