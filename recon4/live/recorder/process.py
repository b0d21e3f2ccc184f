"""The recorder: a process that writes every datagram to the disk and does nothing else.

``python -m recon4.live.recorder.process PROJECT`` listens on the ports of the rig until it
receives ``stop``, SIGTERM, SIGINT or SIGHUP. It exchanges JSON lines over a Unix socket
(`CaptureSession.socket`): the messages of `RecorderMessage` to its clients, each `Request` from
them.
"""

from __future__ import annotations

import asyncio
import errno
import json
import os
import sys
import time
from collections import Counter
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from functools import partial
from pathlib import Path

import msgspec

from recon4.errors import Recon4Error, StoreError
from recon4.live.confinement import confine_recorder
from recon4.live.ipc.line_server import LineServer
from recon4.live.protocol import (
    AddMark,
    Mark,
    Message,
    Pause,
    Request,
    Resume,
    Sender,
    Status,
    Stop,
    Stopped,
    Written,
    fields_of,
)
from recon4.live.recorder.capture_file import CaptureFile, Datagram
from recon4.live.recorder.device_opener import DeviceOpener
from recon4.live.recorder.disk import DiskWatch
from recon4.live.recorder.ports import Port, check_sources, open_ports
from recon4.live.recorder.serial_line import SerialLine
from recon4.live.recorder.serial_port import open_serial_device
from recon4.live.recorder.tuning import RECORDER
from recon4.live.session import CaptureSession, load_session, stretched
from recon4.model.rig import Rig, load_rig
from recon4.model.serial_device import SerialDevice, parse_serial_device
from recon4.sandbox import refuse_new_sockets, restart_with_one_thread
from recon4.store.atomic import write_json
from recon4.system.stopping import StopSignals, end_process


class Recorder:
    """Writes datagrams of sockets to a file and reports its status. Runs in one event loop."""

    def __init__(
        self, session: CaptureSession, rig: Rig, *, opener: DeviceOpener | None = None
    ) -> None:
        """Open ports and file.

        Args:
            session: What is recorded where.
            rig: The sensors.
            opener: Opens the serial line of the GNSS receiver; None = it has none.

        Raises:
            ConfigError: If a port cannot be opened.
            OSError: If the capture file exists or cannot be created.
        """
        self._session, self._rig = session, rig
        self._loop = asyncio.get_running_loop()
        self._lines = LineServer(initial_messages=self._initial_messages, on_request=self._handle)
        self._ports = open_ports(rig, address=session.address)
        self._file = CaptureFile(session.capture, on_written=self._written)
        self._serial = self._read_serial(opener)
        self._counts: Counter[tuple[str, int]] = Counter()
        self._counted: Counter[tuple[str, int]] = Counter()
        self._data: Counter[tuple[str, int]] = Counter()
        """Datagrams with the size of a LiDAR data packet."""
        self._data_counted: Counter[tuple[str, int]] = Counter()
        self._received_s: dict[tuple[str, int], float] = {}
        """Time of the last datagram of each sender."""
        self._counted_s = self._began_s = time.monotonic()
        self._began_ns = time.time_ns()
        self._paused = False
        self._skipped = 0
        self._disk = DiskWatch(session.project, least_free_bytes=session.least_free_bytes)
        self._disk.update(self._began_s)
        self._notes_problem = ""
        """Why a mark is not on the disk; empty = all marks are."""
        self._rates: list[Sender] = []
        self._over = asyncio.Event()
        self._why = "stopped"

    def _read_serial(self, opener: DeviceOpener | None) -> SerialLine | None:
        if opener is None:
            return None

        def take(datagram: Datagram) -> None:
            self._loop.call_soon_threadsafe(self._take, datagram)

        rig = self._rig
        return SerialLine(rig.gnss_serial, opener, port=rig.gnss_port, take=take)

    async def run(self, on_ready: Callable[[], None], stop: StopSignals) -> None:
        """Record until a request or signal to stop."""
        stop.request(partial(self._loop.call_soon_threadsafe, self._over.set))
        await self._lines.listen(self._session.socket("recorder"))
        for port in self._ports:
            self._loop.add_reader(port.socket, self._receive, port)
        on_ready()
        while not self._over.is_set():
            try:
                async with asyncio.timeout(RECORDER.status_every_s):
                    await self._over.wait()
            except TimeoutError:
                self._report_status()
        await self._finish()

    async def _finish(self) -> None:
        for port in self._ports:
            self._receive(port)
            self._loop.remove_reader(port.socket)
            port.socket.close()
        if self._serial is not None:
            await asyncio.to_thread(self._serial.close)
            await asyncio.sleep(0)  # its last sentences are recorded
        await asyncio.to_thread(self._file.close)
        outcome = Stopped(why=self._why, **msgspec.structs.asdict(self._status()))
        with suppress(StoreError):  # on a full disk; clients still receive the message
            write_json(self._session.outcome, fields_of(outcome))
        self._lines.send(outcome)
        await self._lines.close()

    def _receive(self, port: Port) -> None:
        for _ in range(RECORDER.at_once):
            datagram = port.receive()
            if datagram is None:
                return
            self._take(datagram)

    def _take(self, datagram: Datagram) -> None:
        sender = datagram.source[0], datagram.port
        if sender not in self._counts and len(self._counts) >= RECORDER.max_senders:
            sender = "others", datagram.port
        self._counts[sender] += 1
        self._data[sender] += len(datagram.payload) >= RECORDER.data_bytes
        self._received_s[sender] = time.monotonic()
        if self._paused:
            self._skipped += 1
        else:
            t_ns = stretched(datagram.t_ns, self._session.speed)
            self._file.add(replace(datagram, t_ns=t_ns))

    def _written(self, size: int) -> None:
        self._loop.call_soon_threadsafe(self._lines.send, Written(size))

    def _report_status(self) -> None:
        now_s = time.monotonic()
        seconds = now_s - self._counted_s
        fresh, data = self._counts - self._counted, self._data - self._data_counted
        self._rates = [
            Sender(
                source=sender[0],
                port=sender[1],
                per_s=round(fresh[sender] / seconds, 1),
                data_per_s=round(data[sender] / seconds, 1),
                silent_s=round(now_s - self._received_s[sender], 1),
            )
            for sender in sorted(self._counts)
        ]
        self._counted, self._counted_s = Counter(self._counts), now_s
        self._data_counted = Counter(self._data)
        self._disk.update(now_s)
        self._lines.send(self._status())
        if not self._disk.state.enough:
            self._why = "the disk is nearly full"
            self._over.set()

    def _status(self) -> Status:
        return Status(
            t_ns=stretched(time.time_ns(), self._session.speed),
            began_ns=self._began_ns,
            seconds=round(time.monotonic() - self._began_s, 1),
            paused=self._paused,
            skipped_in_pauses=self._skipped,
            senders=self._rates,
            ports={str(port.number): port.expected for port in self._ports},
            kernel_drops=sum(port.kernel_drops for port in self._ports),
            serial=None if self._serial is None else self._serial.problem,
            file=self._file.state(),
            disk=self._disk.state,
            notes=self._notes_problem,
        )

    def _initial_messages(self) -> list[Message]:
        return [Written(self._file.state().written_bytes), self._status()]

    def _handle(self, request: Request) -> None:
        match request:
            case Stop():
                self._over.set()
            case Pause():
                self._paused = True
                self._mark("pause")
            case Resume():
                self._paused = False
                self._mark("resume")
            case AddMark(what, text, who, ago_s):
                self._mark(what, text, who, ago_s=ago_s)

    def _mark(
        self, what: str, text: str | None = None, who: str | None = None, *, ago_s: float = 0.0
    ) -> None:
        t_ns = stretched(time.time_ns() - round(1e9 * ago_s), self._session.speed)
        mark = Mark(t_ns, what, text, who)
        try:
            _append(self._session.marks, json.dumps(fields_of(mark), ensure_ascii=False) + "\n")
        except OSError as error:
            self._notes_problem = error.strerror or str(error)
        else:
            self._notes_problem = ""
            self._lines.send(mark)
        self._report_status()


