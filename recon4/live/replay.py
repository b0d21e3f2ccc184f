"""Replays a recording to the ports of a recorder as its sensors sent it; needs no hardware.

Timestamps are shifted to the present, also those inside the packets of all families of LiDARs.
Samples of ``imu.csv`` and ``gnss.csv`` beside the capture go out as JSON datagrams; scans of a bag
or log do too.
"""

from __future__ import annotations

import csv
import heapq
import json
import re
import socket
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import ExitStack
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from recon4.errors import ConfigError, EmptyRecording
from recon4.live.session import loopback_address, stretched
from recon4.live.tuning import REPLAY
from recon4.locales.coded import CodedText
from recon4.model.ports import PORTS
from recon4.model.rig import Rig
from recon4.progress import Progress
from recon4.recording.lasers.scan_replay import datagrams_of_scans, has_scans
from recon4.recording.packets.replay import CapturedDatagram, captured_datagrams

_STAMP = re.compile(rb'("t_ns"\s*:\s*)(\d{1,19})(?=[\s,}])')
"""The time of a JSON object."""
_SAMPLE_DELAY_NS = {"imu.csv": 2_000_000, "gnss.csv": 50_000_000}
"""Delay between the timestamp of a sample and its sending [ns]."""


@dataclass(frozen=True, slots=True)
class ReplayDatagram:
    """A datagram to be sent."""

    t_ns: int
    """Arrival time in the recording [ns]."""
    source: str
    port: int
    payload: bytes
    """Packets of LiDARs have the times of the replay."""
    is_json: bool = False
    """The payload is JSON with an absolute ``t_ns``."""


Alter = Callable[[ReplayDatagram], Iterable[ReplayDatagram]]
"""Datagrams that are sent in place of one; simulates bad networks in tests."""


def replay(
    recording: Path,
    *,
    progress: Progress,
    target: str = "127.0.0.1",
    speed: float = 1.0,
    repetitions: int = 1,
    alter: Alter = lambda datagram: (datagram,),
    rig: Rig | None = None,
) -> int:
    """Send a recording at the recorded speed, as the datagrams of its sensors.

    Args:
        recording: A pcap file or a folder with pcap files, and the CSV files beside it; or scans of
            a 2-D laser or profiler in a bag, CARMEN log or table.
        progress: Receives the seconds of the recording.
        target: Address to send to.
        speed: Speed factor; the recorder must be started with the same one.
        repetitions: Number of rounds, one after the other with increasing time; for walks that
            end where they began.
        alter: May drop, change or multiply datagrams.
        rig: Topics and ports of scans; None = the shipped rig and default ports.

    Returns:
        Number of datagrams sent.

    Raises:
        RecordingError: If there is nothing to send.
        ConfigError: If the address is invalid or cannot be reached.
    """
    first = next(datagrams_of(recording, rig), None)
    if first is None:
        raise EmptyRecording(CodedText("replay-none", recording=recording.name))
    first_ns = second_ns = first.t_ns
    began_ns = time.time_ns()
    shift_ns = (stretched(began_ns, speed) - first_ns) // 1000 * 1000
    sent = 0
    progress.start("replay", 0, "s")
    with _Senders(target) as senders:
        for datagram, later_ns in _rounds(recording, repetitions, rig, shift_ns=shift_ns):
            t_ns = datagram.t_ns + later_ns
            _wait_until(began_ns + round((t_ns - first_ns) / speed))
            for altered in alter(datagram):
                senders.send(_at_present(altered, shift_ns + later_ns))
                sent += 1
            if t_ns - second_ns >= 1_000_000_000:
                second_ns = t_ns
                progress.advance()
    return sent


def datagrams_of(
    recording: Path, rig: Rig | None = None, *, shift_ns: int = 0
) -> Iterator[ReplayDatagram]:
    """All datagrams of a recording in order of time.

    Args:
        recording: As for `replay`.
        rig: As for `replay`.
        shift_ns: Added to the times inside packets of LiDARs [ns].
    """
    if has_scans(recording, rig):
        for sent in datagrams_of_scans(recording, rig):
            yield ReplayDatagram(sent.t_ns, "127.0.0.1", sent.port, sent.payload, is_json=True)
        return
    yield from _captured(recording, shift_ns)


