"""Name and baud rate of a serial GNSS receiver, as a rig file gives them."""

from __future__ import annotations

import re
from dataclasses import dataclass

from recon4.errors import ConfigError
from recon4.locales.coded import CodedText
from recon4.model.limits import RIG_LIMITS

_NAME = re.compile(
    r"/dev/("
    r"tty[A-Z]\w{0,30}"  # ttyS0, ttyUSB0, ttyACM0, ttyAMA0, ttyTHS1; not tty, tty1, ttyp0
    r"|ttymxc\d{1,2}|rfcomm\d{1,3}|serial\d{1,2}"
    r"|(gps|gnss)[\w-]{0,30}"  # links that udev rules of users make
    r"|serial/by-(id|path)/(?!\.{1,2}$)[\w#+.:=@\\-]{1,250}"
    r"|(cu|tty)\.[\w.-]{1,100}"  # macOS
    r")",
    re.ASCII,
)


@dataclass(frozen=True, slots=True)
class SerialDevice:
    """A serial device that a rig names; whether it is one is known where it is opened."""

    path: str
    baud: int = 9600
    """The rate of NMEA 0183."""


def parse_serial_device(text: str) -> SerialDevice:
    """Split device and baud rate: ``/dev/ttyUSB0:115200``; the default rate is 9600.

    Raises:
        ConfigError: If the name is not that of a serial device, or the rate is not a number.
    """
    name, colon, rate = text.rpartition(":")
    has_rate = bool(colon) and re.fullmatch("[0-9]{1,8}", rate) is not None
    device = SerialDevice(name, int(rate)) if has_rate else SerialDevice(text)
    if not _NAME.fullmatch(device.path) or not 0 < device.baud < RIG_LIMITS.baud:
        raise ConfigError(CodedText("serial-form", got=f"{text!r:.200}"))
    return device
