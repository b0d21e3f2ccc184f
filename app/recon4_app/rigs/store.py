"""Rigs of the server: versions of rig files below ``<root>/rigs``, which never change.

rigs/<id>/<number>/<id>-v<number>.toml     the rig file
rigs/<id>/<number>/version.json            who, when, note, evidence, hashes
"""

from __future__ import annotations

import hashlib
import re
import threading
from collections.abc import Iterator
from datetime import UTC, datetime
from pathlib import Path
from stat import S_ISREG

from recon4.errors import StoreError
from recon4.locales.coded import CodedText
from recon4.model.limits import RIG_LIMITS
from recon4.model.rig import rig_presets
from recon4.store.atomic import atomic_folder, make_folders, sweep, write_json, write_text
from recon4.store.json_files import read_object
from recon4.store.project import is_project
from recon4.untrusted.names import visible
from recon4_app.errors import Conflict, NotFound, Remedy
from recon4_app.rigs.model import RIG_ID, RigVersion
from recon4_app.rigs.rig_work import CheckedRig
from recon4_app.rigs.tuning import RIG_STORE

RIGS = "rigs"
"""Folder of the rigs below that of the projects."""
VERSION_FILE = "version.json"
_NUMBER = re.compile(r"[1-9][0-9]{0,2}")


class RigStore:
    """Reads and adds versions of rigs. Paths are made from checked names only."""

    def __init__(self, root: Path) -> None:
        self._folder = root.resolve() / RIGS
        self._adding = threading.Lock()

    def ids(self) -> list[str]:
        """Names of the rigs with at least one version."""
        return [folder.name for folder in _rig_folders(self._folder)]

    def versions(self, rig_id: str) -> list[RigVersion]:
        """Versions of a rig, the newest first.

        Raises:
            NotFound: If there is no such rig.
        """
        numbers = _numbers(self._folder / rig_id) if re.fullmatch(RIG_ID, rig_id) else []
        if not numbers:
            raise NotFound(CodedText("rig-unknown", name=rig_id[:64]))
        return [self._version(rig_id, number) for number in numbers]

    def file(self, rig_id: str, number: int | None = None) -> Path:
        """The file of a version; None = the newest.

        Raises:
            NotFound: If there is no such rig or version.
        """
        numbers = [version.number for version in self.versions(rig_id)]
        chosen = numbers[0] if number is None else number
        if chosen not in numbers:
            raise NotFound(CodedText("rig-version-unknown", rig=rig_id, version=chosen))
        return _file(self._folder, rig_id, chosen)

    def create(self, rig_id: str, rig: CheckedRig, **about: str) -> RigVersion:
        """Store the first version of a rig.

        Args:
            rig_id: Name of its folder.
            rig: The rig.
            about: ``who``, ``note`` and ``evidence``.

        Raises:
            Conflict: If the name is taken, or there are too many rigs.
        """
        with self._adding:
            self._refuse_name(rig_id)
            return self._add(rig_id, 1, rig, about=about)

    def add(self, rig_id: str, rig: CheckedRig, *, after: int | None, **about: str) -> RigVersion:
        """Store the next version of a rig.

        Args:
            rig_id: Name of its folder.
            rig: The rig.
            after: Newest version the person has seen; None = any.
            about: ``who``, ``note`` and ``evidence``.

        Raises:
            NotFound: If there is no such rig.
            Conflict: If there is a newer version, or there are too many.
        """
        with self._adding:
            newest = self.versions(rig_id)[0].number
            if after is not None and after != newest:
                raise Conflict(
                    CodedText("rig-changed", rig=rig_id, newest=newest, seen=after),
                    remedy=Remedy(
                        "see-rig", f"/rigs/{rig_id}/", needs="look", about={"rig": rig_id}
                    ),
                )
            if newest >= RIG_STORE.max_versions:
                raise Conflict(
                    CodedText("rig-versions-too-many", rig=rig_id, limit=RIG_STORE.max_versions)
                )
            return self._add(rig_id, newest + 1, rig, about=about)

    def _refuse_name(self, rig_id: str) -> None:
        if rig_id in rig_presets():
            raise Conflict(CodedText("rig-shipped", rig=rig_id))
        if is_project(self._folder):
            raise Conflict(CodedText("rigs-folder-taken", folder=RIGS))
        if (self._folder / rig_id).exists():
            raise Conflict(CodedText("rig-exists", rig=rig_id))
        if len(self.ids()) >= RIG_STORE.max_rigs:
            raise Conflict(CodedText("rigs-too-many", limit=RIG_STORE.max_rigs))

    def _add(
        self, rig_id: str, number: int, rig: CheckedRig, *, about: dict[str, str]
    ) -> RigVersion:
        home = self._folder / rig_id
        make_folders(home)
        sweep(home)
        with atomic_folder(home / str(number)) as folder:
            write_text(folder / _file_name(rig_id, number), rig.toml)
            row = {
                "number": number,
                **about,
                "when": datetime.now(UTC).isoformat(timespec="seconds"),
                "name": rig.name,
                "sensors": rig.sensors,
                "digest": rig.digest,
                "sha256": hashlib.sha256(rig.toml.encode("utf-8")).hexdigest(),
            }
            write_json(folder / VERSION_FILE, row)
        return self._version(rig_id, number)

    def _version(self, rig_id: str, number: int) -> RigVersion:
        """A version as stored; with a damaged description only its number and the problem."""
        path = _file(self._folder, rig_id, number)
        try:
            row = read_object(path.with_name(VERSION_FILE), max_bytes=RIG_STORE.max_version_bytes)
            problem = ""
        except StoreError as error:
            row, problem = {}, visible(str(error).replace(f"{self._folder}/", ""), most=400)
        sensors = row.get("sensors")
        return RigVersion(
            number=number,
            path=str(path),
            who=_text(row, "who"),
            when=_text(row, "when"),
            note=_text(row, "note", most=500),
            evidence=_text(row, "evidence", most=RIG_STORE.max_evidence),
            name=_text(row, "name") or rig_id,
            sensors=[visible(str(one)) for one in sensors] if isinstance(sensors, list) else [],
            digest=_text(row, "digest"),
            sha256=_text(row, "sha256"),
            problem=problem,
        )


