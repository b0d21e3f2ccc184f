"""The UDP ports of a rig, and what comes in on them."""

from __future__ import annotations

import errno
import socket
import struct
from dataclasses import dataclass
from ipaddress import IPv4Address

from recon4.errors import ConfigError
from recon4.live.recorder.capture_file import Datagram
from recon4.live.recorder.serial_line import parse_device
from recon4.model.rig import Rig, Sensor

POSITION_PORT = 8308
"""Velodyne's position packets."""
_BUFFER_BYTES = 16 << 20
"""Asked of the kernel; half a dozen seconds of two VLP-16."""
_SO_TIMESTAMPNS = getattr(socket, "SO_TIMESTAMPNS", 35)
_SO_RXQ_OVFL = 40
_LONGEST = 9000
_HINTS = {
    errno.EADDRINUSE: "; does another recorder run, or VeloView?",
    errno.EACCES: "; ports below 1024 are the administrator's: let the sensors send to others",
    errno.EADDRNOTAVAIL: "; no network card of this computer has that address at the moment",
}
_TIMESPEC = struct.Struct("@qq")


@dataclass(slots=True)
class Port:
    """One open port."""

    number: int
    words: str
    """What is expected there."""
    socket: socket.socket
    kernel_drops: int = 0
    """Datagrams the kernel threw away because nobody fetched them in time."""

    def receive(self) -> Datagram | None:
        """The next datagram; None if there is none at the moment."""
        try:
            payload, ancillary, _, sender = self.socket.recvmsg(_LONGEST, 128)
        except BlockingIOError:
            return None
        t_ns = 0
        for level, kind, data in ancillary:
            if level == socket.SOL_SOCKET and kind == _SO_TIMESTAMPNS:
                seconds, nanoseconds = _TIMESPEC.unpack(data[: _TIMESPEC.size])
                t_ns = seconds * 1_000_000_000 + nanoseconds
            elif level == socket.SOL_SOCKET and kind == _SO_RXQ_OVFL:
                self.kernel_drops = int.from_bytes(data[:4], "little")
        return Datagram(t_ns, sender[:2], self.number, payload)


def wanted_ports(rig: Rig) -> dict[int, str]:
    """Ports of a rig with what is expected there."""
    ports: dict[int, list[str]] = {}
    for sensor in rig.sensors:
        ports.setdefault(sensor.port, []).append(sensor.name)
    ports.setdefault(POSITION_PORT, []).append("positions")
    for number, words in ((rig.imu_port, "IMU"), (rig.gnss_port, "GNSS")):
        if number:
            ports.setdefault(number, []).append(words)
    return {number: ", ".join(words) for number, words in ports.items()}


def check_sources(rig: Rig) -> None:
    """Refuse a rig that cannot be listened to.

    Raises:
        ConfigError: If two LiDARs share a port and have no addresses of their own, an address is
            none, or the serial line of the receiver is none or has no port.
    """
    if rig.gnss_serial:
        parse_device(rig.gnss_serial)
        if not rig.gnss_port:
            raise ConfigError("gnss: serial needs a port: its sentences are kept as if sent to it")
    ports: dict[int, list[Sensor]] = {}
    for sensor in rig.sensors:
        ports.setdefault(sensor.port, []).append(sensor)
        if sensor.address:
            _check_address(sensor)
    for port, sensors in ports.items():
        addresses = {sensor.address for sensor in sensors}
        if len(sensors) > 1 and (len(addresses) < len(sensors) or "" in addresses):
            names = ", ".join(sensor.name for sensor in sensors)
            raise ConfigError(
                f"rig {rig.name}: {names} all send to port {port}: give each its address = "
                '"…" in the rig file, or a port of its own'
            )


def _check_address(sensor: Sensor) -> None:
    try:
        IPv4Address(sensor.address)
    except ValueError as error:
        raise ConfigError(
            f"{sensor.name}: address must be like 192.168.1.201, got {sensor.address!r}"
        ) from error


def open_ports(rig: Rig, *, address: str = "0.0.0.0") -> list[Port]:
    """Open all ports of a rig; the kernel stamps and counts what it drops.

    Args:
        rig: Its sensors, IMU and GNSS receiver.
        address: Of the network card to listen on; sensors send to everybody, so all by default.

    Raises:
        ConfigError: If a port is in use or may not be opened.
    """
    opened: list[Port] = []
    try:
        for number, words in wanted_ports(rig).items():
            opened.append(Port(number, words, _open(address, number)))
    except OSError as error:
        for port in opened:
            port.socket.close()
        hint = _HINTS.get(error.errno or 0, "")
        raise ConfigError(
            f"UDP port {number} ({words}) cannot be opened on {address}: {error.strerror}{hint}"
        ) from error
    return opened


def _open(address: str, number: int) -> socket.socket:
    udp = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    try:
        udp.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, _BUFFER_BYTES)
        udp.setsockopt(socket.SOL_SOCKET, _SO_TIMESTAMPNS, 1)
        udp.setsockopt(socket.SOL_SOCKET, _SO_RXQ_OVFL, 1)
        udp.setblocking(False)
        udp.bind((address, number))
    except OSError:
        udp.close()
        raise
    return udp
