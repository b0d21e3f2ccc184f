"""rosbag2 storage files in SQLite, read as tables only.

A database from a stranger is a program: views, triggers, generated columns and virtual tables run
when they are queried. Here only the rows of two plain tables are read, in the order of the table
itself, so that no index and no expression of the file has a say.
"""

from __future__ import annotations

import os
from array import array
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import replace
from itertools import islice
from pathlib import Path
from typing import Any

import apsw
import numpy as np
from numpy.typing import NDArray

from recon4.errors import CorruptFile, EmptyRecording
from recon4.locales.coded import CodedText, coded
from recon4.model.finding import Value
from recon4.model.finding_kinds import FindingKind
from recon4.recording.formats.bag_clock import rows_going_on
from recon4.recording.formats.chunks import BagIndex, RawMessage, Topic
from recon4.recording.formats.limits import (
    MAX_MESSAGE_BYTES,
    MAX_TOPICS,
    clean_name,
    definition_text,
)
from recon4.recording.formats.sqlite_tree import check_table_tree
from recon4.recording.report import ImportReport

MAGIC = b"SQLite format 3\0"
_PROGRESS_STEPS = 100_000
_MAX_SILENT_STEPS = 500
"""Calls of the progress handler without a row in between: 50 million steps of SQLite."""
_HEAP_BYTES = 512 << 20
_LIMITS = {
    apsw.SQLITE_LIMIT_LENGTH: MAX_MESSAGE_BYTES + 4096,
    apsw.SQLITE_LIMIT_SQL_LENGTH: 100_000,
    apsw.SQLITE_LIMIT_COLUMN: 100,
    apsw.SQLITE_LIMIT_EXPR_DEPTH: 50,
    apsw.SQLITE_LIMIT_COMPOUND_SELECT: 2,
    apsw.SQLITE_LIMIT_VDBE_OP: 25_000,
    apsw.SQLITE_LIMIT_FUNCTION_ARG: 8,
    apsw.SQLITE_LIMIT_ATTACHED: 0,
    apsw.SQLITE_LIMIT_LIKE_PATTERN_LENGTH: 100,
    apsw.SQLITE_LIMIT_TRIGGER_DEPTH: 1,
    apsw.SQLITE_LIMIT_WORKER_THREADS: 0,
}
_DEFINITIONS = "message_definitions"
"""Table of bags since ROS 2 Iron."""
_COLUMNS = {
    "topics": ("id", "name", "type"),
    "messages": ("topic_id", "timestamp", "data"),
    _DEFINITIONS: ("topic_type", "encoded_message_definition"),
}


