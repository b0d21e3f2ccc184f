"""Opens the UDP ports of a rig and receives datagrams."""

from __future__ import annotations

import errno
import socket
import struct
from dataclasses import dataclass
from ipaddress import IPv4Address

from recon4.errors import ConfigError
from recon4.live.recorder.capture_file import Datagram
from recon4.live.recorder.serial_port import check_serial_device
from recon4.live.recorder.tuning import PORTS
from recon4.locales.coded import CodedText
from recon4.model.lidars import lidar_model
from recon4.model.rig import Rig, Sensor
from recon4.model.serial_device import parse_serial_device

_SO_TIMESTAMPNS = getattr(socket, "SO_TIMESTAMPNS", 35)
_SO_RXQ_OVFL = 40
_HINTS = {
    errno.EADDRINUSE: "hint-port-in-use",
    errno.EACCES: "hint-port-low",
    errno.EADDRNOTAVAIL: "hint-no-address",
}
_TIMESPEC = struct.Struct("@qq")


@dataclass(slots=True)
class Port:
    """One open port."""

    number: int
    expected: str
    """Names of the devices that send there."""
    socket: socket.socket
    kernel_drops: int = 0
    """Datagrams the kernel dropped because the buffer was full."""

    def receive(self) -> Datagram | None:
        """The next datagram; None if none is waiting."""
        try:
            payload, ancillary, _, sender = self.socket.recvmsg(PORTS.longest, 128)
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
    """Port number -> names of the devices of a rig that send there."""
    ports: dict[int, list[str]] = {}
    for sensor in rig.sensors:
        ports.setdefault(sensor.port, []).append(sensor.name)
        for number in lidar_model(sensor.model).sample_ports if sensor.kind == "lidar" else ():
            ports.setdefault(number, []).append(f"{sensor.name} (other packets)")
    for number, name in ((rig.imu_port, "IMU"), (rig.gnss_port, "GNSS")):
        if number:
            ports.setdefault(number, []).append(name)
    return {number: ", ".join(names) for number, names in ports.items()}


def check_sources(rig: Rig) -> None:
    """Check that the datagrams of a rig can be received and assigned to its sensors.

    Raises:
        ConfigError: If the kinds of sensors cannot be mapped together, two sensors use one port
            without different addresses, an address is invalid, or the serial line of the receiver
            is none, is a console, or has no port.
    """
    _check_kinds(rig)
    if rig.gnss_serial:
        check_serial_device(parse_serial_device(rig.gnss_serial))
        if not rig.gnss_port:
            raise ConfigError(CodedText("gnss-port"))
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
                CodedText("capture-port-shared", rig=rig.name, names=names, port=port)
            )


def _check_kinds(rig: Rig) -> None:
    """LiDARs alone, or a 2-D laser with or without a profiler."""
    kinds = [sensor.kind for sensor in rig.sensors if sensor.enabled]
    if set(kinds) <= {"lidar"}:
        return
    with_laser = set(kinds) <= {"laser2d", "profiler"} and kinds.count("laser2d") == 1
    if with_laser and kinds.count("profiler") <= 1:
        return
    names = ", ".join(f"{s.name} (kind {s.kind})" for s in rig.sensors if s.enabled)
    raise ConfigError(CodedText("capture-kinds", rig=rig.name, names=names))


def _check_address(sensor: Sensor) -> None:
    try:
        IPv4Address(sensor.address)
    except ValueError as error:
        raise ConfigError(
            CodedText("capture-address", sensor=sensor.name, got=f"{sensor.address!r}")
        ) from error


def open_ports(rig: Rig, *, address: str = "0.0.0.0") -> list[Port]:
    """Open all ports of a rig; the kernel timestamps datagrams and counts the dropped ones.

    Args:
        rig: Sensors, IMU and GNSS receiver.
        address: Address of the network card to listen on; all cards by default, because sensors
            broadcast.

    Raises:
        ConfigError: If a port is in use or may not be opened.
    """
    opened: list[Port] = []
    try:
        for number, expected in wanted_ports(rig).items():
            opened.append(Port(number, expected, _open(address, number)))
    except OSError as error:
        for port in opened:
            port.socket.close()
        known = _HINTS.get(error.errno or 0)
        hint = CodedText(known) if known else ""
        raise ConfigError(
            CodedText(
                "capture-port-taken",
                port=number,
                expected=expected,
                address=address,
                why=f"{error.strerror}",
                hint=hint,
            )
        ) from error
    return opened


def _open(address: str, number: int) -> socket.socket:
    udp = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    try:
        udp.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, PORTS.buffer_bytes)
        udp.setsockopt(socket.SOL_SOCKET, _SO_TIMESTAMPNS, 1)
        udp.setsockopt(socket.SOL_SOCKET, _SO_RXQ_OVFL, 1)
        udp.setblocking(False)
        udp.bind((address, number))
    except OSError:
        udp.close()
        raise
    return udp
