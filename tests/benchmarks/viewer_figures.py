"""How quickly the viewer shows a map of 20 million points, to one and to twenty people.

``python -m tests.benchmarks.viewer_figures FOLDER`` makes the maps there once (some 900 MB) and
prints the figures of ``docs/studies/viewer-speed.md``. The client is a Python one that answers at
once, as a
browser with a graphics card does; drawing is not measured.
"""

from __future__ import annotations

import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

import numpy as np
import psutil

from recon4.mapping.map_notes import MapNotes
from recon4.mapping.tile import FIELDS, STORED
from recon4.mapping.tile_order import progressive
from recon4.mapping.tile_writer import TileWriter
from recon4.progress import Silent
from recon4.settings import Settings
from recon4.settings.reads import ReadsNothing
from recon4.store.arrays import save_trajectory
from recon4.store.project import Project
from recon4.store.stage import Stage, StageContext, StageRunner
from tests.project_builder import BEGAN_NS, loop_walk
from tests.service.running import Running, server_thread
from tests.service.viser_client import ViserClient, camera, viewing

TILE_M = 5.0
LANE_TILES = 5
"""Tiles across the street; its length depends on the number of points."""
IN_A_TILE = 50_000
PEOPLE = 20


def main(folder: Path) -> None:
    """Make the maps, start a server, measure, print."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, points in (("street", 20_000_000), ("small", 1_000_000)):
        if not (folder / name).exists():
            make_project(folder / name, points)
    with own_server(folder) as (server, process):
        print(f"load of the machine at the start: {psutil.getloadavg()[0]:.1f}")
        one_person(server, process.pid)
        many_people(server, process.pid)
        one_stalls(server, process.pid)


@contextmanager
def own_server(folder: Path) -> Iterator[tuple[Running, subprocess.Popen[str]]]:
    """A server in a process of its own, where twenty people may be one."""
    command = [sys.executable, "-m", __spec__.name, "serve", str(folder)]
    with subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as process:
        assert process.stdin is not None and process.stdout is not None
        yield Running(process.stdout.readline().strip(), folder), process
        process.stdin.close()


def serve(folder: Path) -> None:
    """Be that server until the input ends."""
    with server_thread(folder, viewer_sockets_a_person=2 * PEOPLE) as server:
        sys.stdout.write(server.url + "\n")
        sys.stdout.flush()
        sys.stdin.read()


def one_person(server: Running, pid: int) -> None:
    """First points, refining, turning, coming back, another color."""
    with viewing(server.url, "street") as warm:
        warm.send(camera((0.0, 12.0, 2.0)))
        warm.until(lambda c: c.shown)
    began_s = time.monotonic()
    with viewing(server.url, "street") as client:
        client.send(camera((0.0, 12.0, 2.0)))
        client.until(lambda c: c.shown)
        print(f"first points: {time.monotonic() - began_s:.2f} s, {client.shown} points")
        client.until(lambda c: c.shown > 150_000)
        print(f"150 000 points: {time.monotonic() - began_s:.2f} s")
        client.rest(quiet_s=1.0)
        print(f"all that is wanted: {client.shown} points, {client.bytes / 1e6:.1f} MB")
        moves = {
            "jump of 200 m": camera((200.0, 12.0, 2.0)),
            "5 m on": camera((205.0, 12.0, 2.0)),
            "turn by 20 degrees": camera((205.0, 12.0, 2.0), ahead=(0.94, 0.34, 0.0)),
            "back to the start": camera((0.0, 12.0, 2.0)),
        }
        for words, where in moves.items():
            client.send(where)
            timed(client, words, pid)
        for _ in range(3):
            client.colored = 0
            client.press("Raw or normalized")
            timed(client, "toggle of the intensity", pid)
        client.send(camera((200.0, -150.0, 150.0), ahead=(0.0, 1.0, -0.9)))
        timed(client, "from far above", pid)


def timed(client: ViserClient, words: str, pid: int) -> None:
    """Print the cost of an action until its last byte."""
    before, bytes_before, points = cpu_s(pid), client.bytes, set(client.points)
    spent_s = client.rest(quiet_s=1.0)
    new = sum(n for name, n in client.points.items() if name not in points)
    sent = client.bytes - bytes_before
    share = f", {sent / new:.1f} bytes a point" if new > 1000 else ""
    print(
        f"{words}: {1e3 * spent_s:.0f} ms to the last byte, {new} new points, "
        f"{client.colored} recolored, {sent / 1e6:.2f} MB{share}, {client.shown} shown, "
        f"{cpu_s(pid) - before:.2f} s of processor"
    )


def many_people(server: Running, pid: int) -> None:
    """All of a small map to twenty people at the same time."""
    before = cpu_s(pid)
    began_s, done_s = time.monotonic(), []
    lock = threading.Lock()

    def look() -> None:
        with viewing(server.url, "small") as client:
            client.send(camera((-4.0, 12.0, 2.5)))
            client.until(lambda c: "Fewer when" in str(c.widgets))
            client.set("Fewer when this browser is slow", False)
            client.rest(quiet_s=3.0)
            with lock:
                done_s.append((time.monotonic() - began_s - 3.0, client.shown))

    together([look] * PEOPLE)
    print(
        f"{PEOPLE} people on a million points: the last has {done_s[-1][1]} after "
        f"{max(s for s, _ in done_s):.1f} s, the first after {min(s for s, _ in done_s):.1f} s; "
        f"{cpu_s(pid) - before:.1f} s of processor; load {psutil.getloadavg()[0]:.0f}"
    )


def one_stalls(server: Running, pid: int) -> None:
    """Latency of two clients, alone and beside one that reads nothing."""
    with ExitStack() as stack:
        clients = [stack.enter_context(viewing(server.url, "small")) for _ in range(2)]
        for client in clients:
            client.send(camera((0.0, 12.0, 2.0)))
            client.rest(quiet_s=1.0)
        alone_s = [toggle_s(client) for _ in range(30) for client in clients]
        stalled = stack.enter_context(viewing(server.url, "small", buffer_bytes=1 << 16))
        stalled.send(camera((-30.0, 12.0, 12.0), ahead=(1.0, 0.0, -0.3)))
        stalled.until(lambda c: "Palette" in str(c.widgets))
        stalled.set("Fewer when this browser is slow", False)
        before = memory_bytes(pid)
        beside_s = []
        for k in range(30):
            stalled.set("Palette", ("turbo", "gray")[k % 2])
            beside_s += [toggle_s(client) for client in clients]
        print(
            f"toggle p95 alone {1e3 * np.percentile(alone_s, 95):.0f} ms, beside one who stalls "
            f"{1e3 * np.percentile(beside_s, 95):.0f} ms; memory of all processes grew by "
            f"{(memory_bytes(pid) - before) / 1e6:.0f} MB"
        )


def toggle_s(client: ViserClient) -> float:
    """Seconds until the legend shows the other intensity."""
    name = "normalized" if "by raw" in client.html() else "raw"
    client.press("Raw or normalized")
    return client.until(lambda c: f"Points by {name}" in c.html())


def together(jobs: list[Callable[[], None]]) -> None:
    """Run some calls at the same time."""
    threads = [threading.Thread(target=job) for job in jobs]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()


def cpu_s(pid: int) -> float:
    """Processor time of the server and its children."""
    times = [one.cpu_times() for one in family(pid)]
    return sum(t.user + t.system for t in times)


def memory_bytes(pid: int) -> int:
    """Private memory of the server and its children; the files of the map do not count."""
    return sum(one.memory_info().rss - one.memory_info().shared for one in family(pid))


def family(pid: int) -> list[psutil.Process]:
    """A process and its children."""
    return [psutil.Process(pid), *psutil.Process(pid).children(recursive=True)]


def make_project(root: Path, points: int) -> None:
    """A finished project: a street between two rows of houses, with a walk."""
    with Project.open(root) as project:
        project.describe(preset="outdoor", rig="made up")
        runner = StageRunner(project, Settings(), Silent())
        runner.run(Stage("level", 1, ReadsNothing, _level))
        runner.run(Stage("map", 1, ReadsNothing, lambda context: _map(points, context.out)))


def _level(context: StageContext) -> None:
    save_trajectory(context.out / "trajectory.npz", loop_walk())


def _map(points: int, out: Path) -> None:
    rng = np.random.default_rng(3)
    tiles = points // IN_A_TILE
    with TileWriter(out, STORED, tile_m=TILE_M) as writer:
        writer.notes = MapNotes(voxel_m=0.02)
        for k in range(tiles):
            ijk = (k // LANE_TILES, k % LANE_TILES, 0)
            writer.append(ijk, _columns(_surface(rng, house=ijk[1] in (0, LANE_TILES - 1)), rng))


def _surface(rng: np.random.Generator, *, house: bool) -> np.ndarray:
    """Points of a tile in the order of their voxels, then in strata as the stage ``map`` does."""
    p = rng.uniform(0.0, TILE_M, (IN_A_TILE, 3))
    wall = rng.random(IN_A_TILE) < (0.6 if house else 0.1)
    p[~wall, 2] = 0.02 * np.sin(p[~wall, 0])
    p[wall, 1] = 2.0 + 0.05 * np.sin(3.0 * p[wall, 0])
    order = np.lexsort(np.floor(p / 0.5).T)
    return p[order][progressive(np.arange(IN_A_TILE))]


def _columns(xyz: np.ndarray, rng: np.random.Generator) -> dict[str, np.ndarray]:
    n = len(xyz)
    known = {
        "xyz": xyz,
        "intensity": rng.integers(0, 255, n),
        "intensity_normalized": 0.5 + 0.3 * np.sin(xyz[:, 0]) + 0.05 * rng.standard_normal(n),
        "t_ns": BEGAN_NS + rng.integers(0, 60_000_000_000, n),
    }
    empty = {
        name: np.zeros((n, width) if width > 1 else n, dtype)
        for name, (dtype, width) in FIELDS.items()
    }
    return empty | {name: values.astype(FIELDS[name][0]) for name, values in known.items()}


if __name__ == "__main__":
    if sys.argv[1] == "serve":
        serve(Path(sys.argv[2]))
    else:
        main(Path(sys.argv[1]))
