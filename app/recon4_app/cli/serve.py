"""The commands ``recon4 serve`` and ``recon4 demo``: a server in this process."""

from __future__ import annotations

import sys
import webbrowser
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from recon4.cli.terminal import complaint_of, write
from recon4.errors import ConfigError
from recon4.system.stopping import StopSignals

if TYPE_CHECKING:
    from recon4_app.settings import ServerSettings

server = typer.Typer()

DaysOption = Annotated[
    float, typer.Option(min=0.0, help="Days until earlier runs are freed; 0 = never.")
]


@server.command()
def serve(  # noqa: PLR0913 - what a server can be started with
    context: typer.Context,
    root: Annotated[Path, typer.Argument(help="Folder that holds project folders.")] = Path(),
    *,
    lan: Annotated[bool, typer.Option("--lan", help="For others: TLS and login together.")] = False,
    behind: Annotated[
        str, typer.Option(help="Address of a reverse proxy with TLS, https://NAME/PATH/; login.")
    ] = "",
    host: Annotated[str, typer.Option(help="Address to listen on; default by --lan.")] = "",
    port: Annotated[int, typer.Option(help="Port; 0 = any free one.")] = 8000,
    tls_cert: Annotated[Path | None, typer.Option(help="Your certificate chain, PEM.")] = None,
    tls_key: Annotated[Path | None, typer.Option(help="Its key, PEM.")] = None,
    points: Annotated[
        int, typer.Option(min=50_000, help="Largest number of map points sent to one browser.")
    ] = 3_000_000,
    live_address: Annotated[
        str, typer.Option(help="Network card the sensors of a live capture send to; all.")
    ] = "0.0.0.0",
    keep_earlier: DaysOption = 0.0,
    show: Annotated[bool, typer.Option("--open", help="Open it in this browser.")] = False,
) -> None:
    """Show projects in the browser: results, jobs, 3D viewer. Ctrl-C ends it."""
    from recon4_app.network.behind import public_address
    from recon4_app.settings import (
        ServerSettings,
        allowed_hosts_from_environment,
        recording_folders_from_environment,
        webhook_networks_from_environment,
    )

    try:
        chosen = ServerSettings(
            root=root,
            lan=lan,
            behind=public_address(behind) if behind else None,
            host=host or ("0.0.0.0" if lan else "127.0.0.1"),
            port=port,
            tls_certificate=tls_cert,
            tls_key=tls_key,
            allowed_hosts=allowed_hosts_from_environment(),
            recording_folders=recording_folders_from_environment(),
            webhook_networks=webhook_networks_from_environment(),
            viewer_points=points,
            sensor_bind_address=live_address,
            keep_earlier_s=86400.0 * keep_earlier,
        )
    except ConfigError as error:
        raise typer.BadParameter(complaint_of(error)) from error
    _serve(chosen, context.find_object(StopSignals), show=show)


@server.command()
def demo(
    context: typer.Context,
    *,
    out: Annotated[Path, typer.Option(help="Folder for the recording and the project.")] = Path(
        "demo"
    ),
    seconds: Annotated[float, typer.Option(help="Length of the simulated walk in seconds.")] = 60.0,
    port: Annotated[int, typer.Option(help="Port of the server; 0 = any free one.")] = 8000,
    headless: Annotated[bool, typer.Option("--headless", help="End after the report.")] = False,
) -> None:
    """Simulate a walk through an office, map it and show it in the browser."""
    from recon4.cli.summaries import show_run
    from recon4.cli.terminal import watcher
    from recon4.model.rig import load_rig
    from recon4.pipeline import process as make_map
    from recon4.recording.sources import Sources
    from recon4.simulation.setup import prepare
    from recon4.simulation.simulate import simulate

    recording, project = out / "recording", out / "office"
    out.mkdir(parents=True, exist_ok=True)
    with watcher() as progress:
        if not recording.exists():
            walk = prepare("office", seconds=seconds, seed=1)
            simulate(walk, recording, bag=False, progress=progress)
        rig = load_rig(recording / "rig.toml")
        sources = Sources((recording / "recording.pcap",), rig, imu=recording / "imu.csv")
        summary = make_map(sources, project, progress=progress)
    show_run(summary)
    if not headless:
        from recon4_app.settings import ServerSettings, recording_folders_from_environment

        recordings = recording_folders_from_environment()
        chosen = ServerSettings(root=out, port=port, recording_folders=recordings)
        _serve(chosen, context.find_object(StopSignals), open_project=project.name)


def _serve(
    chosen: ServerSettings,
    stop: StopSignals | None,
    *,
    open_project: str | None = None,
    show: bool = False,
) -> None:
    from recon4_app.jobs.compiling import compiling_beside
    from recon4_app.main import serve as run

    def ready(url: str, notes: list[str]) -> None:
        write("\n".join([f"Serving at {url} (Ctrl-C ends it)", *notes]))
        sys.stdout.flush()
        if show:
            webbrowser.open(url)

    assert stop is not None
    with compiling_beside():
        run(chosen, stop, open_project=open_project, on_ready=ready)
