"""The table of a batch: one row a walk, written after each that ended."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict, dataclass, fields
from pathlib import Path

import msgspec

from recon4.batch.walk_process import WalkOutcome
from recon4.batch.walks import WalkTask
from recon4.errors import StoreError
from recon4.executors.executor import Finished
from recon4.export.cells import safe_cell
from recon4.locales.coded import CodedText
from recon4.model.usability import verdict_in
from recon4.store.atomic import write_json, write_text
from recon4.store.json_files import read_object
from recon4.store.project import SUMMARY
from recon4.untrusted.typed import as_type

FAILED, UNFINISHED = "failed", "unfinished"


@dataclass(frozen=True, slots=True)
class _SummaryFigures:
    """What the table takes from a summary; fields as in `BatchRow`."""

    duration_s: float
    path_length_m: float
    seconds: float
    peak_bytes: int


@dataclass(frozen=True, slots=True, kw_only=True)
class BatchRow:
    """What became of one walk."""

    walk: str
    """Name of its project."""
    result: str
    """Verdict on its map, or failed; unfinished as long as it waits or runs."""
    duration_s: float | None = None
    """Time covered by its trajectory [s]."""
    path_length_m: float | None = None
    seconds: float | None = None
    """Wall clock of its stages [s]."""
    peak_bytes: int | None = None
    """Largest memory of a stage."""
    why: str = ""
    """Its worst finding, or why it failed."""


def row_of(ended: Finished[WalkTask, WalkOutcome]) -> BatchRow:
    """The row of a walk that ended, from the summary in its project."""
    task, outcome = ended.task, ended.result
    if outcome is None:
        return BatchRow(walk=task.name, result=FAILED, why=ended.failure)
    if outcome.exit_code:
        return BatchRow(walk=task.name, result=FAILED, why=outcome.complaint)
    try:
        return _row_of_map(task)
    except StoreError as error:
        return BatchRow(walk=task.name, result=FAILED, why=str(error))


def _row_of_map(task: WalkTask) -> BatchRow:
    summary = read_object(Path(task.out) / SUMMARY)
    verdict = verdict_in(summary)
    try:
        figures = as_type(summary, _SummaryFigures)
    except msgspec.ValidationError as error:
        raise StoreError(
            CodedText("batch-summary", summary=SUMMARY, task=task.name, why=str(error))
        ) from error
    return BatchRow(
        walk=task.name,
        result=verdict.usability if verdict else "no verdict",
        why=verdict.reasons[0] if verdict and verdict.reasons else "",
        **asdict(figures),
    )


def write_table(out: Path, rows: Iterable[BatchRow]) -> None:
    """Write ``batch.json`` and ``batch.csv``.

    Raises:
        StoreError: If they cannot be written.
    """
    records = [asdict(row) for row in rows]
    write_json(out / "batch.json", {"format": 1, "walks": records})
    text = io.StringIO()
    table = csv.DictWriter(text, [field.name for field in fields(BatchRow)], lineterminator="\n")
    table.writeheader()
    table.writerows(
        record | {key: safe_cell(str(record[key])) for key in ("walk", "why")} for record in records
    )
    write_text(out / "batch.csv", text.getvalue())


def table_lines(rows: Sequence[BatchRow], say: Callable[[str], str]) -> list[str]:
    """The table for a terminal.

    Args:
        rows: Of the walks.
        say: Says a coded text in the language of the terminal.
    """
    width = max((len(row.walk) for row in rows), default=4)
    names = ("walk", "result", "duration", "path", "took", "why")
    head = _cells([say(CodedText(f"batch-{name}")) for name in names], width)
    return [head, *(_line(row, width, say) for row in rows)]


def _line(row: BatchRow, width: int, say: Callable[[str], str]) -> str:
    duration = "" if row.duration_s is None else f"{row.duration_s:.0f} s"
    path = "" if row.path_length_m is None else f"{row.path_length_m:.0f} m"
    took = "" if row.seconds is None else f"{row.seconds:.0f} s"
    result = say(CodedText("batch-ended", result=row.result))
    return _cells([row.walk, result, duration, path, took, row.why], width)


def _cells(cells: Sequence[str], width: int) -> str:
    walk, result, duration, path, took, why = cells
    line = f"{walk:<{width}}  {result:<16}  {duration:>8}  {path:>7}  {took:>7}  {why}"
    return line.rstrip()