def _append(path: Path, line: str) -> None:
    """Append a line to a file and sync it; the line is written completely or not at all.

    Raises:
        OSError: If it cannot be written.
    """
    file = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_APPEND | os.O_CLOEXEC, 0o644)
    try:
        before = os.fstat(file).st_size
        data = line.encode()
        if os.write(file, data) < len(data):
            os.ftruncate(file, before)
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        os.fsync(file)
    finally:
        os.close(file)


def main(
    project: Path,
    stop: StopSignals,
    *,
    open_device: Callable[[SerialDevice], int] = open_serial_device,
) -> int:
    """Record a prepared session; print ``ready`` once the ports are open.

    Args:
        project: Its folder.
        stop: Catches the signals.
        open_device: Opens the serial line of a GNSS receiver.
    """

    def report_ready() -> None:
        refuse_new_sockets()  # before the first datagram is read
        sys.stdout.write("ready\n")
        sys.stdout.flush()

    async def run(opener: DeviceOpener | None) -> None:
        await Recorder(session, rig, opener=opener).run(report_ready, stop)

    session = load_session(project)
    try:
        rig = load_rig(session.rig)
        check_sources(rig)
        restart_with_one_thread()
        opener = _device_opener(rig, open_device)
        confine_recorder(session)
        asyncio.run(run(opener))
    except (Recon4Error, OSError) as error:
        sys.stderr.write(f"{error}\n")
        return 1
    return 0


def _device_opener(rig: Rig, open_device: Callable[[SerialDevice], int]) -> DeviceOpener | None:
    if not rig.gnss_serial:
        return None
    device = parse_serial_device(rig.gnss_serial)
    return DeviceOpener(lambda: open_device(device))


if __name__ == "__main__":
    end_process(partial(main, Path(sys.argv[1])))
