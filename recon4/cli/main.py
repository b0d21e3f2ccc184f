"""The command line: ``recon4 COMMAND --help``.

Exit codes: 0 done, 1 a known error (reported in one line), 2 wrong usage, 128 + n broken off by
signal n (130 Ctrl-C, 143 SIGTERM). A signal is how a server and a recording are ended: 0.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

import recon4
from recon4.cli.backup import backups
from recon4.cli.batch import batches
from recon4.cli.calibration import assignments_of, calibration
from recon4.cli.classify import classify
from recon4.cli.compare import comparison
from recon4.cli.confinement import compile_first, confine_command, result_folder
from recon4.cli.control import control
from recon4.cli.delivery import delivery, is_delivery, show_checked
from recon4.cli.evaluation import evaluation
from recon4.cli.exports import exports
from recon4.cli.findings import findings
from recon4.cli.kernel_cache import settle_kernel_cache
from recon4.cli.live import live
from recon4.cli.machine import machine
from recon4.cli.overview import CommandGroup
from recon4.cli.products import products
from recon4.cli.simulation import simulation
from recon4.cli.slices import slices
from recon4.cli.spoken import speak, wrong_usage
from recon4.cli.storage import space
from recon4.cli.terminal import complaint_of, in_terminal, say, write, write_json
from recon4.cli.workers import (
    SchedulerOption,
    TlsOption,
    WorkersOption,
    chosen_workers,
    run_confined,
)
from recon4.errors import Cancelled, Recon4Error
from recon4.locales.languages import ENVIRONMENT, LANGUAGE_HELP, checked, of_terminal
from recon4.system.stopping import StopSignals
from recon4_app.cli.keys import keys
from recon4_app.cli.mcp import assistant
from recon4_app.cli.serve import server
from recon4_app.cli.users import users

if TYPE_CHECKING:
    from recon4.settings import Settings

app = typer.Typer(
    name="recon4",
    cls=CommandGroup,
    help="From the recording of a LiDAR backpack to a verified, leveled, georeferenced map.",
    invoke_without_command=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)

app.add_typer(users, name="users")
app.add_typer(keys, name="keys")
for _part in (server, assistant, live, simulation, slices, backups, space, comparison):
    app.add_typer(_part)
for _part in (
    calibration,
    classify,
    control,
    evaluation,
    exports,
    delivery,
    findings,
    batches,
    machine,
    products,
):
    app.add_typer(_part)

_INTERRUPTED = 130
"""What shells report for a program that Ctrl-C ended."""
_RESUMABLE = {"process", "demo", "batch"}
"""Commands that keep finished stages."""

PresetOption = Annotated[
    str,
    typer.Option("--preset", help="Start from: indoor, outdoor, hector, thesis, wuerzburg."),
]
SetOption = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="GROUP.NAME=VALUE", help="Change one setting; repeatable."),
]
FieldsOption = Annotated[
    str, typer.Option(metavar="ROLE=COLUMN,…", help="Columns of points: x=px:mm,…,time=t:us.")
]
CalibrateOption = Annotated[
    str,
    typer.Option(
        metavar="auto|beams|off|SENSORS",
        help="auto: calibrate a rig file that contradicts the recording; beams: single beams as "
        "well; off: do not compare them; SENSORS: calibrate these only, as vertical,imu,gnss. "
        "Default: compare and warn.",
    ),
]
JsonOption = Annotated[bool, typer.Option("--json", help="Write JSON for programs.")]


@app.command()
def info(
    recording: Annotated[
        Path, typer.Argument(help="pcap, bag, folder of clouds, CARMEN log or table.")
    ],
    as_json: JsonOption = False,
    rig_out: Annotated[
        Path | None, typer.Option(help="Write a first rig file of its sensors, .toml.")
    ] = None,
    *,
    fields: FieldsOption = "",
) -> None:
    """Say what a recording holds, what will be derived and what is missing."""
    language = of_terminal()  # confinement leaves no environment
    confine_command(write=[rig_out.parent] if rig_out else [])
    from recon4.recording.info.describe import describe
    from recon4.recording.recipes.given_rig import recipe_given

    found = describe(recording, fields=recipe_given(fields))
    if rig_out:
        from recon4.recording.rigs.first import write_first_rig

        write_first_rig(found.first_rig, rig_out)
    if as_json:
        write_json(found.to_json(language))
    else:
        write("\n".join(found.lines(language)))


@app.command()
def process(  # noqa: PLR0913 - an argument for each option
    context: typer.Context,
    recordings: Annotated[
        list[Path],
        typer.Argument(help="pcap, bag, folder of clouds, CARMEN log, tables of line scans."),
    ],
    *,
    out: Annotated[Path, typer.Option(help="Project folder; the results end up in it.")],
    rig: Annotated[str, typer.Option(help="Rig preset or .toml; default: worked out.")] = "",
    imu: Annotated[Path | None, typer.Option(help="IMU samples as CSV.")] = None,
    gnss: Annotated[Path | None, typer.Option(help="GNSS: CSV, .pos, SBET, UBX, NMEA.")] = None,
    fields: FieldsOption = "",
    preset: PresetOption = "indoor",
    calibrate: CalibrateOption = "",
    assignments: SetOption = None,
    verbose: Annotated[
        bool, typer.Option("-v", "--verbose", help="Show what the odometry tried to assume.")
    ] = False,
    workers: WorkersOption = 0,
    scheduler: SchedulerOption = "",
    tls: TlsOption = None,
    as_json: JsonOption = False,
) -> None:
    """Make a map of a recording; started again, it continues where it stopped."""
    from recon4.recording.sources import Sources, require_files

    chosen = _settings(preset, [*assignments_of(calibrate), *(assignments or [])])
    require_files([*recordings, *(path for path in (imu, gnss) if path)])
    compile_first()
    folder = result_folder(out)
    if executor := chosen_workers(workers, scheduler, tls=tls, out=folder):
        raise typer.Exit(run_confined(context, folder, executor))
    confine_command(write=[folder])

    from recon4.cli.summaries import show_run
    from recon4.cli.terminal import watcher
    from recon4.model.events import Warned
    from recon4.pipeline import process as run
    from recon4.recording.info.nearby_samples import unread_samples
    from recon4.recording.kinds import located_elsewhere
    from recon4.recording.recipes.given_rig import rig_given

    with watcher() as progress:
        sources = Sources(tuple(recordings), rig_given(recordings, rig, fields), imu, gnss)
        for text in (*unread_samples(sources), *located_elsewhere(sources)):
            progress.event(Warned(text=text))
        summary = run(sources, out, settings=chosen, preset=preset, progress=progress)
    show_run(summary, project=out if verbose else None, as_json=as_json)


@app.command()
def settings(
    preset: PresetOption = "indoor",
    assignments: SetOption = None,
    as_json: JsonOption = False,
    *,
    markdown: Annotated[
        bool, typer.Option("--markdown", help="The page settings of the docs.")
    ] = False,
) -> None:
    """Show every setting in force, with its meaning."""
    from recon4.settings import to_json
    from recon4.settings.help import markdown as settings_page

    chosen = _settings(preset, assignments)
    if markdown:
        write(settings_page(), end="")
    elif as_json:
        write_json(to_json(chosen))
    else:
        _show_settings(chosen)


@app.command()
def verify(
    folder: Annotated[Path, typer.Argument(help="A project, server's folder, delivery or PDF.")],
    *,
    accept: Annotated[
        bool, typer.Option("--accept", help="Seal the files as they are now; approvals stay.")
    ] = False,
    as_json: JsonOption = False,
) -> None:
    """Read every byte again; compare hashes, seals, the journal's chain and signatures."""
    from recon4.archive.verify import accept as seal_again
    from recon4.archive.verify import verify as read_again
    from recon4.cli.terminal import watcher

    if is_delivery(folder):
        return show_checked(folder, as_json=as_json, accept=accept)
    if accept and (state := seal_again(folder)):
        _note_accepted(state, folder)
    confine_command(write=[folder])  # SQLite makes files beside what it reads
    with watcher() as progress:
        found = read_again(folder, progress)
    if as_json:
        write_json(found)
    else:
        for name in found.unknown:
            say("verify-unknown", name=name)
        for what in found.notes:
            say("verify-note", what=what)
        for what in found.damaged:
            say("verify-damaged", what=what)
        for what in found.untrusted:
            say("verify-untrusted", what=what)
        for what in found.approvals:
            write(in_terminal(what))
        say(
            "verify-counts",
            checked=found.checked,
            damaged=len(found.damaged),
            untrusted=len(found.untrusted),
        )
    if found.damaged or found.untrusted:
        raise typer.Exit(1)


