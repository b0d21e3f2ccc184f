"""The options that name workers, and the parent of a command that has work done by them."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from signal import Signals
from typing import TYPE_CHECKING, Annotated

import typer

from recon4.errors import ConfigError, Recon4Error
from recon4.locales.coded import CodedText
from recon4.system.stopping import StopSignals

if TYPE_CHECKING:
    from subprocess import Popen

    from recon4.executors.cluster import Certificates
    from recon4.executors.executor import Executor

SchedulerOption = Annotated[
    str, typer.Option(metavar="tls://HOST:PORT", help="Scheduler of Dask whose workers are used.")
]
TlsOption = Annotated[
    Path | None,
    typer.Option(
        metavar="FOLDER", help="Certificates for the scheduler: ca.pem, client.pem, client-key.pem."
    ),
]
WorkersOption = Annotated[
    int,
    typer.Option(min=0, help="Processes that make parts of the map; 0 = threads. Needs Dask."),
]


_OF_WORKERS = ("workers", "scheduler", "tls")
"""Options that are for the parent."""


def certificates_of(folder: Path | None) -> Certificates:
    """The files of the option ``--tls``.

    Raises:
        ConfigError: If no folder is given.
    """
    from recon4.executors.chosen import certificates_in

    if folder is None:
        raise ConfigError(CodedText("scheduler-tls"))
    return certificates_in(folder)


def chosen_workers(workers: int, scheduler: str, *, tls: Path | None, out: Path) -> Executor | None:
    """Workers by the options of a command; None if it names none, or has them already.

    Args:
        workers: Processes of this computer.
        scheduler: Address of a scheduler.
        tls: Folder of its certificates.
        out: Folder that all workers see.

    Raises:
        ConfigError: If they cannot be used.
    """
    from recon4.orders.confined import workers_of_this_process

    if workers_of_this_process() is not None:
        return None
    if scheduler:
        from recon4.executors.cluster import workers_of

        return workers_of(scheduler, certificates_of(tls), out.absolute())
    if workers:
        from recon4.executors.cluster import workers_here

        return workers_here(workers)
    return None


def run_confined(context: typer.Context, out: Path, executor: Executor) -> int:
    """Run a command again in a confined process of its own, and have its orders made by workers.

    Args:
        context: Of the command. Signals are passed on to the process, which says why it ended.
        out: The project, which exists.
        executor: The workers.

    Returns:
        The exit code.

    Raises:
        ConfigError: If the workers cannot be used.
        Recon4Error: If the process was killed, or sent what is no order.
    """
    from recon4.orders.parent import Program, run_with_workers

    stop = context.find_object(StopSignals) or StopSignals()
    program = Program("recon4.orders.child", tuple(_arguments(context)), out.absolute())

    def started(process: Popen[bytes]) -> None:
        stop.request(partial(_pass_on, stop, process))

    with executor:
        code = run_with_workers(program, executor, started=started, log=_say)
    if stop.received is not None:
        stop.is_said()
    elif code < 0:
        raise Recon4Error(CodedText("stage-killed", code=Signals(-code).name))
    return code


def _arguments(context: typer.Context) -> Iterator[str]:
    """The arguments of a command, without those that name workers."""
    assert context.info_name is not None
    yield context.info_name
    behind: list[str] = []
    for parameter in context.command.params:
        value = context.params.get(parameter.name or "")
        if parameter.name in _OF_WORKERS or not value:
            continue
        values = [str(one) for one in (value if isinstance(value, (list, tuple)) else [value])]
        if parameter.param_type_name == "argument":
            behind += values
        else:
            name = parameter.opts[-1]
            yield from [name] if value is True else (word for one in values for word in (name, one))
    yield from ("--", *behind)


def _pass_on(stop: StopSignals, process: Popen[bytes]) -> None:
    assert stop.received is not None
    process.send_signal(stop.received)


def _say(line: str) -> None:
    sys.stderr.write(f"workers: {line}\n")
    sys.stderr.flush()