class Db3:
    """One storage file that is open; close it."""

    ros1 = False

    def __init__(self, path: Path, report: ImportReport) -> None:
        """Read topics and times.

        Raises:
            CorruptFile: If it is no database of plain tables, or not a message of it is left.
            EmptyRecording: If it has no bytes.
        """
        self._name, self.report = path.name, report
        self._silent = 0
        self._damage = ""
        whole, page_bytes = _pages(path)
        check_table_tree(path, 1, page_bytes)
        with _reading(path.name, whole=whole):
            self._database = self._open(path, whole=whole)
        try:
            with _reading(path.name, whole=whole):
                roots = _require_tables(self._database, path.name)
                for root in roots.values():
                    check_table_tree(path, root, page_bytes)
                self._defines = _DEFINITIONS in roots
                self._database.set_authorizer(_authorize)
                topics = self._topics()
                self._rows = self._scan()
            if not whole or self._damage:
                self._salvaged(whole)
            self.index = self._index(topics)
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        """Close the database."""
        self._database.close()

    def messages(self, topics: set[str]) -> Iterator[RawMessage]:
        """Messages of some topics in order of time."""
        t_ns, row_id, number = self._rows
        known = self.index.topics
        wanted = [k for k, topic in known.items() if topic.topic in topics]
        kept = np.flatnonzero(np.isin(number, wanted))
        kept = kept[np.argsort(t_ns[kept], kind="stable")]
        mirror_ns = self.index.mirror_ns
        kept = kept[::-1] if mirror_ns else kept
        for k in array("q", kept.astype(np.int64).tobytes()):
            data = self._data(int(row_id[k]))
            if data is not None:
                topic = known[int(number[k])]
                at_ns = int(mirror_ns - t_ns[k]) if mirror_ns else int(t_ns[k])
                yield topic.topic, topic.msgtype, at_ns, data

    def go_on(self) -> None:
        """Continue the times where the recorder was set back."""
        t_ns, row_id, number = self._rows
        t_ns, steps = rows_going_on(t_ns, number)
        self._rows = t_ns, row_id, number
        self.index = replace(self.index, steps=steps)
        self.index.start_time, self.index.end_time = _span(t_ns)

    # -- opening

    def _open(self, path: Path, *, whole: bool) -> apsw.Connection:
        apsw.hard_heap_limit(_HEAP_BYTES)
        if not whole:
            _register_cut_file()
        database = apsw.Connection(
            f"{path.resolve().as_uri()}?mode=ro&immutable=1",
            flags=apsw.SQLITE_OPEN_READONLY | apsw.SQLITE_OPEN_URI,
            vfs=None if whole else _CUT_FILE,
        )
        for limit, most in _LIMITS.items():
            database.limit(limit, most)
        database.config(apsw.SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0)
        database.config(apsw.SQLITE_DBCONFIG_DEFENSIVE, 1)
        database.config(apsw.SQLITE_DBCONFIG_ENABLE_VIEW, 0)
        database.config(apsw.SQLITE_DBCONFIG_ENABLE_TRIGGER, 0)
        database.set_progress_handler(self._is_stuck, _PROGRESS_STEPS)
        for pragma in ("cell_size_check = ON", "mmap_size = 0", "cache_size = -16384"):
            database.execute(f"PRAGMA {pragma}")
        return database

    def _is_stuck(self) -> bool:
        """Interrupt a statement that runs too long without returning a row."""
        self._silent += 1
        return self._silent > _MAX_SILENT_STEPS

    def _topics(self) -> dict[int, Topic]:
        found: dict[int, Topic] = {}
        texts = self._definitions()
        for number, name, kind in self._execute("SELECT id, name, type FROM topics NOT INDEXED"):
            if not isinstance(number, int) or len(found) >= MAX_TOPICS or number in found:
                raise CorruptFile(
                    CodedText(
                        "db3-topics",
                        name=self._name,
                        max_topics=MAX_TOPICS,
                        number=repr(number),
                        count=len(found),
                    )
                )
            text = texts.get(str(kind), "")
            found[number] = Topic(clean_name(str(name)), clean_name(str(kind)), definition=text)
        return found

    def _definitions(self) -> dict[str, str]:
        """Definitions of types; files before ROS 2 Iron have none."""
        if not self._defines:
            return {}
        query = f"SELECT topic_type, encoded_message_definition FROM {_DEFINITIONS} NOT INDEXED"
        try:
            rows = islice(self._execute(query), MAX_TOPICS)
            return {str(kind): definition_text(str(text)) for kind, text in rows}
        except (apsw.Error, MemoryError, ValueError):
            return {}

    def _scan(self) -> tuple[np.ndarray[Any, Any], ...]:
        """Times, row numbers and topics of the messages, up to the first damage."""
        t_ns, row_id, number = array("q"), array("q"), array("q")
        rows = self._execute("SELECT rowid, topic_id, timestamp FROM messages NOT INDEXED")
        bad = 0
        try:
            for row, topic, time in rows:
                if row_id and row <= row_id[-1]:
                    self._damage = CodedText("db3-rows-order", row=row, before=row_id[-1])
                    break
                if isinstance(topic, int) and isinstance(time, int) and 0 <= time < 2**62:
                    t_ns.append(time)
                    row_id.append(row)
                    number.append(topic)
                else:
                    bad += 1
        except (apsw.Error, MemoryError, ValueError) as error:
            self._damage = coded(CorruptFile(str(error) or type(error).__name__))
        if bad:
            self._corrupt(bad)
        return tuple(np.frombuffer(column, np.int64) for column in (t_ns, row_id, number))

    def _index(self, topics: dict[int, Topic]) -> BagIndex:
        t_ns, row_id, number = self._rows
        if len(number) and not topics:
            raise CorruptFile(CodedText("db3-no-topics", name=self._name, count=len(number)))
        counts = Counter(number.tolist())
        for k, topic in topics.items():
            topic.msgcount = counts.pop(k, 0)
        if counts:
            self._corrupt(sum(counts.values()))
            kept = np.isin(number, list(topics))
            self._rows = t_ns, row_id, number = t_ns[kept], row_id[kept], number[kept]
        return BagIndex(topics, [], *_span(t_ns))

    def _salvaged(self, whole: bool) -> None:
        count = len(self._rows[0])
        if not count:
            self.report.outcome = "nothing"
            damaged = CodedText("db3-damaged", name=self._name, damage=self._damage)
            raise CorruptFile(damaged if whole else CodedText("db3-cut-off", name=self._name))
        self.report.outcome = "lossy"
        self.report.count("files_cut")
        self.report.count("messages_salvaged", count)
        damage = {"error": self._damage} if self._damage else {}
        self.report.warn(FindingKind.FILE_SALVAGED, name=self._name, messages=count, **damage)

    # -- reading

    def _execute(self, statement: str, values: tuple[int, ...] = ()) -> Iterator[tuple[Any, ...]]:
        self._silent = 0
        for row in self._database.execute(statement, values):
            self._silent = 0
            yield row

    def _data(self, row: int) -> bytes | None:
        """Bytes of a message; None (counted) when they are damaged or too large."""
        try:
            query = "SELECT data FROM messages NOT INDEXED WHERE rowid = ?"
            found = next(self._execute(query, (row,)), (None,))[0]
        except (apsw.Error, MemoryError, ValueError) as error:
            self._corrupt(1, row=row, error=CorruptFile(str(error) or type(error).__name__))
            return None
        if not isinstance(found, bytes):
            self._corrupt(1)
            return None
        return found

    def _corrupt(self, count: int, **where: Value | Exception) -> None:
        self.report.outcome = "lossy"
        self.report.count("messages_corrupt", count)
        self.report.warn(FindingKind.MESSAGES_DAMAGED, name=self._name, **where)


