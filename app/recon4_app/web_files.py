"""The files of the pages below addresses that name their content, so that browsers keep them.

    /web/KEY/map/map.js    kept for ever: another content has another key
    /web/map/map.js        the same file, asked for again each time

A page names the key; modules import each other by relative addresses, so they have it, too.
"""

from __future__ import annotations

import hashlib
import os
import re
from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path

from starlette.responses import Response
from starlette.staticfiles import StaticFiles
from starlette.types import Scope

PathLike = str | os.PathLike[str]

_KEY = re.compile(r"([0-9a-f]{16})/(.*)", re.DOTALL)
_KEPT = "recon4.web_key"
"""In the scope of a request: the key in its address."""
FOREVER = "public, max-age=31536000, immutable"


def key_of(folder: Path) -> str:
    """Hash of the content of a folder; read again only if a file of it has changed."""
    return _key_of(tuple(_files(folder)))


def _files(folder: Path, below: str = "") -> Iterator[tuple[str, str, int, int]]:
    """Path, name, size and time of change of each file."""
    for entry in sorted(os.scandir(folder), key=lambda one: one.name):
        name = f"{below}{entry.name}"
        if entry.is_dir():
            yield from _files(Path(entry.path), f"{name}/")
        else:
            known = entry.stat()
            yield entry.path, name, known.st_size, known.st_mtime_ns


@lru_cache(maxsize=4)
def _key_of(files: tuple[tuple[str, str, int, int], ...]) -> str:
    content = hashlib.sha256()
    for path, name, *_ in files:
        content.update(f"{name}\0{hashlib.sha256(Path(path).read_bytes()).hexdigest()}\n".encode())
    return content.hexdigest()[:16]


class WebFiles(StaticFiles):
    """The files of the pages, with and without the key of their content in the address."""

    def __init__(self, *, directory: Path) -> None:
        super().__init__(directory=directory)
        self._key = key_of(directory)
        self._known = {name: (size, t_ns) for _, name, size, t_ns in _files(directory)}

    async def get_response(self, path: str, scope: Scope) -> Response:
        """A file; browsers keep one whose content is that of the key in its address."""
        keyed = _KEY.fullmatch(path)
        name = keyed[2] if keyed else path
        scope[_KEPT] = keyed[1] if keyed else ""
        return await super().get_response(name, scope)

    def file_response(
        self,
        full_path: PathLike,
        stat_result: os.stat_result,
        scope: Scope,
        *more: int,
        **named: int,
    ) -> Response:
        """The response to a request that may be conditional."""
        response = super().file_response(full_path, stat_result, scope, *more, **named)
        name = os.path.relpath(full_path, os.path.realpath(str(self.directory)))
        found = (stat_result.st_size, stat_result.st_mtime_ns)
        if scope.get(_KEPT) == self._key and self._known.get(name) == found:
            response.headers["Cache-Control"] = FOREVER
        return response
