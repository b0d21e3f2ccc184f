"""The command ``recon4 batch``."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from recon4.cli.terminal import in_terminal, is_progress, worded, write, write_json
from recon4.cli.workers import SchedulerOption, TlsOption, certificates_of

if TYPE_CHECKING:
    from recon4.batch.table import BatchRow
    from recon4.executors.executor import Executor

batches = typer.Typer()


@batches.command()
def batch(  # noqa: PLR0913 - an argument for each option
    folder: Annotated[Path, typer.Argument(help="Holds the recordings: a file or folder a walk.")],
    *,
    out: Annotated[Path, typer.Option(help="Folder of the projects; the table ends up in it.")],
    rig: Annotated[str, typer.Option(help="Rig preset or .toml of all; default: each one's.")] = "",
    preset: Annotated[str, typer.Option("--preset", help="As of process.")] = "indoor",
    calibrate: Annotated[str, typer.Option(help="As of process.")] = "",
    assignments: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="GROUP.NAME=VALUE", help="Change one setting; repeatable."),
    ] = None,
    workers: Annotated[
        int, typer.Option(help="Walks at a time on this computer; needs Dask if more than one.")
    ] = 1,
    scheduler: SchedulerOption = "",
    tls: TlsOption = None,
    as_json: Annotated[bool, typer.Option("--json", help="Write JSON for programs.")] = False,
) -> None:
    """Make a map of every walk of a folder; started again, it continues where it stopped.

    Exit code 1 if a walk failed. A map that is to be checked has not failed.
    """
    from recon4.batch.run import run_batch
    from recon4.batch.walks import find_walks, walk_tasks
    from recon4.cli.confinement import compile_first
    from recon4.settings import override
    from recon4.settings import preset as settings_of
    from recon4.store.atomic import make_folders

    override(settings_of(preset), assignments or [])  # before any walk complains of it
    found = find_walks(folder)
    options = ["--preset", preset]
    options += ["--rig", _rig(rig)] * bool(rig) + ["--calibrate", calibrate] * bool(calibrate)
    options += [word for one in assignments or () for word in ("--set", one)]
    tasks = walk_tasks(folder, found.recordings, out=out, options=tuple(options))
    if found.left_out:
        _say("", worded("batch-left-out", names=", ".join(found.left_out)))
    compile_first()
    make_folders(out)
    with _executor(workers, scheduler, tls=tls, out=out) as executor:
        rows = run_batch(tasks, out, executor, say=_say, ended=_ended)
    _show(rows, as_json=as_json)


def _executor(workers: int, scheduler: str, *, tls: Path | None, out: Path) -> Executor:
    from recon4.executors.cluster import workers_here, workers_of
    from recon4.executors.executor import InOrder

    if scheduler:
        return workers_of(scheduler, certificates_of(tls), out.absolute())
    return workers_here(workers) if workers != 1 else InOrder()


def _rig(rig: str) -> str:
    """A rig file by its absolute path: processes of walks run elsewhere."""
    return str(Path(rig).absolute()) if Path(rig).is_file() else rig


def _say(name: str, line: str) -> None:
    if is_progress(line):
        return
    sys.stderr.write(f"{name}: {line}\n" if name else f"{line}\n")
    sys.stderr.flush()


def _ended(row: BatchRow) -> None:
    result = worded("batch-ended", result=row.result)
    _say(row.walk, ", ".join(part for part in (result, row.why) if part))


def _show(rows: list[BatchRow], *, as_json: bool) -> None:
    from recon4.batch.table import FAILED, table_lines

    if as_json:
        write_json(rows)
    else:
        write("\n".join(table_lines(rows, in_terminal)))
    if any(row.result == FAILED for row in rows):
        raise typer.Exit(1)
