"""The mapper: a process that reads a growing capture file, maps it, and stores the frames.

``python -m recon4.live.mapper.process PROJECT`` reads the file while the recorder writes it.
It may be killed and restarted at any time: it starts at the beginning of the file and catches up.
It sends JSON lines over a Unix socket (``docs/live.md``): messages of `LiveMap`, ``notes`` (repairs
and warnings of the reader) and, at the end, ``done``.
"""

from __future__ import annotations

import asyncio
import logging
import shutil
import signal
import sys
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np

from recon4.errors import Recon4Error
from recon4.live.confinement import confine_mapper, scratch_of
from recon4.live.ipc.line_client import linked
from recon4.live.ipc.line_server import LineServer
from recon4.live.mapper.gnss_watch import GnssWatch
from recon4.live.mapper.imu_synchronization import ImuSynchronization
from recon4.live.mapper.latency import Latency
from recon4.live.mapper.live_map import LiveMap
from recon4.live.mapper.notes import NotesWatch
from recon4.live.mapper.tail_file import TailFile, WriteProgress
from recon4.live.project_files import finish
from recon4.live.protocol import Done, Message, Pose, Stopped, Written
from recon4.live.session import CaptureSession, load_session, stretched
from recon4.model.multiframe import Multiframe
from recon4.model.rig import Rig, load_rig
from recon4.model.samples import STANDARD_GRAVITY_M_S2, GnssSamples, ImuSamples
from recon4.progress import Silent
from recon4.recording.ingest import LiveSource, ingest
from recon4.recording.sources import Sources
from recon4.settings import Settings, preset
from recon4.store.atomic import write_json

log = logging.getLogger(__name__)


class Mapper:
    """Reads and maps in a thread; the event loop exchanges messages."""

    def __init__(self, session: CaptureSession) -> None:
        self._session = session
        self._rig: Rig = load_rig(session.rig)
        self._settings: Settings = preset(session.preset)
        self._map = LiveMap(self._rig, self._settings, scratch=session.folder)
        self._mapping = threading.Lock()
        self._growth = WriteProgress()
        self._live = LiveSource(self._open, self._watch)
        self._loop = asyncio.get_running_loop()
        self._lines = LineServer(
            initial_messages=self._initial_messages, on_request=lambda request: None
        )
        self._gnss, self._notes = GnssWatch(), NotesWatch(self._live.report)
        self._newest_notes = self._notes.message(time.monotonic())
        self._newest_pose: list[Pose] = []
        self._notes_s = 0.0
        self._synchronization = ImuSynchronization()
        self._latency = Latency(self._live.report, self._now_ns)
        self._aborted = False

    async def run(self, on_ready: Callable[[], None]) -> int:
        """Map until the recorder has ended; returns the exit code."""
        await self._lines.listen(self._session.socket("mapper"))
        for number in (signal.SIGTERM, signal.SIGINT):
            self._loop.add_signal_handler(number, self._abort)
        following = asyncio.create_task(self._follow())
        await asyncio.to_thread(warm_up, self._rig, self._settings)
        on_ready()
        try:
            outcome = await asyncio.to_thread(self._read)
        except (Recon4Error, OSError) as error:
            log.exception("mapping ended")
            outcome = Done(frames=0, problem=str(error))
        following.cancel()
        await asyncio.gather(following, return_exceptions=True)
        self._lines.send(outcome)
        await self._lines.close()
        return 1 if outcome.problem else 0

    async def _follow(self) -> None:
        """Receive the readable size from the recorder; when it has ended the file is complete."""
        try:
            with suppress(ConnectionError, FileNotFoundError):
                while not await self._receive_recorder():
                    pass  # disconnected as too slow: connect again
            self._growth.reached(self._session.capture.stat().st_size)
        finally:
            self._growth.complete()  # even if the folder was removed

    async def _receive_recorder(self) -> bool:
        """Whether the recorder has reported ``stopped``; else the connection was closed.

        Raises:
            ConnectionError, FileNotFoundError: If there is no recorder.
        """
        async with linked(self._session.socket("recorder")) as link:
            async for message in link.messages():
                match message:
                    case Written():
                        self._growth.reached(message.size)
                    case Stopped():
                        return True
        return False

    def _abort(self) -> None:
        """End soon, without storing frames."""
        self._aborted = True
        self._growth.complete()

    def _read(self) -> Done:
        out = self._session.folder / "frames"
        shutil.rmtree(out, ignore_errors=True)
        out.mkdir(parents=True)
        ingest(
            Sources((self._session.capture,), self._rig),
            out,
            settings=self._settings.ingest,
            progress=Silent(),
            live=self._live,
        )
        for frame in self._synchronization.flush():
            self._map_frame(frame)
        if self._aborted:
            return Done(frames=0, problem="the mapper was stopped by a signal")
        began_s = time.monotonic()
        frames = finish(self._session, out, self._settings)
        if not self._session.outcome.exists():
            write_json(self._session.outcome, {"why": "the recorder died"})
        seconds = round(time.monotonic() - began_s, 2)
        return Done(frames=frames, problem="", seconds=seconds)

    def _open(self, path: Path) -> Any:
        return TailFile(path, self._growth)

    def _watch(self, item: Multiframe | ImuSamples | GnssSamples) -> None:
        if isinstance(item, GnssSamples):
            self._send(self._gnss.push(item))
            return
        if isinstance(item, ImuSamples):
            self._map.extend_imu(item)
            offset_ns = round(self._rig.imu_time_offset_s * 1e9)
            ready = self._synchronization.imu_until(int(item.t_ns[-1]) + offset_ns)
        else:
            ready = self._synchronization.push(item)
        for frame in ready:
            self._map_frame(frame)

    def _map_frame(self, frame: Multiframe) -> None:
        if self._latency.leave_out(frame.t_ns + frame.duration_ns):
            self._map.thin(frame)
            return
        with self._mapping:
            pose, others = self._map.push(frame)
        pose.t_ns = self._latency.on_recorder_clock(pose.t_ns)
        pose.age_s = self._latency.age_s(pose.t_ns)
        self._newest_pose = [pose]
        for message in (pose, *others):
            self._send(message)
        self._report_notes()

    def _now_ns(self) -> int:
        return stretched(time.time_ns(), self._session.speed)

    def _report_notes(self) -> None:
        if time.monotonic() - self._notes_s < 1.0:
            return
        self._notes_s = time.monotonic()
        self._newest_notes = self._notes.message(self._notes_s)
        self._send(self._newest_notes)

    def _send(self, message: Message) -> None:
        self._loop.call_soon_threadsafe(self._lines.send, message)

    def _initial_messages(self) -> list[Message]:
        with self._mapping:
            snapshot = self._map.snapshot()
        return [*snapshot.messages(), *self._newest_pose, self._newest_notes]