def _captured(recording: Path, shift_ns: int) -> Iterator[ReplayDatagram]:
    """Datagrams of capture files, and samples of the CSV files beside them."""
    folder = recording if recording.is_dir() else recording.parent
    parts: list[Iterator[ReplayDatagram]] = [
        map(_sent, part) for part in captured_datagrams(recording, shift_ns)
    ]
    for name, port in (("imu.csv", PORTS.imu), ("gnss.csv", PORTS.gnss)):
        if (folder / name).exists():
            parts.append(_samples(folder / name, port))
    return heapq.merge(*parts, key=lambda datagram: datagram.t_ns)


def _rounds(
    recording: Path, repetitions: int, rig: Rig | None, *, shift_ns: int
) -> Iterator[tuple[ReplayDatagram, int]]:
    """Every datagram of every round, with the time offset of the round [ns]."""
    later_ns = 0
    for _ in range(repetitions):
        first_ns = last_ns = None
        for datagram in datagrams_of(recording, rig, shift_ns=shift_ns + later_ns):
            first_ns = datagram.t_ns if first_ns is None else first_ns
            last_ns = datagram.t_ns
            yield datagram, later_ns
        if first_ns is None or last_ns is None:
            return
        later_ns += (last_ns - first_ns) // 1000 * 1000 + REPLAY.between_ns


def _at_present(datagram: ReplayDatagram, shift_ns: int) -> ReplayDatagram:
    """The datagram with the times of JSON shifted by ``shift_ns``; those of packets are already."""
    payload = datagram.payload
    if datagram.is_json:
        payload = b"\n".join(_later(line, shift_ns) for line in payload.splitlines())
    return replace(datagram, t_ns=datagram.t_ns + shift_ns, payload=payload)


def _later(line: bytes, shift_ns: int) -> bytes:
    """A JSON object with its ``t_ns`` shifted; the rest is left as it is, also what is no JSON."""
    return _STAMP.sub(lambda found: found[1] + b"%d" % (int(found[2]) + shift_ns), line, count=1)


def _sent(captured: CapturedDatagram) -> ReplayDatagram:
    is_json = not captured.of_lidar and captured.payload.startswith(b"{")
    return ReplayDatagram(captured.t_ns, captured.source, captured.port, captured.payload, is_json)


def _samples(path: Path, port: int) -> Iterator[ReplayDatagram]:
    delay_ns = _SAMPLE_DELAY_NS[path.name]
    with path.open(encoding="utf-8-sig", newline="") as file:
        for row in csv.DictReader(file):
            known = {name: float(cell) for name, cell in row.items() if cell and name != "t_ns"}
            finite = {name: value for name, value in known.items() if np.isfinite(value)}
            t_ns = int(row["t_ns"])
            payload = json.dumps({"t_ns": t_ns, **finite}).encode()
            yield ReplayDatagram(t_ns + delay_ns, "127.0.0.1", port, payload, is_json=True)


def _wait_until(t_ns: int) -> None:
    left_ns = t_ns - time.time_ns()
    if left_ns > REPLAY.ahead_ns:
        time.sleep(left_ns / 1e9)


class _Senders:
    """A socket per sender, with an address of its own where that is possible."""

    def __init__(self, target: str) -> None:
        self._target = target
        self._sockets: dict[str, socket.socket] = {}
        self._closing = ExitStack()

    def __enter__(self) -> _Senders:
        return self

    def __exit__(self, *_: object) -> None:
        self._closing.close()

    def send(self, datagram: ReplayDatagram) -> None:
        """Send a datagram."""
        if datagram.source not in self._sockets:
            self._sockets[datagram.source] = self._open(datagram.source)
        try:
            self._sockets[datagram.source].sendto(datagram.payload, (self._target, datagram.port))
        except OSError as error:
            what = error.strerror or str(error)
            raise ConfigError(CodedText("replay-send", target=self._target, what=what)) from error

    def _open(self, source: str) -> socket.socket:
        udp = self._closing.enter_context(socket.socket(socket.AF_INET, socket.SOCK_DGRAM))
        if self._target.startswith("127."):
            udp.bind((loopback_address(source), 0))
        return udp
