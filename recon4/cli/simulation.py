"""The command ``recon4 simulate``."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from recon4.cli.terminal import write
from recon4.locales.coded import CodedText

if TYPE_CHECKING:
    from recon4.model.rig import Rig

simulation = typer.Typer()


@simulation.command()
def simulate(  # noqa: PLR0913 - options of a command
    world: Annotated[str, typer.Argument(help="As office or corridor:7; docs: page simulation.")],
    out: Annotated[Path, typer.Argument(help="New folder for the recording and its truth.")],
    *,
    seconds: Annotated[
        float | None,
        typer.Option(help="Length of the walk in seconds; default: 60, or that of the figure."),
    ] = None,
    seed: Annotated[int, typer.Option(help="Draws the walk and the noise.")] = 1,
    rig: Annotated[
        str, typer.Option(help="Rig preset or .toml file; default: 4recon, with two VLP-16.")
    ] = "",
    lidar: Annotated[
        list[str] | None,
        typer.Option(
            metavar="MODEL",
            help="In place of a rig: one or two LiDARs of any make, as Mid-360; repeatable. The "
            "first one is level, the second one upright. All are on the page simulation.",
        ),
    ] = None,
    figure: Annotated[
        str, typer.Option(help="Rigs with a profiler, in the hall: eight, rectangle or circle.")
    ] = "",
    bag: Annotated[
        bool | None,
        typer.Option(help="Also write a rosbag2; default: if all are Velodynes."),
    ] = None,
    degrade: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME[=VALUE]",
            help="An error that the rig file does not know, as extrinsics=1.4; repeatable. "
            "All are on the page simulation of the docs.",
        ),
    ] = None,
    targets: Annotated[
        int,
        typer.Option(help="Survey targets along the path, and the list of their survey."),
    ] = 0,
) -> None:
    """Simulate a walk: packets, IMU, GNSS, and the truth they can be judged by."""
    if rig and lidar:
        raise typer.BadParameter(CodedText("simulate-rig-lidar"))
    given = _Given(world, out, seconds, seed, figure, bag, tuple(degrade or ()), targets)
    _simulate(given, _rig(rig, lidar))


@dataclass(frozen=True, slots=True)
class _Given:
    """What the command was called with, but the rig."""

    world: str
    out: Path
    seconds: float | None
    seed: int
    figure: str
    bag: bool | None
    degrade: tuple[str, ...]
    targets: int


def _rig(name: str, lidars: list[str] | None) -> Rig:
    from recon4.model.rig import load_rig
    from recon4.simulation.setup import rig_of_lidars

    return rig_of_lidars(lidars) if lidars else load_rig(name or "4recon")


def _simulate(given: _Given, mounted: Rig) -> None:
    from recon4.cli.terminal import watcher
    from recon4.simulation.backpack import prepare_backpack, simulate_backpack
    from recon4.simulation.crowd import Crowd
    from recon4.simulation.degradation import parse_degradations
    from recon4.simulation.setup import models_with, prepare
    from recon4.simulation.simulate import simulate as run
    from recon4.simulation.targets import with_targets

    degradations = parse_degradations(given.degrade)
    profiler = mounted.row_of("profiler") is not None
    if given.figure and not profiler:
        raise typer.BadParameter(CodedText("simulate-figure"))
    if given.targets and profiler:
        raise typer.BadParameter(CodedText("simulate-targets"))
    crowd = Crowd.of(degradations)
    with watcher() as progress:
        if profiler:
            walk = prepare_backpack(
                given.world,
                figure=given.figure,
                seconds=given.seconds or 0.0,
                seed=given.seed,
                rig=mounted,
                people=crowd.people,
            )
            simulate_backpack(walk, given.out, degradations=degradations, progress=progress)
        else:
            setup = prepare(
                given.world,
                seconds=given.seconds or 60.0,
                seed=given.seed,
                rig=mounted,
                models=models_with(degradations),
                crowd=crowd,
            )
            setup = with_targets(setup, given.targets)
            run(setup, given.out, bag=given.bag, degradations=degradations, progress=progress)
    write(f"{given.out}")
