"""The command ``recon4 evaluate``."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from recon4.cli.confinement import confine_command
from recon4.cli.tables import parse_choice
from recon4.cli.terminal import write, write_json
from recon4.errors import ConfigError
from recon4.locales.coded import CodedText
from recon4.locales.languages import of_terminal

if TYPE_CHECKING:
    from recon4.evaluation.density import Density
    from recon4.evaluation.evaluate import Evaluation
    from recon4.evaluation.relations import RelationErrors
    from recon4.recording.tables.coordinates import ColumnChoice
    from recon4.slices.residuals import ControlReport

evaluation = typer.Typer()
RELATIONS_SUFFIX = ".relations"

ResultArgument = Annotated[Path, typer.Argument(help="Project folder, .tum or .npz trajectory.")]
TruthOption = Annotated[
    Path | None,
    typer.Option(help="True trajectory, .tum or .npz, or reference relations, .relations."),
]
ModelOption = Annotated[Path | None, typer.Option(help="True model, .ply; gives e_r.")]
FloorOption = Annotated[
    bool, typer.Option("--floor", help="Also e_r of the same points with the true poses.")
]
MarkersOption = Annotated[
    tuple[Path, Path] | None,
    typer.Option(
        metavar="SURVEYED MEASURED",
        help="Two CSV files (name, x_m, y_m, z_m, role): surveyed and measured in the map. "
        "A coordinate that was not measured is empty or -.",
    ),
]
LimitsOption = Annotated[
    str,
    typer.Option(
        metavar="MEAN_H,MEAN_V,MAX_H,MAX_V,DISTANCE",
        help="Limits of --markers in cm: mean and largest, horizontal and height, and of "
        "distances; - = not required. Usual: 14,12,28,24,5.",
    ),
]
ColumnsOption = Annotated[
    str,
    typer.Option(
        metavar="id,x,y,z",
        help="Columns of the tables of --markers from the left, if their names do not tell: "
        "id, x (east), y (north), z (height), -x, -y, role, or - (not used).",
    ),
]
UnitOption = Annotated[
    str, typer.Option(help="Unit of --model and of --markers: m, dm, cm, mm, km, ft, us-ft or in.")
]
PatchOption = Annotated[
    str,
    typer.Option(
        metavar="X,Y,Z,X,Y,Z,X,Y,Z",
        help="A corner and its two neighbors in meters: density on this patch of the map.",
    ),
]
ReportOption = Annotated[
    Path | None,
    typer.Option(help="Also write the report of the project, .html, with these figures."),
]
JsonOption = Annotated[bool, typer.Option("--json", help="Write JSON for programs.")]


@evaluation.command()
def evaluate(  # noqa: PLR0913 - options of a command
    result: ResultArgument,
    *,
    truth: TruthOption = None,
    model: ModelOption = None,
    floor: FloorOption = False,
    markers: MarkersOption = None,
    columns: ColumnsOption = "",
    unit: UnitOption = "",
    limits: LimitsOption = "",
    patch: PatchOption = "",
    report: ReportOption = None,
    as_json: JsonOption = False,
) -> None:
    """Evaluate a result: ATE, KITTI drift, relations, e_r in slices, density, survey markers."""
    confine_command(write=[report.parent] if report else [])
    from recon4.api import evaluate as evaluate_result
    from recon4.evaluation.text import density_text, relations_text

    if truth is None and markers is None and not patch:
        raise typer.BadParameter(CodedText("evaluate-needs"))
    if report is not None and truth is None:
        raise typer.BadParameter(CodedText("evaluate-report"))
    record: dict[str, object] = {}
    texts: list[str] = []
    if truth is not None and truth.suffix == RELATIONS_SUFFIX:
        compared = _relation_errors(result, truth)
        record["relations"] = compared
        texts.append(relations_text(compared, of_terminal()))
    elif truth is not None:
        found = evaluate_result(result, truth, model=model, unit=unit, true_poses=floor)
        record, texts = found.to_json(), [found.table(of_terminal())]
        if report is not None:
            _write_report(result, found, report)
    if markers is not None:
        from recon4.slices.residual_table import residual_text

        table = _marker_table(*markers, choice=parse_choice(columns, unit), limits=limits)
        record["markers"] = table
        texts.append(residual_text(table, of_terminal()))
    if patch:
        density = _patch_density(result, patch)
        record["patch"] = density
        texts.append(density_text(density, of_terminal()))
    if as_json:
        write_json(record)
    else:
        write("\n\n".join(texts))


def _relation_errors(result: Path, relations: Path) -> RelationErrors:
    from recon4.evaluation.relations import read_relations, relation_errors
    from recon4.evaluation.trajectories import trajectory_with_hints

    walk, hints = trajectory_with_hints(result)
    return replace(relation_errors(walk, read_relations(relations)), hints=hints)


def _write_report(project: Path, found: Evaluation, path: Path) -> None:
    from recon4.report.assessment import assess
    from recon4.report.html import render
    from recon4.report.known_texts import known_texts
    from recon4.report.project import project_facts
    from recon4.report.translation import in_language
    from recon4.store.atomic import write_text

    language = of_terminal()
    page = render(assess(project_facts(project, found)))
    write_text(path, in_language(page, language, known_texts(project, language)))


def _marker_table(
    surveyed: Path, measured: Path, *, choice: ColumnChoice, limits: str
) -> ControlReport:
    import numpy as np

    from recon4.evaluation.markers import read_markers
    from recon4.slices.control_limits import parse_limits
    from recon4.slices.control_points import ControlPoint
    from recon4.slices.measured_points import MeasuredPosition
    from recon4.slices.residuals import ControlContext, residuals

    points = [
        ControlPoint(m.name, tuple(m.xyz_m.tolist()), m.role)
        for m in read_markers(surveyed, choice=choice)
    ]
    positions = {
        m.name: MeasuredPosition(np.nan_to_num(m.xyz_m), np.eye(3)[np.isfinite(m.xyz_m)])
        for m in read_markers(measured, partial=True, choice=choice)
    }
    context = ControlContext(limits=parse_limits(limits), language=of_terminal())
    return residuals(points, positions, context)


def _patch_density(project: Path, text: str) -> Density:
    import numpy as np

    from recon4.evaluation.density import PlanePatch, patch_density
    from recon4.mapping.tiles import TileSet
    from recon4.store.project import read_artifacts

    try:
        corner, u, v = np.array([float(part) for part in text.split(",")]).reshape(3, 3)
    except ValueError as error:
        raise ConfigError(CodedText("evaluate-patch-numbers", text=text)) from error
    artifacts = read_artifacts(project)
    if "map" not in artifacts:
        raise ConfigError(CodedText("evaluate-patch-project", project=str(project)))
    points = (tile.xyz_m() for tile in TileSet.open(artifacts["map"]))
    return patch_density(points, PlanePatch(corner, u - corner, v - corner))
