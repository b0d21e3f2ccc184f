"""Files of GNSS receivers, written as the makers describe them."""

from __future__ import annotations

import struct
import zlib
from datetime import UTC, datetime

import numpy as np

BEGIN = datetime(2024, 5, 6, 7, 8, 9, tzinfo=UTC)
"""A Monday."""
BEGIN_NS = int(BEGIN.timestamp()) * 10**9
LEAP_S = 18
WEEK, WEEK_S = 2313, 86400 + 7 * 3600 + 8 * 60 + 9 + LEAP_S
"""The same time by GPS."""
PLACE = (49.2, 16.6, 250.25)
"""Latitude, longitude [deg], ellipsoidal height [m]; the geoid is 44.0 m above the ellipsoid."""
GEOID_M = 44.0
POS_HEAD = "% (lat/lon/height=WGS84/ellipsoidal,Q=1:fix,2:float)\n"
POS_TAIL = "Q  ns   sdn(m)   sde(m)   sdu(m)  sdne(m)  sdeu(m)  sdun(m) age(s)  ratio\n"
SD = "0.0200   0.0100   0.0300   0.0   0.0   0.0   0.00    9.9\n"


def pos(*rows: str, columns: str = "latitude(deg) longitude(deg) height(m)", time: str = "GPST"):
    """A solution of RTKLIB; each row is a time and three coordinates."""
    body = "".join(f"{row}   1  12   {SD}" for row in rows)
    return f"{POS_HEAD}%  {time}   {columns}   {POS_TAIL}{body}"


def pos_rows(count: int = 1) -> list[str]:
    """A walk to the north as dates of GPS time and degrees."""
    lat, lon, height = PLACE
    return [
        f"2024/05/06 07:08:{27 + k:02d}.250 {lat + 1e-6 * k:.9f} {lon:.9f} {height:.4f}"
        for k in range(count)
    ]


def exported(*rows: str, names: str, units: str) -> str:
    """An export of Inertial Explorer: names and units of columns, right-aligned."""
    return (
        f"""Project:     walk
Program:     Inertial Explorer Version 8.90.6611
Datum:       WGS84, (processing datum)

{names}
{units}
"""
        + "\n".join(rows)
        + "\n"
    )


def exported_rows(count: int = 1) -> str:
    """The walk of `pos_rows` with attitudes and standard deviations."""
    lat, lon, height = PLACE
    rows = [
        f"{WEEK:7d} {WEEK_S + k:13d}.250 {lat + 1e-6 * k:18.10f} {lon:18.10f} {height:10.3f} 1 "
        f"{1.5:9.4f} {-2.5:9.4f} {93.0:9.4f} {0.02:7.3f} {0.01:7.3f} {0.03:8.3f}"
        for k in range(count)
    ]
    return exported(
        *rows,
        names="   Week           GPSTime           Latitude          Longitude      H-Ell Q"
        "      Roll     Pitch   Heading SDNorth  SDEast SDHeight",
        units="(weeks)             (sec)              (deg)              (deg)        (m)  "
        "     (deg)     (deg)     (deg)     (m)     (m)      (m)",
    )


def nmea(body: str) -> bytes:
    """A sentence with its checksum."""
    found = 0
    for byte in body.encode():
        found ^= byte
    return f"${body}*{found:02X}\r\n".encode()


def gga(second: int = 0, quality: int = 4) -> bytes:
    """Altitude above sea level, and the separation."""
    height = f"{PLACE[2] - GEOID_M:.3f},M,{GEOID_M:.3f},M"
    place = "4912.0000000,N,01636.0000000,E"
    return nmea(f"GNGGA,0708{9 + second:02d}.00,{place},{quality},12,0.5,{height},1.0,0001")


def ubx(kind: bytes, payload: bytes) -> bytes:
    """A message with its checksum."""
    body = kind + struct.pack("<H", len(payload)) + payload
    a = b = 0
    for byte in body:
        a = (a + byte) % 256
        b = (b + a) % 256
    return b"\xb5\x62" + body + bytes((a, b))


