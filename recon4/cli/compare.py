"""The command ``recon4 compare``: two maps, or a map and the one before the last decision."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from recon4.cli.confinement import confine_command
from recon4.cli.terminal import in_terminal, write
from recon4.errors import ConfigError
from recon4.locales.coded import CodedText

if TYPE_CHECKING:
    from recon4.comparison.common_frame import MapSide

comparison = typer.Typer()


@comparison.command("compare")
def compare(
    project: Annotated[Path, typer.Argument(help="Folder that `recon4 process --out` made.")],
    other: Annotated[
        Path | None,
        typer.Argument(
            help="Another project, or the folder of an earlier map in `artifacts`. Default: the "
            "map before the last one of this project."
        ),
    ] = None,
    *,
    out: Annotated[
        Path | None,
        typer.Option(help="Also write the core points, .laz or .csv, or the figures, .json."),
    ] = None,
    align: Annotated[
        bool, typer.Option("--align", help="Lay the other map on this one by ICP before.")
    ] = False,
    core_spacing: Annotated[float, typer.Option(help="Distance of core points in m.")] = 0.1,
) -> None:
    """Say where two maps differ: M3C2 distances and whether they are beyond the noise (95 %).

    Maps of different recordings need a common CRS or --align. Core points that have no surface
    beside them in the other map are counted.
    """
    confine_command(write=[out.parent] if out else [])
    from recon4.cli.terminal import watcher
    from recon4.comparison.common_frame import open_side
    from recon4.comparison.run import MapPair, compare_maps
    from recon4.comparison.text import differences_lines
    from recon4.comparison.write import exhaust, sink_of, write_summary

    first = open_side(project)
    second = _before(project) if other is None else open_side(other)
    sink = sink_of(out, first.frame, first.tiles.bounds_m[0]) if out else exhaust
    with watcher() as progress:
        pair = MapPair.of(first, second, align=align)
        found = compare_maps(pair, sink, scales=pair.scales(core_spacing), progress=progress)
    if out and out.suffix.lower() == ".json":
        write_summary(found, out)
    write("\n".join(map(in_terminal, differences_lines(found))))


def _before(project: Path) -> MapSide:
    from recon4.comparison.common_frame import earlier_maps, open_side

    earlier = earlier_maps(project)
    if not earlier:
        raise ConfigError(CodedText("compare-no-earlier", project=str(project)))
    return open_side(earlier[0])
