"""The command ``recon4 targets``: survey targets found in a whole map."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from recon4.cli.confinement import confine_command
from recon4.cli.terminal import worded, write
from recon4.locales.languages import of_terminal
from recon4.locales.numbers import localized

if TYPE_CHECKING:
    from collections.abc import Sequence

    from recon4.slices.control_points import ControlPoint
    from recon4.slices.targets.named import TargetList

targets = typer.Typer()


@targets.command("targets")
def find_survey_targets(
    project: Annotated[Path, typer.Argument(help="Folder that `recon4 process --out` made.")],
    survey: Annotated[
        Path | None,
        typer.Argument(
            help="Surveyed points, by which targets are named: id, east, north, height."
        ),
    ] = None,
    *,
    picks: Annotated[
        Path | None,
        typer.Option(help="New file for `recon4 control --picks`: id, x, y, z of those named."),
    ] = None,
    crs: Annotated[
        str, typer.Option(help="EPSG code of the survey. Default: a grid of the site alone.")
    ] = "",
) -> None:
    """Find retro-reflective plates, black-white boards and spheres in a map, and name them.

    They are proposals: look at them before they place a map. Exit code 1 if a name is ambiguous.
    """
    confine_command(write=[picks.parent] if picks else [])
    from recon4.slices.targets.named import named

    points: Sequence[ControlPoint] = ()
    if survey is not None:
        from recon4.cli.control import surveyed_points

        points, crs = surveyed_points(survey, crs)
    found = named(_found(project, [one.radius_m for one in points]), points, crs=crs)
    for line in _lines(found, bool(points)):
        write(line)
    if picks is not None:
        rows = [",".join([row.id, *map(str, row.p_map)]) for row in found.rows if row.id]
        picks.write_text("\n".join(["id,x_m,y_m,z_m", *rows, ""]), encoding="utf-8")
    if any(row.ambiguous for row in found.rows):
        raise typer.Exit(1)


def _found(project: Path, radii_m: list[float]) -> TargetList:
    from recon4.cli.terminal import watcher
    from recon4.mapping.tiles import TileSet
    from recon4.slices.targets.named import listed
    from recon4.slices.targets.search import find_targets
    from recon4.store.project import read_artifacts

    tiles = TileSet.open(read_artifacts(project)["map"])
    with watcher() as progress:
        return listed(find_targets(tiles, radii_m=radii_m, progress=progress))


def _lines(found: TargetList, asked: bool) -> list[str]:
    """A table of the targets, and what is open."""
    lines = [worded("listed-targets-head")]
    for row in found.rows:
        x, y, z = row.p_map
        kind = worded("named-target", kind=row.kind)
        off = "" if row.off_m is None else f"{1e3 * row.off_m:.1f}"
        figures = f"{x:10.3f} {y:10.3f} {z:10.3f} {1e3 * row.sd_m:7.1f} {off:>7}"
        doubt = f"  {worded('listed-targets-open')}" if row.ambiguous else ""
        figures = localized(f"{figures} {row.agreement:10.2f}", of_terminal())
        lines.append(f"{row.id or '-':<10} {kind:<7} {figures}{doubt}")
    if found.rows:
        lines.append(worded("listed-targets-sigma"))
    if asked and found.rmse_m is None:
        lines.append(worded("listed-targets-no-three"))
    elif found.rmse_m is not None:
        count = sum(bool(row.id) for row in found.rows)
        lines.append(worded("listed-targets-named", count=count, off_mm=1e3 * found.rmse_m))
    if found.missing:
        lines.append(worded("listed-targets-missing", points=", ".join(found.missing)))
    doubtful = [row.id for row in found.rows if row.ambiguous]
    if doubtful:
        lines.append(worded("listed-targets-ambiguous", points=", ".join(doubtful)))
    return lines
