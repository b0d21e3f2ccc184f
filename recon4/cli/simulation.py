"""The command ``recon4 simulate``."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from recon4.cli.terminal import write

simulation = typer.Typer()


@simulation.command()
def simulate(
    world: Annotated[str, typer.Argument(help="As office or corridor:7; docs: page simulation.")],
    out: Annotated[Path, typer.Argument(help="New folder for the recording and its truth.")],
    *,
    seconds: Annotated[
        float | None,
        typer.Option(help="Length of the walk in seconds; default: 60, or that of the figure."),
    ] = None,
    seed: Annotated[int, typer.Option(help="Draws the walk and the noise.")] = 1,
    rig: Annotated[str, typer.Option(help="Rig preset or .toml file.")] = "4recon",
    figure: Annotated[
        str, typer.Option(help="Rigs with a profiler, in the hall: eight, rectangle or circle.")
    ] = "",
    bag: Annotated[bool, typer.Option(help="Also write a rosbag2.")] = True,
    degrade: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME[=VALUE]",
            help="An error that the rig file does not know, as extrinsics=1.4; repeatable. "
            "All are on the page simulation of the docs.",
        ),
    ] = None,
) -> None:
    """Simulate a walk: packets, IMU, GNSS, and the truth they can be judged by."""
    from recon4.cli.terminal import watcher
    from recon4.model.rig import load_rig
    from recon4.simulation.backpack import prepare_backpack, simulate_backpack
    from recon4.simulation.crowd import Crowd
    from recon4.simulation.degradation import parse_degradations
    from recon4.simulation.setup import models_with, prepare
    from recon4.simulation.simulate import simulate as run

    degradations, mounted = parse_degradations(degrade or []), load_rig(rig)
    profiler = mounted.row_of("profiler") is not None
    if figure and not profiler:
        raise typer.BadParameter("--figure is for rigs with a profiler, as --rig wuerzburg")
    crowd = Crowd.of(degradations)
    with watcher() as progress:
        if profiler:
            prepared = partial(prepare_backpack, world, figure=figure, rig=mounted)
            walk = prepared(seconds=seconds or 0.0, seed=seed, people=crowd.people)
            simulate_backpack(walk, out, degradations=degradations, progress=progress)
        else:
            models = models_with(degradations)
            setup = prepare(
                world, seconds=seconds or 60.0, seed=seed, rig=mounted, models=models, crowd=crowd
            )
            run(setup, out, bag=bag, degradations=degradations, progress=progress)
    write(f"{out}")