def newest_files(folder: Path) -> Iterator[Path]:
    """The newest version of each rig in a folder ``rigs``."""
    for home in _rig_folders(folder):
        yield _file(folder, home.name, _numbers(home)[0])


def _rig_folders(folder: Path) -> list[Path]:
    if folder.is_symlink() or not folder.is_dir() or is_project(folder):
        return []
    named = (path for path in sorted(folder.iterdir()) if re.fullmatch(RIG_ID, path.name))
    return [path for path in named if _numbers(path)]


def _numbers(home: Path) -> list[int]:
    """Numbers of the versions in the folder of a rig, the newest first."""
    if home.is_symlink() or not home.is_dir():
        return []
    found = (int(path.name) for path in home.iterdir() if _NUMBER.fullmatch(path.name))
    return sorted((n for n in found if _is_file(_file(home.parent, home.name, n))), reverse=True)


def _file(folder: Path, rig_id: str, number: int) -> Path:
    return folder / rig_id / str(number) / _file_name(rig_id, number)


def _file_name(rig_id: str, number: int) -> str:
    return f"{rig_id}-v{number}.toml"


def _is_file(path: Path) -> bool:
    try:
        found = path.lstat()
    except OSError:
        return False
    regular = S_ISREG(found.st_mode) and not path.parent.is_symlink()
    return regular and found.st_size <= RIG_LIMITS.file_bytes


def _text(row: dict[str, object], key: str, *, most: int = 200) -> str:
    value = row.get(key, "")
    if not isinstance(value, str):
        return ""
    return "\n".join(visible(line, most=most) for line in value[:most].splitlines())