def warm_up(rig: Rig, settings: Settings) -> None:
    """Load the compiled kernels with synthetic multiframes, so that real ones are not delayed."""
    live_map = LiveMap(rig, settings)
    rng = np.random.default_rng(0)
    ring, step = np.meshgrid(np.arange(16), np.arange(900))
    azimuth, elevation = step.ravel() * 2 * np.pi / 900, np.deg2rad(2.0 * ring.ravel() - 15)
    ray = np.stack([np.cos(azimuth), np.sin(azimuth), np.tan(elevation)], axis=1)
    reach_m = 3.0 / np.abs(ray).max(axis=1, keepdims=True) + rng.normal(0, 0.01, (len(ray), 1))
    count = len(ray)
    for k in range(3):
        t_ns = (20 + k) * 100_000_000  # late enough for a summary
        imu_ns = t_ns + 10_000_000 * np.arange(11, dtype=np.int64)
        accel = np.tile([0.0, 0.0, STANDARD_GRAVITY_M_S2], (11, 1))
        live_map.extend_imu(ImuSamples(imu_ns, np.zeros((11, 3)), accel))
        frame = Multiframe(
            frame_id=k,
            t_ns=t_ns,
            duration_ns=100_000_000,
            xyz=(ray * reach_m).astype(np.float32),
            intensity=np.full(count, 30, np.uint8),
            ring=ring.ravel().astype(np.uint8),
            sensor=np.zeros(count, np.uint8),
            echo=np.zeros(count, np.uint8),
            dt_ns=np.sort(rng.integers(0, 100_000_000, count)).astype(np.int32),
        )
        live_map.push(frame)


def main(project: Path) -> int:
    """Map the capture of a project; print ``ready`` once the socket is open."""
    logging.basicConfig(level=logging.INFO, format="%(asctime)s %(name)s %(message)s")

    def report_ready() -> None:
        sys.stdout.write("ready\n")
        sys.stdout.flush()

    async def run() -> int:
        return await Mapper(session).run(report_ready)

    try:
        session = load_session(project)
        confine_mapper(session)
        code = asyncio.run(run())
        shutil.rmtree(scratch_of(session), ignore_errors=True)
        return code
    except Recon4Error as error:
        sys.stderr.write(f"{error}\n")
        return 1


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
