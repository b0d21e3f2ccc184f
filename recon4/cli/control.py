"""The command ``recon4 control``: judge control points, and put a map on them."""

from __future__ import annotations

from getpass import getuser
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from recon4.cli.confinement import confine_command
from recon4.cli.targets import targets
from recon4.cli.terminal import worded, write
from recon4.errors import ConfigError
from recon4.locales.coded import CodedText
from recon4.locales.languages import of_terminal

if TYPE_CHECKING:
    from recon4.model.site_control import SiteControl
    from recon4.slices.control_points import ControlPoint
    from recon4.slices.measured_points import MeasuredPosition
    from recon4.slices.site_control import ControlTrial

control = typer.Typer()
control.add_typer(targets)


@control.command("control")
def control_points(
    project: Annotated[Path, typer.Argument(help="Folder that `recon4 process --out` made.")],
    survey: Annotated[
        list[Path] | None,
        typer.Argument(
            help="Surveyed points: id, east, north, height, role (control or check). A second "
            "file may have their covariances: id, sE, sN, sH or id, cEE, cEN, cEH, cNN, cNH, cHH."
        ),
    ] = None,
    *,
    picks: Annotated[
        Path | None,
        typer.Option(
            help="Where they are in the map: id, x, y, z. Default: as picked on the page Slices."
        ),
    ] = None,
    crs: Annotated[
        str, typer.Option(help="EPSG code of the survey. Default: a grid of the site alone.")
    ] = "",
    apply: Annotated[
        bool,
        typer.Option(
            "--apply", help="Put the map on the points; without SURVEY take it off them again."
        ),
    ] = False,
) -> None:
    """Judge control and check points; with --apply put the map into their coordinates.

    Exit code 1 if a blunder of control points is suspected; the map is then not put on them.
    """
    confine_command(write=[project])
    from recon4.slices.site_control import require_agreement, trial_text
    from recon4.slices.stored_picks import add_seen_picks, as_stored

    if not survey:
        _take_off(project, asked=apply and not (picks or crs))
        return
    points, crs = surveyed_points(survey[0], crs)
    if survey[1:]:
        points = _with_covariances(points, survey[1:])
    trial = _try(project, points, picks, crs=crs)
    write(trial_text(trial, of_terminal()))
    if trial.unseen:
        write(worded("control-not-measured", names=", ".join(trial.unseen)))
    require_agreement(trial, of_terminal())
    if apply:
        if picks is None:
            seen = {one.id: one for one in trial.control.targets}
            add_seen_picks(project, seen, as_stored(project).picks)
        _make_again(project, trial.control)


def _take_off(project: Path, *, asked: bool) -> None:
    """Make the map again without the points it was put on."""
    from recon4.model.site_control import SiteControl

    if not asked:
        raise ConfigError(CodedText("control-no-survey"))
    _make_again(project, SiteControl(targets=(), crs=""))


def surveyed_points(survey: Path, crs: str) -> tuple[tuple[ControlPoint, ...], str]:
    """The points of a file, and their system: one is chosen for latitude and longitude."""
    from recon4.recording.tables.coordinates import raise_question
    from recon4.slices.control_points import read_control
    from recon4.slices.tuning_files import CONTROL_FILES
    from recon4.untrusted.bounded import read_bytes_limited

    data = read_bytes_limited(survey, CONTROL_FILES.max_bytes)
    found = read_control(data, name=survey.name, crs=crs)
    raise_question(found.table, survey.name, in_file=True)
    for line in found.skipped:
        write(worded("control-left-out", file=survey.name, row=line))
    if found.crs:
        write(worded("control-into", file=survey.name, crs=found.crs))
    return found.points, found.crs or crs


def _with_covariances(
    points: tuple[ControlPoint, ...], files: list[Path]
) -> tuple[ControlPoint, ...]:
    from recon4.recording.tables.spreads import read_covariances
    from recon4.slices.control_points import with_covariances
    from recon4.slices.tuning_files import CONTROL_FILES
    from recon4.untrusted.bounded import read_bytes_limited

    if len(files) > 1:
        raise ConfigError(CodedText("control-survey-files"))
    data = read_bytes_limited(files[0], CONTROL_FILES.max_bytes)
    return with_covariances(points, read_covariances(data, files[0].name), files[0].name)


def _try(
    project: Path,
    points: tuple[ControlPoint, ...],
    picks: Path | None,
    *,
    crs: str,
) -> ControlTrial:
    from recon4.slices.site_control import try_control
    from recon4.store.project import read_artifacts

    artifacts = read_artifacts(project)
    measured = _picked(picks) if picks else _picked_on_page(project, artifacts)
    return try_control(points, measured, artifacts, crs=crs)


def _picked(picks: Path) -> dict[str, MeasuredPosition]:
    import numpy as np

    from recon4.evaluation.markers import read_markers
    from recon4.slices.measured_points import MeasuredPosition

    found = {}
    for marker in read_markers(picks, partial=True):
        along = np.eye(3)[np.isfinite(marker.xyz_m)]
        if len(along) < 3:
            raise ConfigError(CodedText("control-pick", picks=picks.name, marker=marker.name))
        found[marker.name] = MeasuredPosition(marker.xyz_m, along)
    return found


def _picked_on_page(project: Path, artifacts: dict[str, Path]) -> dict[str, MeasuredPosition]:
    from recon4.slices.stored_picks import stored_picks

    found = stored_picks(project, artifacts)
    if not found:
        raise ConfigError(CodedText("control-no-picks"))
    return found


def _make_again(project: Path, decided: SiteControl) -> None:
    """Note the decision in the journal and make the map again."""
    from recon4.cli.summaries import show_run
    from recon4.cli.terminal import watcher
    from recon4.evaluation.site_control import control_in, outcome_text
    from recon4.pipeline import remake
    from recon4.review.decisions import Decision, DecisionKind
    from recon4.review.journal import append
    from recon4.store.json_files import read_object
    from recon4.store.project import read_artifacts
    from recon4.untrusted.limits import LIMITS

    _ = read_artifacts(project)["level"]  # without one nothing is noted
    append(project, Decision(kind=DecisionKind.CONTROL, who=getuser(), control=decided))
    with watcher() as progress:
        summary = remake(project, progress=progress)
    show_run(summary)
    if decided.targets:
        path = read_artifacts(project)["level"] / "georeference.json"
        outcome = control_in(read_object(path, max_bytes=LIMITS.findings_bytes))
        assert outcome is not None  # it is that of these targets
        write(outcome_text(outcome, of_terminal()))
