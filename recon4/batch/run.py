"""Makes a map of every walk of a folder; started again, it continues where it stopped."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from recon4.batch.table import UNFINISHED, BatchRow, row_of, write_table
from recon4.batch.walk_process import process_walk
from recon4.batch.walks import WalkTask
from recon4.executors.executor import Executor, Say


def run_batch(
    tasks: Sequence[WalkTask],
    out: Path,
    executor: Executor,
    *,
    say: Say,
    ended: Callable[[BatchRow], None],
) -> list[BatchRow]:
    """Process walks, each in a process of its own, and keep the table of what became of them.

    Args:
        tasks: The walks; one that is finished already is only read again.
        out: Folder of the projects, ``batch.json`` and ``batch.csv``.
        executor: Open.
        say: Receives the lines of progress.
        ended: Receives the row of each walk that ended.

    Returns:
        The rows in the order of the tasks.

    Raises:
        StoreError: If the table cannot be written.
    """
    rows = {task.name: BatchRow(walk=task.name, result=UNFINISHED) for task in tasks}
    write_table(out, rows.values())
    for task in tasks:
        say(task.name, f"{task.recording} {' '.join(task.options)}")
    for finished in executor.run(process_walk, tasks, say):
        row = row_of(finished)
        rows[row.walk] = row
        write_table(out, rows.values())
        ended(row)
    return list(rows.values())
