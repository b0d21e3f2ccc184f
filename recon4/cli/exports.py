"""The commands ``recon4 export`` (the map of a project, its poses or findings, as files) and
``recon4 convert`` (a recording in the format of another program).
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from recon4.cli.confinement import confine_command
from recon4.cli.slices import numbers
from recon4.cli.terminal import say, say_approval
from recon4.export.options import Box, ClipBox, ExportOptions, classes_named, option_text
from recon4.locales.coded import CodedText

exports = typer.Typer()

DraftOption = Annotated[
    bool, typer.Option("--draft", help="Write it without approval, whether or not there is one.")
]


@exports.command()
def export(  # noqa: PLR0913 - options of a command
    project: Annotated[Path, typer.Argument(help="Folder that `recon4 process --out` made.")],
    file: Annotated[
        Path,
        typer.Argument(
            help="File to write; the suffix selects the format: .laz, .copc.laz (COPC), "
            ".e57, .ptx (scans with poses), .ply, .pcd, .xyz; .txt = KITTI poses; .3dtk = folder "
            "of scans with poses for 3DTK; .csv, .geojson = the findings; .gpkg = trajectory, "
            "points, findings, notes, double walls."
        ),
    ],
    *,
    crs: Annotated[str, typer.Option(help=option_text("crs"))] = "",
    classes: Annotated[
        str, typer.Option(help=f"{option_text('classes')} As ground,building or 2,6.")
    ] = "",
    box: Annotated[str, typer.Option(help=option_text("box_m"))] = "",
    clip: Annotated[
        list[str] | None,
        typer.Option(metavar="X,Y,Z,DX,DY,DZ,DEG", help=option_text("clip")),
    ] = None,
    storey: Annotated[str, typer.Option(help=option_text("storey"))] = "",
    thin: Annotated[float, typer.Option(help=option_text("thin_m"))] = 0.0,
    raw: Annotated[bool, typer.Option("--raw", help=option_text("raw"))] = False,
    all_points: Annotated[
        bool, typer.Option("--all-points", help=option_text("all_points"))
    ] = False,
    draft: DraftOption = False,
) -> None:
    """Write the map of a project, in any CRS when it is georeferenced, its poses or findings.

    Says whether the map is approved. An approval that cannot be trusted is refused. Every file of
    points is read again and compared with what was meant.
    """
    confine_command(write=[file.parent])
    wanted = ExportOptions(
        crs=crs,
        raw=raw,
        all_points=all_points,
        classes=classes_named(classes),
        box_m=_box(box),
        clip=tuple(map(_clip_box, clip or [])),
        storey=storey,
        thin_m=thin,
        draft=draft,
    )
    _write_export(project, file, wanted)


@exports.command()
def convert(
    recordings: Annotated[
        list[Path], typer.Argument(help="A recording of LiDARs: pcap, bag, LVX.")
    ],
    *,
    out: Annotated[Path, typer.Option(help="Folder to make: lidar*.laz, imu*.csv, as MANDEYE.")],
    rig: Annotated[str, typer.Option(help="Rig preset or .toml; default: worked out.")] = "",
    imu: Annotated[Path | None, typer.Option(help="IMU samples as CSV.")] = None,
) -> None:
    """Write the points and IMU samples of a recording as a walk of MANDEYE, for HDMapping."""
    confine_command(write=[out.parent])
    from recon4.cli.terminal import watcher
    from recon4.recording.mandeye.convert import convert as run
    from recon4.recording.sources import Sources

    sources = Sources.of(*recordings, rig=rig or None, imu=imu)
    with watcher() as progress:
        made = run(sources, out, progress=progress)
    say("written-mandeye", points=made.points, samples=made.samples, folder=str(out))
    for text in made.lost:
        say("written-lost", what=text)


def _box(text: str) -> Box | None:
    """Six numbers with commas between them; None = no box."""
    if not text:
        return None
    x1, y1, z1, x2, y2, z2 = numbers(text, 6)
    return x1, y1, z1, x2, y2, z2


def _clip_box(text: str) -> ClipBox:
    """Seven numbers with commas between them."""
    x, y, z, dx, dy, dz, deg = numbers(text, 7)
    return x, y, z, dx, dy, dz, deg


def _write_export(project: Path, file: Path, wanted: ExportOptions) -> None:
    from recon4.cli.terminal import watcher
    from recon4.delivery.exports import write_layers_file
    from recon4.export.findings import ENDINGS
    from recon4.export.map_files import export_map
    from recon4.export.scan_files import export_3dtk

    ending = file.suffix.lower()
    if ending in (".txt", ".3dtk", *ENDINGS) and set(wanted.changed) - {"draft"}:
        raise typer.BadParameter(CodedText("export-as-is", ending=ending))
    if ending == ".gpkg" and set(wanted.changed) - {"draft", "crs"}:
        raise typer.BadParameter(CodedText("export-gpkg"))
    if ending in (".txt", *ENDINGS):
        _export_text(project, file, draft=wanted.draft)
        return
    with watcher() as progress:
        if ending == ".gpkg":
            made_of = write_layers_file(project, file, wanted, progress=progress)
            say("written", file=str(file), what=made_of)
            _write_approval(project, draft=wanted.draft)
            return
        if ending == ".3dtk":
            points = export_3dtk(project, file, progress=progress, draft=wanted.draft)
            say("written", file=str(file), what=CodedText("points-all", points=points))
            _write_approval(project, draft=wanted.draft)
            return
        made = export_map(project, file, wanted, progress=progress)
    say("written", file=str(file), what=made.text)
    say_approval(made.approval)


def _write_approval(project: Path, *, draft: bool) -> None:
    from recon4.review.approval_state import latest_state

    say_approval(latest_state(project, draft=draft))


def _export_text(project: Path, file: Path, *, draft: bool) -> None:
    from recon4.export.findings import export_findings
    from recon4.export.map_files import export_poses

    if file.suffix.lower() == ".txt":
        what = CodedText("poses-all", poses=export_poses(project, file, draft=draft))
    else:
        what = CodedText("findings-all", findings=export_findings(project, file))
    say("written", file=str(file), what=what)
    _write_approval(project, draft=draft)