def _note_accepted(state: Path, project: Path) -> None:
    """Enter in the server's audit log that its record of the newest approval gave way."""
    from recon4_app.cli.users import access_of, note

    with access_of(state.parent) as access:
        note(access, "accept project as it is", project.resolve().name)


def _version(wanted: bool) -> None:
    if wanted:
        write(f"recon4 {recon4.__version__}")
        raise typer.Exit


def _speak(context: typer.Context, language: str) -> None:
    if language:
        os.environ[ENVIRONMENT] = checked(language)
        speak(context, language)


@app.callback()
def _every_command(
    context: typer.Context,
    version: Annotated[
        bool,
        typer.Option("--version", callback=_version, is_eager=True, help="Show the version."),
    ] = False,
    language: Annotated[str, typer.Option(callback=_speak, is_eager=True, help=LANGUAGE_HELP)] = "",
) -> None:
    if context.invoked_subcommand is None:
        write(context.get_help())
        raise typer.Exit(2)
    if context.invoked_subcommand != "doctor":  # it reports what is wrong
        settle_kernel_cache()
    _sweep()


def _sweep() -> None:
    """Remove temporary copies that killed commands left behind."""
    from recon4.recording.formats.scratch import sweep_scratch

    # A folder that is not ours is a matter of the command that needs it.
    with suppress(Recon4Error, OSError):
        sweep_scratch()


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command and say how it ended.

    Args:
        arguments: Those behind ``recon4``; None = those of this process.

    Returns:
        The exit code.
    """
    with StopSignals() as stop:
        return run(list(sys.argv[1:] if arguments is None else arguments), stop)


def run(arguments: list[str], stop: StopSignals) -> int:
    """Run one command while signals are caught.

    Args:
        arguments: Those behind ``recon4``.
        stop: Open.

    Returns:
        The exit code.
    """
    for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
        # Small matrices: more threads only get in each other's way.
        os.environ.setdefault(name, "1")
    try:
        code, complaint = _run(arguments, stop)
    except BaseException:
        if not stop.broke_off:
            raise
    if stop.broke_off:  # whatever else was raised comes from that
        stop.say("; the same command goes on after the last finished stage" * _resumes(arguments))
        return stop.exit_code
    if complaint:
        _complain(complaint)
    stop.say()
    return code


def _run(arguments: list[str], stop: StopSignals) -> tuple[int, str]:
    """Exit code and what to complain of; `stop` is the ``obj`` of the commands' contexts."""
    try:
        code = app(args=arguments, prog_name="recon4", standalone_mode=False, obj=stop)
        return int(code or 0), ""
    except typer.Abort:
        return _INTERRUPTED, ""
    except Cancelled as stop:
        return _INTERRUPTED, str(stop)
    except Recon4Error as error:
        return 1, complaint_of(error)
    except MemoryError as error:
        return 1, f"not enough memory: a command may use 70 % of this computer's ({error})"
    except typer.TyperException as error:
        return 2, wrong_usage(error, of_terminal())


def _resumes(arguments: list[str]) -> bool:
    return bool(arguments) and arguments[0] in _RESUMABLE


def _settings(preset_name: str, assignments: list[str] | None) -> Settings:
    from recon4.settings import override, preset

    try:
        return override(preset(preset_name), assignments or [])
    except Recon4Error as error:
        raise typer.BadParameter(complaint_of(error)) from error


def _show_settings(chosen: Settings) -> None:
    from recon4.settings.help import describe_settings, differences

    changed = differences(chosen)
    for group in describe_settings():
        write(f"\n{group.name}: {group.text}")
        for setting in group.settings:
            value = getattr(getattr(chosen, group.name), setting.name)
            mark = "*" if setting.path in changed else " "
            write(f" {mark} {setting.path:<36} {value!s:<14} {setting.text}".rstrip())


def _complain(text: str) -> None:
    sys.stderr.write(f"recon4: {text}\n")