def _span(t_ns: NDArray[np.int64]) -> tuple[int, int]:
    """First time, and the end of the last one [ns]."""
    return (int(t_ns.min()), int(t_ns.max()) + 1) if len(t_ns) else (2**63 - 1, 0)


@contextmanager
def _reading(name: str, *, whole: bool) -> Iterator[None]:
    try:
        yield
    except (apsw.Error, MemoryError, OSError, ValueError) as error:  # ValueError: no UTF-8
        if not whole:
            raise CorruptFile(CodedText("db3-cut-off", name=name)) from error
        raise CorruptFile(CodedText("db3-unreadable", name=name, why=str(error))) from error


def _authorize(action: int, table: str | None, *_: str | None) -> int:
    """Allow reading of the tables of a bag, nothing else."""
    if action == apsw.SQLITE_SELECT:
        return apsw.SQLITE_OK
    if action == apsw.SQLITE_READ and table in _COLUMNS:
        return apsw.SQLITE_OK
    return apsw.SQLITE_DENY


def _require_tables(database: apsw.Connection, name: str) -> dict[str, int]:
    """Root pages of the tables; that of the definitions may be missing.

    Raises:
        CorruptFile: If one is a view, a virtual table, missing, or computes a column.
    """
    roots = {table: _root(database, table, name) for table in _COLUMNS if table != _DEFINITIONS}
    with suppress(CorruptFile):
        roots[_DEFINITIONS] = _root(database, _DEFINITIONS, name)
    return roots