def nav_pvt(second: int = 0, *, flags: int = 0x83, fix: int = 3, valid: int = 0x37) -> bytes:
    """A fix; hAcc 14 mm, vAcc 30 mm, 0.25 s before the full second."""
    lat, lon, height = PLACE
    time = BEGIN.timetuple()[:5]
    head = struct.pack("<IH5BB", 1000 * second, *time, BEGIN.second + second, valid)
    place = struct.pack("<4i", round(1e7 * lon), round(1e7 * lat), round(1e3 * height), 0)
    more = struct.pack("<Ii4B", 20, -250_000_000, fix, flags, 0, 20) + place
    return ubx(b"\x01\x07", head + more + struct.pack("<2I", 14, 30) + bytes(44))


def nav_hpposllh(second: int = 0) -> bytes:
    """The same place, 42e-9 degrees farther east and 0.4 mm higher."""
    lat, lon, height = PLACE
    place = struct.pack("<4i", round(1e7 * lon), round(1e7 * lat), round(1e3 * height), 0)
    head = struct.pack("<B2xBI", 0, 0, 1000 * second)
    return ubx(b"\x01\x14", head + place + struct.pack("<4b2I", 42, 0, 4, 0, 141, 300))


def novatel(number: int, body: bytes, *, time_status: int = 180) -> bytes:
    """A binary log with its long header."""
    of = struct.pack("<HBBHHBB", number, 0, 32, len(body), 0, 0, time_status)
    head = b"\xaa\x44\x12\x1c" + of + struct.pack("<HI", WEEK, 1000 * WEEK_S) + bytes(8)
    data = head + body
    return data + struct.pack("<I", zlib.crc32(data, 0xFFFFFFFF) ^ 0xFFFFFFFF)


def bestpos(kind: int = 50, **head: int) -> bytes:
    """σ of north 2 cm, of east 1 cm, of the height 3 cm."""
    lat, lon, height = PLACE
    place = struct.pack("<IIdddfI3f", 0, kind, lat, lon, height - GEOID_M, GEOID_M, 61, 0.02,
                        0.01, 0.03)  # fmt: skip
    return novatel(42, place + bytes(20), **head)


def inspvax(status: int = 3) -> bytes:
    """Roll 1°, pitch 2°, azimuth 3°."""
    lat, lon, height = PLACE
    body = struct.pack("<IIdddf6d", status, 56, lat, lon, height - GEOID_M, GEOID_M, 0, 0, 0,
                       1, 2, 3)  # fmt: skip
    return novatel(1465, body + struct.pack("<9fIH", 0.02, 0.01, 0.03, *[0.1] * 6, 0, 0))


def bestposa() -> bytes:
    """The same as `bestpos`, ASCII."""
    lat, lon, height = PLACE
    text = (
        f"BESTPOSA,COM1,0,85.0,FINESTEERING,{WEEK},{WEEK_S}.000,02000000,b1f6,32768;SOL_COMPUTED,"
        f"NARROW_INT,{lat},{lon},{height - GEOID_M},{GEOID_M},WGS84,0.02,0.01,0.03,"
        '"",1.0,0.0,20,18,18,18,00,00,00,11'
    )
    return f"#{text}*{zlib.crc32(text.encode(), 0xFFFFFFFF) ^ 0xFFFFFFFF:08x}\r\n".encode()


def sbet(count: int = 50, *, wander_rad: float = 0.02) -> bytes:
    """A trajectory at 200 Hz; heading 30° from north."""
    rows = np.zeros((count, 17))
    rows[:, 0] = WEEK_S + np.arange(count) / 200.0
    rows[:, 1:4] = np.deg2rad(PLACE[0]), np.deg2rad(PLACE[1]), PLACE[2]
    rows[:, 7], rows[:, 8] = np.deg2rad(1.0), np.deg2rad(2.0)
    rows[:, 9], rows[:, 10] = np.deg2rad(30.0) + wander_rad, wander_rad
    return rows.astype("<f8").tobytes()


def smrmsg(count: int = 3) -> bytes:
    """Accuracies at 1 Hz: north 2 cm, east 1 cm, down 3 cm."""
    rows = np.zeros((count, 10))
    rows[:, 0] = WEEK_S + np.arange(count) - 1.0
    rows[:, 1:4] = 0.02, 0.01, 0.03
    return rows.astype("<f8").tobytes()
