"""The mapper: a process that reads a growing capture file, maps it, and stores the frames.

``python -m recon4.live.mapper.process PROJECT`` reads the file while the recorder writes it.
It may be killed and restarted at any time: it starts at the beginning of the file and catches up.
It sends JSON lines over a socket (``docs/how-to/live.md``): messages of `LiveMap`, ``notes``
(repairs and warnings of the reader) and, at the end, ``done``.
"""

from __future__ import annotations

import asyncio
import logging
import shutil
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any

from recon4.errors import Recon4Error
from recon4.live.confinement import confine_mapper, scratch_of
from recon4.live.ipc.line_client import linked
from recon4.live.ipc.line_server import LineServer
from recon4.live.mapper.follower import Follower, LidarFollower, ScanFollower
from recon4.live.mapper.gnss_watch import GnssWatch
from recon4.live.mapper.import_notes import NotesWatch
from recon4.live.mapper.latency import Latency
from recon4.live.mapper.live_map import LiveMap
from recon4.live.mapper.scan_map import ScanMap
from recon4.live.mapper.tail_file import TailFile, WriteProgress
from recon4.live.mapper.warm_up import warm_up
from recon4.live.project_files import finish, finish_scans
from recon4.live.protocol import Done, MapperMessage, Message, Pose, Stopped, Written
from recon4.live.session import CaptureSession, load_session, stretched
from recon4.locales.coded import StoredText, text_of
from recon4.model.laser_scans import LaserScans
from recon4.model.multiframe import Multiframe
from recon4.model.rig import Rig, load_rig
from recon4.model.samples import GnssSamples, ImuSamples
from recon4.progress import Silent
from recon4.recording.ingest import LiveSource, ingest
from recon4.recording.lasers.scan_capture import ScanCapture
from recon4.recording.sources import Sources
from recon4.settings import Settings, preset
from recon4.store.atomic import write_json
from recon4.system.stopping import StopSignals, end_process

log = logging.getLogger(__name__)

STOPPED = Done(frames=0, problem="the mapper was stopped by a signal")


def _failed(error: Exception) -> Done:
    why = StoredText.of(text_of(error))
    return Done(frames=0, problem=why.text, code=why.code, values=why.values)


class Mapper:
    """Reads and maps in a thread; the event loop exchanges messages."""

    def __init__(self, session: CaptureSession) -> None:
        self._session = session
        self._rig: Rig = load_rig(session.rig)
        self._settings: Settings = preset(session.preset)
        self._mapping = threading.Lock()
        self._growth = WriteProgress()
        self._live = LiveSource(self._open, self._watch, opened=self._opened)
        self._loop = asyncio.get_running_loop()
        self._lines = LineServer(
            initial_messages=self._initial_messages, on_request=lambda request: None
        )
        self._gnss, self._notes = GnssWatch(), NotesWatch(self._live.report)
        self._newest_notes = self._notes.message(time.monotonic())
        self._newest_pose: list[Pose] = []
        self._notes_s = 0.0
        self._follower = self._make_follower()
        self._aborted = False

    def _make_follower(self) -> Follower:
        rig, settings = self._rig, self._settings
        latency = Latency(self._live.report, self._now_ns)
        if rig.row_of("laser2d") is not None:
            return ScanFollower(ScanMap(rig, settings), rig, latency)
        return LidarFollower(LiveMap(rig, settings, scratch=self._session.folder), rig, latency)

    async def run(self, on_ready: Callable[[], None], stop: StopSignals) -> int:
        """Map until the recorder has ended; returns the exit code."""
        stop.request(partial(self._loop.call_soon_threadsafe, self._abort))
        await self._lines.listen(self._session.socket("mapper"))
        following = asyncio.create_task(self._follow())
        await asyncio.to_thread(warm_up, self._rig, self._settings)
        on_ready()
        try:
            outcome = await asyncio.to_thread(self._read)
        except (Recon4Error, OSError) as error:
            outcome = STOPPED if self._aborted else _failed(error)
            if not self._aborted:
                log.exception("mapping ended")
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
        if self._has_frames:
            out.mkdir(parents=True)
            ingest(
                Sources((self._session.capture,), self._rig),
                out,
                settings=self._settings.ingest,
                progress=Silent(),
                live=self._live,
            )
        else:
            self._read_scans()
        self._publish(self._follower.flush())
        self._report_notes(every_s=0.0)
        if self._aborted:
            return STOPPED
        began_s = time.monotonic()
        if self._has_frames:
            frames = finish(self._session, out, self._settings)
        else:
            frames = finish_scans(self._session, self._settings)
        if not self._session.outcome.exists():
            write_json(self._session.outcome, {"why": "the recorder died"})
        seconds = round(time.monotonic() - began_s, 2)
        return Done(frames=frames, problem="", seconds=seconds)

    @property
    def _has_frames(self) -> bool:
        """Whether the sensors make multiframes; a 2-D laser alone makes scans."""
        return any(sensor.kind != "laser2d" for sensor in self._rig.sensors if sensor.enabled)

    def _read_scans(self) -> None:
        """Follow the capture of a 2-D laser alone."""
        report = self._live.report
        files = (self._session.capture,)
        for item in ScanCapture(files, self._rig, report=report, open_file=self._open).read():
            if isinstance(item, LaserScans | ImuSamples | GnssSamples):
                self._watch(item)

    def _open(self, path: Path) -> Any:
        return TailFile(path, self._growth)

    def _opened(self, rig: Rig) -> None:
        """Say what the reader found, and map with the IMU of the LiDAR that is read, where the rig
        file names none.
        """
        self._report_notes(every_s=0.0)  # packets of another model never give a pose
        if rig.imu_sensor == self._rig.imu_sensor:
            return
        with self._mapping:
            self._rig = rig
            self._follower = self._make_follower()

    def _watch(self, item: Multiframe | ImuSamples | GnssSamples | LaserScans) -> None:
        if isinstance(item, GnssSamples):
            self._send(self._gnss.push(item))
        else:
            self._publish(self._follower.take(item))

    def _publish(self, messages: Iterator[MapperMessage]) -> None:
        """Map what comes next, and send each message as soon as it is known."""
        while True:
            with self._mapping:
                message = next(messages, None)
            if message is None:
                return
            if isinstance(message, Pose):
                self._newest_pose = [message]
                self._report_notes()
            self._send(message)

    def _now_ns(self) -> int:
        return stretched(time.time_ns(), self._session.speed)

    def _report_notes(self, every_s: float = 1.0) -> None:
        if time.monotonic() - self._notes_s < every_s:
            return
        self._notes_s = time.monotonic()
        self._newest_notes = self._notes.message(self._notes_s)
        self._send(self._newest_notes)

    def _send(self, message: Message) -> None:
        self._loop.call_soon_threadsafe(self._lines.send, message)

    def _initial_messages(self) -> list[Message]:
        with self._mapping:
            snapshot = self._follower.snapshot()
        return [*snapshot.messages(), *self._newest_pose, self._newest_notes]


def main(project: Path, stop: StopSignals) -> int:
    """Map the capture of a project; print ``ready`` once the socket is open."""
    logging.basicConfig(level=logging.INFO, format="%(asctime)s %(name)s %(message)s")

    def report_ready() -> None:
        sys.stdout.write("ready\n")
        sys.stdout.flush()

    async def run() -> int:
        return await Mapper(session).run(report_ready, stop)

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
    end_process(partial(main, Path(sys.argv[1])))
