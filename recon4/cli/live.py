"""The commands ``recon4 record`` and ``recon4 replay``: live capture without a server."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from recon4.cli.terminal import worded
from recon4.locales.coded import CodedText

if TYPE_CHECKING:
    from recon4.live.newest_messages import Newest
    from recon4.locales.texts import Shown
    from recon4.model.rig import Rig

live = typer.Typer()

AddressOption = Annotated[
    str, typer.Option(help="Listen on the network card with this address; default: all.")
]
SpeedOption = Annotated[
    float,
    typer.Option(
        min=0.1, max=100.0, help="Speed factor, for tests; use the same for record and replay."
    ),
]


@live.command()
def replay(
    recording: Annotated[
        Path,
        typer.Argument(
            help="pcap file, folder of `recon4 simulate`, or scans: bag, CARMEN log, table."
        ),
    ],
    *,
    to: Annotated[str, typer.Option(help="Address the recorder listens on.")] = "127.0.0.1",
    speed: SpeedOption = 1.0,
    times: Annotated[
        int,
        typer.Option(min=1, help="Number of rounds, for walks that end where they began."),
    ] = 1,
    rig: Annotated[
        str | None,
        typer.Option(help="Scans of a bag or log: rig preset or .toml with its topics and ports."),
    ] = None,
) -> None:
    """Replay a recording to the ports of a recorder as its sensors sent it."""
    from recon4.cli.terminal import watcher
    from recon4.live.replay import replay as run
    from recon4.model.rig import load_rig

    with watcher() as progress:
        sent = run(
            recording,
            progress=progress,
            target=to,
            speed=speed,
            repetitions=times,
            rig=load_rig(rig) if rig else None,
        )
    _say("replay-sent", count=sent)


@live.command()
def record(
    context: typer.Context,
    out: Annotated[Path, typer.Argument(help="New project folder.")],
    *,
    rig: Annotated[str, typer.Option(help="Rig preset or .toml: sensors, ports, addresses.")],
    preset: Annotated[
        str, typer.Option(help="Start from: indoor, staircase, outdoor, thesis.")
    ] = "indoor",
    seconds: Annotated[
        float | None, typer.Option(min=1.0, help="Stop after this time; default: at Ctrl-C.")
    ] = None,
    address: AddressOption = "0.0.0.0",
    speed: SpeedOption = 1.0,
) -> None:
    """Record sensors and map during the walk; the project exists from the start."""
    import asyncio

    from recon4.live.headless import Headless
    from recon4.live.project_files import begin, discard
    from recon4.live.session import CaptureSession
    from recon4.settings import preset as preset_named
    from recon4.system.stopping import StoppedBySignal, StopSignals

    loaded = _described_rig(rig)
    preset_named(preset)
    stop = context.find_object(StopSignals)
    assert stop is not None

    async def run() -> Newest:
        return await Headless(session, send=_reporter(loaded)).run(seconds, stop)

    try:
        session = begin(out, loaded, preset=preset, address=address, speed=speed)
        _say("capture-begins", capture=str(session.capture))
        ended = asyncio.run(run())
    except StoppedBySignal:
        discard(CaptureSession(project=out))  # nothing was recorded yet
        raise
    _write(_outcome(ended, of_scans=all(one.kind == "laser2d" for one in loaded.sensors)))
    if ended.stopped is not None and ended.stopped.why != "stopped":
        _say("capture-ended-early", why=ended.stopped.why)
    recordings = session.capture.parent
    command = f"recon4 process {session.capture} --rig {recordings / 'rig.toml'} --out {out}"
    _say("capture-next", command=command)
    if ended.done is None or ended.done.problem:
        raise typer.Exit(1)


def _described_rig(rig: str) -> Rig:
    """A rig preset or file, with the files beside it that describe its LiDARs."""
    from recon4.recording.packets.companions import load_described_rig

    loaded, used = load_described_rig(rig)
    for name, file in used.items():
        _say("capture-described", name=name, file=str(file))
    return loaded


def _reporter(rig: Rig) -> Callable[[Newest, str], None]:
    """Writes a line of progress, and each finding when it is new."""
    import time

    from recon4.live.findings import findings
    from recon4.live.headless import progress_line

    began_s, reported = time.monotonic(), set[str]()

    def send(newest: Newest, problem: str) -> None:
        _write(progress_line(newest, began_s))
        found = {one.text for one in findings(rig, newest, problem)}
        for text in sorted(found - reported):
            _write(f"  ! {text}")
        reported.clear()
        reported.update(found)

    return send


def _outcome(ended: Newest, *, of_scans: bool) -> str:
    done, stopped = ended.done, ended.stopped
    recorded = stopped.file.datagrams if stopped is not None else 0
    lost = stopped.kernel_drops + stopped.file.dropped if stopped is not None else 0
    frames, problem = (done.frames, done.problem) if done is not None else (0, "")
    ready = CodedText("capture-scans" if of_scans else "capture-multiframes", count=frames)
    return worded("capture-counts", recorded=recorded, lost=lost, mapped=problem or ready)


def _say(code: str, /, **values: Shown) -> None:
    _write(worded(code, **values))


def _write(text: str) -> None:
    sys.stdout.write(text + "\n")
    sys.stdout.flush()
