"""The commands ``recon4 doctor`` and ``recon4 compile``: this machine."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from recon4.cli.terminal import in_terminal, worded, write, write_json
from recon4.cli.workers import SchedulerOption, TlsOption, certificates_of
from recon4.errors import ConfigError, StoreError

if TYPE_CHECKING:
    from recon4.system.doctor import Check

machine = typer.Typer()


@machine.command()
def doctor(
    folder: Annotated[Path, typer.Argument(help="Where projects are kept.")] = Path(),
    as_json: Annotated[bool, typer.Option("--json", help="Write JSON for programs.")] = False,
    *,
    scheduler: SchedulerOption = "",
    tls: TlsOption = None,
) -> None:
    """Look at versions, cores, memory, disk and threads of this machine, and at a cluster's."""
    from recon4.system.doctor import examine

    checks = examine(folder)
    if scheduler:
        checks += [_examine_cluster(scheduler, tls, folder)]
    checks += _examine_chosen(folder)
    if as_json:
        write_json(checks)
    else:
        for check in checks:
            mark = worded("doctor-ok" if check.ok else "doctor-no")
            what = worded("doctor-check", check=check.what)
            found = worded("doctor-found", found=check.found)
            write(f"{mark:<3} {what:<20} {found:<18} {in_terminal(check.advice)}".rstrip())
    if not all(check.ok for check in checks):
        raise typer.Exit(1)


@machine.command("compile")
def compile_command() -> None:
    """Compile the kernels, once after an installation; other commands do it when they need to."""
    from recon4.cli.terminal import watcher
    from recon4.system.compile_kernels import compile_kernels

    with watcher() as progress:
        new = compile_kernels(progress)
    write("compiled" if new else "compiled already")


def _examine_cluster(scheduler: str, tls: Path | None, shared: Path) -> Check:
    """Whether the workers of a scheduler have this version and see a folder of this computer."""
    from recon4.executors.cluster import workers_of
    from recon4.system.doctor import Check

    cluster = workers_of(scheduler, certificates_of(tls), shared.absolute())
    try:
        with cluster:
            return Check("cluster", f"{cluster.size} workers", ok=True)
    except ConfigError as error:
        return Check("cluster", scheduler, ok=False, advice=str(error))


def _examine_chosen(root: Path) -> list[Check]:
    """The workers that the administrator of a server chose for its jobs, if it is one's folder."""
    from recon4.executors.chosen import chosen_cluster, read_choice
    from recon4.review.trusted_keys import STATE
    from recon4.system.doctor import Check

    state, what = root.absolute() / STATE, "workers of jobs"
    if not state.is_dir():
        return []
    try:
        chosen = read_choice(state)
        if not chosen.used:
            return [Check(what, "threads", ok=True)]
        cluster = chosen_cluster(state, chosen, root.absolute())
        if chosen.count:
            return [Check(what, f"{chosen.count} here", ok=True)]
        with cluster:
            dashboard = f"dashboard: {cluster.dashboard}" if cluster.dashboard else ""
            return [Check(what, f"{cluster.size} workers", ok=True, advice=dashboard)]
    except (ConfigError, StoreError) as error:
        return [Check(what, "cannot be used", ok=False, advice=str(error))]