def _root(database: apsw.Connection, table: str, name: str) -> int:
    """Check that a table is a plain one with plain columns; gives its root page.

    Raises:
        CorruptFile: As `_require_tables`.
    """
    query = "SELECT type, rootpage FROM sqlite_schema WHERE name = ?"
    found = [*database.execute(query, (table,))]
    if len(found) != 1 or found[0][0] != "table" or not found[0][1]:
        kinds = ", ".join(f"a {kind}" for kind, _ in found) or "nothing"
        kinds = kinds if kinds != "a table" else "a virtual table"
        raise CorruptFile(CodedText("db3-table", name=name, table=table, kinds=kinds))
    query = "SELECT name, hidden FROM pragma_table_xinfo(?)"
    hidden = dict(database.execute(query, (table,)))
    for column in _COLUMNS[table]:
        if hidden.get(column) != 0:
            got = "none" if column not in hidden else "one that is computed"
            raise CorruptFile(
                CodedText("db3-column", name=name, column=column, table=table, got=got)
            )
    if {"rowid", "oid", "_rowid_"} & {str(column).lower() for column in hidden}:
        raise CorruptFile(CodedText("db3-table-hides", name=name, table=table))
    return int(found[0][1])


# -- files that were cut off


_CUT_FILE = "recon4-cut-file"


def _page_bytes(header: bytes) -> int:
    page = int.from_bytes(header[16:18], "big")
    return 65536 if page == 1 else page


def _pages(path: Path) -> tuple[bool, int]:
    """Whether the file has all the pages that its header counts, and the size of a page.

    Raises:
        CorruptFile: If there is not even one page.
        EmptyRecording: If it has no bytes.
    """
    with path.open("rb") as file:
        header = file.read(100)
        size = os.fstat(file.fileno()).st_size
    if not header:
        raise EmptyRecording(CodedText("file-empty", name=path.name))
    page = _page_bytes(header)
    if not header.startswith(MAGIC) or page < 512 or size < page:
        raise CorruptFile(
            CodedText(
                "db3-too-short", name=path.name, page=page, size=size, bytes=header[:8].hex(" ")
            )
        )
    return int.from_bytes(header[28:32], "big") * page <= size, page


class _CutFile(apsw.VFSFile):
    """Presents a truncated file with a matching page count, because SQLite refuses it otherwise.

    Nothing is copied: the four bytes are replaced as they are read.
    """

    def __init__(self, name: Any, flags: list[int]) -> None:
        super().__init__("", name, flags)
        self._size = super().xFileSize()
        page = _page_bytes(super().xRead(100, 0))
        self._pages = self._size // page
        self._size = self._pages * page

    def xFileSize(self) -> int:  # noqa: N802
        return self._size

    def xRead(self, amount: int, offset: int) -> bytes:  # noqa: N802
        data = super().xRead(amount, offset)
        if offset <= 28 and offset + len(data) >= 32:
            at = 28 - offset
            data = data[:at] + self._pages.to_bytes(4, "big") + data[at + 4 :]
        return data


class _CutFileSystem(apsw.VFS):
    def __init__(self) -> None:
        super().__init__(_CUT_FILE, "")

    def xOpen(self, name: Any, flags: list[int]) -> _CutFile:  # noqa: N802
        return _CutFile(name, flags)


_file_systems: list[_CutFileSystem] = []


def _register_cut_file() -> None:
    """SQLite knows a file system by its name as long as the object lives."""
    if not _file_systems:
        _file_systems.append(_CutFileSystem())


def is_db3(path: Path) -> bool:
    """Whether a file begins as a database of SQLite."""
    with path.open("rb") as file:
        return file.read(16) == MAGIC
