"""The command ``recon4 calibrate``."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from recon4.cli.confinement import compile_first, confine_command, result_folder
from recon4.cli.terminal import say, write
from recon4.errors import CalibrationError, ConfigError
from recon4.locales.coded import CodedText, said
from recon4.locales.languages import of_terminal

if TYPE_CHECKING:
    from recon4.workflows.calibration_methods import MethodResult

calibration = typer.Typer()


@calibration.command()
def calibrate(  # noqa: PLR0913 - an argument for each option
    recordings: Annotated[
        list[Path],
        typer.Argument(help="pcap, bag or folder of clouds; pairs: CSV; trajectories: 2 TUM."),
    ],
    *,
    rig: Annotated[str, typer.Option(help="Rig preset or .toml to begin with.")],
    out: Annotated[Path, typer.Option(help="Calibrated rig to write, .toml.")],
    imu: Annotated[Path | None, typer.Option(help="IMU samples as CSV.")] = None,
    gnss: Annotated[Path | None, typer.Option(help="GNSS: CSV, .pos, SBET, UBX, NMEA.")] = None,
    method: Annotated[
        str,
        typer.Option(help="joint, maps, gravity, entropy, pairs, trajectories; page calibration."),
    ] = "joint",
    sensors: Annotated[
        str,
        typer.Option(help="Only these, as vertical,imu,gnss; pairs: one; trajectories: both."),
    ] = "",
    beams: Annotated[
        bool, typer.Option("--beams", help="Also range, elevation and azimuth of single beams.")
    ] = False,
    project: Annotated[
        Path | None, typer.Option(help="Folder for multiframes and odometry; default: OUT.project.")
    ] = None,
) -> None:
    """Calibrate the mounts and clocks of a rig from a walk; the rig file stays as it is."""
    if out.suffix != ".toml":
        raise ConfigError(CodedText("out-toml", out=out.name))
    folder = project or out.with_suffix(".project")
    compile_first()
    confine_command(write=[result_folder(folder), out.parent])

    from recon4.cli.terminal import watcher
    from recon4.recording.sources import Sources, require_files
    from recon4.report.calibration_page import write_calibration_page
    from recon4.workflows import calibration_methods as methods

    choice = methods.CalibrationChoice(method, sensors, beams)
    methods.check_choice(choice)
    require_files([*recordings, *(path for path in (imu, gnss) if path)])
    sources = Sources.of(*recordings, rig=rig, imu=imu, gnss=gnss)
    with watcher() as progress:
        found = methods.calibrate_by(choice, sources, folder, progress=progress)
    write("\n".join(_lines(found, of_terminal())))
    page = out.with_suffix(".html")
    report = methods.calibration_report(method, found, sources, folder=folder)
    write_calibration_page(page, report, of_terminal())
    say("calibrated-page", page=str(page))
    _write(found, out)


def _lines(found: MethodResult, language: str) -> Iterator[str]:
    from recon4.findings.witnesses.rig import rig_findings
    from recon4.findings.wording import whole_text
    from recon4.report.client_words import words
    from recon4.report.rig import row_cells

    for row in found.rows:
        name, change, status = row_cells(row, words(language))
        yield f"{name:<28} {change:>22}  {status}".rstrip()
    yield from (said(line, language) for line in found.report_lines)
    if found.figures is not None:
        yield from (whole_text(one, language) for one in rig_findings(found.figures))


def _write(found: MethodResult, out: Path) -> None:
    from recon4.cli.terminal import in_terminal
    from recon4.model.rig import format_rig
    from recon4.store.atomic import atomic_file

    if found.rig is None:
        raise CalibrationError(CodedText("out-not-written", out=out.name, outcome=found.outcome))
    with atomic_file(out) as temporary:
        temporary.write_text(format_rig(found.rig), "utf-8")
    write(f"{in_terminal(found.outcome)}\n{out}")


def assignments_of(word: str) -> list[str]:
    """Assignments of the option ``--calibrate``."""
    if not word:
        return []
    if word in ("auto", "off"):
        return [f"calibration.mode={word}"]
    if word == "beams":
        return ["calibration.mode=auto", "calibration.beams=true"]
    return ["calibration.mode=auto", f"calibration.sensors={word}"]
