"""Velodyne position packets: NMEA sentences of the GPS receiver and the HDL-32E's inertial unit."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import UTC, date, datetime
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.model.derived_kinds import DerivedKind
from recon4.model.rig import Sensor
from recon4.model.samples import GnssQuality, GnssSamples, ImuSamples
from recon4.model.trajectory import Times
from recon4.recording.packets.family import PacketSamples
from recon4.recording.packets.hours import nearest_hour
from recon4.recording.packets.sensor_clock import SensorClock
from recon4.recording.packets.velodyne.models import ACCEL_UNIT_M_S2, GYRO_UNIT_RAD_S, POSITION_SIZE
from recon4.recording.packets.velodyne.tuning import POSITIONS
from recon4.recording.report import ImportReport
from recon4.recording.samples.heights import height_of_gga
from recon4.units import DAY_NS, HOUR_US, SECOND_NS


@dataclass(frozen=True, slots=True)
class NmeaFix:
    """Contents of one NMEA sentence."""

    utc_ns: int
    lat_deg: float
    lon_deg: float
    height_m: float
    """Ellipsoidal height, above sea level without a geoid separation; NaN = not given."""
    quality: GnssQuality


def nmea_text(payload: NDArray[np.uint8]) -> bytes:
    """The sentence in a position packet, up to its line end; empty if there is none."""
    return payload[206:].tobytes().split(b"\0")[0].split(b"\r")[0].strip()


def parse_fix(sentence: bytes, near_ns: int, report: ImportReport) -> NmeaFix | None:
    """Read an RMC or GGA sentence; None if it has no valid position.

    Counts ``nmea_no_fix``, ``nmea_damaged`` (checksum, fields, or no place on earth), and heights
    of unknown kind.

    Args:
        sentence: From ``$`` to the checksum.
        near_ns: A time within half a day [ns]: GGA tells the time of day only.
        report: Takes the counts.
    """
    import pynmeagps

    try:
        message: Any = pynmeagps.NMEAReader.parse(sentence + b"\r\n")
        fix = _fix(message, near_ns, report)
    except (
        pynmeagps.NMEAMessageError,
        pynmeagps.NMEAParseError,
        pynmeagps.NMEATypeError,
        AttributeError,
        TypeError,
        ValueError,
    ):
        report.count("nmea_damaged")
        return None
    report.count("nmea_no_fix", int(fix is None))
    if fix is not None and not is_on_earth(fix.lat_deg, fix.lon_deg):
        report.count("nmea_damaged")
        return None
    return fix


def date_of_zda(sentence: bytes) -> int | None:
    """Time of a ZDA sentence, which has the date that GGA sentences lack [ns]; None = damaged."""
    import pynmeagps

    try:
        message: Any = pynmeagps.NMEAReader.parse(sentence + b"\r\n")
        day = date(int(message.year), int(message.month), int(message.day))
        return _ns(datetime.combine(day, message.time, tzinfo=UTC))
    except (
        pynmeagps.NMEAMessageError,
        pynmeagps.NMEAParseError,
        pynmeagps.NMEATypeError,
        AttributeError,
        TypeError,
        ValueError,
    ):
        return None


def is_on_earth(lat_deg: float, lon_deg: float) -> bool:
    """Whether a latitude and longitude are those of a place [deg]; False if one is NaN."""
    return abs(lat_deg) <= 90.0 and abs(lon_deg) <= 360.0


def _fix(message: Any, near_ns: int, report: ImportReport) -> NmeaFix | None:
    if message.msgID == "RMC":
        if message.status != "A":
            return None
        time = datetime.combine(message.date, message.time, tzinfo=UTC)
        differential = getattr(message, "posMode", "A") == "D"
        quality = GnssQuality.DIFFERENTIAL if differential else GnssQuality.SINGLE
        return NmeaFix(_ns(time), float(message.lat), float(message.lon), float("nan"), quality)
    if message.msgID != "GGA" or message.quality == 0:
        return None
    of_day = _ns(datetime.combine(datetime(1970, 1, 1), message.time, tzinfo=UTC))
    utc_ns = of_day + round((near_ns - of_day) / DAY_NS) * DAY_NS
    height_m = height_of_gga(float(message.alt), message.sep, report)
    known = int(message.quality) in set(GnssQuality)
    quality = GnssQuality(message.quality) if known else GnssQuality.SINGLE
    return NmeaFix(utc_ns, float(message.lat), float(message.lon), height_m, quality)


def _ns(time: datetime) -> int:
    since = time - datetime(1970, 1, 1, tzinfo=UTC)
    return (since.days * 86400 + since.seconds) * SECOND_NS + since.microseconds * 1000


def utc_offset_ns(t_arrival_ns: Times, payloads: NDArray[np.uint8]) -> int | None:
    """UTC minus time of arrival [ns] if GPS drives the sensor's clock, else None.

    It does if valid sentences are no older than their packets' stamps allow: the stamp, taken in
    the hour of the sentence, lies 0 to 2.5 s after it. Old firmware has no PPS flag to ask.

    Args:
        t_arrival_ns: Times of arrival of position packets [ns], (N,).
        payloads: The packets, (N, 512).
    """
    offsets_ns, others = list[int](), 0
    for row in np.flatnonzero(_stamps(payloads) < HOUR_US)[: POSITIONS.judged]:
        sentence = nmea_text(payloads[row])
        arrival = int(t_arrival_ns[row])
        fix = parse_fix(sentence, arrival, ImportReport()) if sentence else None
        if fix is None:
            continue
        stamp = int(nearest_hour(_stamps(payloads[row : row + 1]), fix.utc_ns)[0])
        if 0 <= stamp - fix.utc_ns < POSITIONS.longest_age_ns:
            offsets_ns.append(stamp - arrival)
        else:
            others += 1
    return offsets_ns[0] if len(offsets_ns) > others else None


def _stamps(payloads: NDArray[np.uint8]) -> NDArray[np.uint32]:
    return np.ascontiguousarray(payloads[:, 198:202]).view("<u4")[:, 0]


class PositionDecoder:
    """Turns the position packets of one sensor into samples; one object a sensor."""

    def __init__(self, sensor: Sensor, *, clock: SensorClock, report: ImportReport) -> None:
        """Start with nothing seen.

        Args:
            sensor: For its name.
            clock: The clock of its data packets.
            report: Takes counts and remarks.
        """
        self._clock, self._report = clock, report
        self._name = sensor.name
        self._sentence = b""
        self._newest_ns = self._gnss_ns = np.iinfo(np.int64).min

    def push(self, t_arrival_ns: Times, payloads: NDArray[np.uint8]) -> PacketSamples:
        """Samples of position packets, in order; a repeated sentence counts once.

        Counts ``positions``, ``positions_wrong_time``, ``positions_out_of_order``,
        ``positions_duplicate``, ``imu_samples``, ``gnss_samples``, ``nmea_damaged`` and
        ``nmea_no_fix``.

        Args:
            t_arrival_ns: Times of arrival [ns], (N,).
            payloads: The packets, (N, 512).
        """
        assert payloads.shape[1:] == (POSITION_SIZE,)
        self._report.count("positions", len(payloads))
        t_ns, timed = self._clock.at(np.asarray(t_arrival_ns), _stamps(payloads))
        self._report.count("positions_wrong_time", int((~timed).sum()))
        t_ns, payloads = t_ns[timed], payloads[timed]
        return PacketSamples(self._imu(t_ns, payloads), self._gnss(t_ns, payloads))

    def _imu(self, t_ns: Times, payloads: NDArray[np.uint8]) -> ImuSamples | None:
        """Inertial samples: three chips, each a gyroscope and two accelerometers.

        Words are 12 bit two's complement: gyroscope, temperature, accelerometers X and Y of chips
        1 to 3 from byte 14. Gyroscopes 1, 2, 3 turn about +x, +y, +z of the sensor; X1 and X2 point
        along +z, Y1 and -X3 along +y, -Y2 and -Y3 along +x (found by comparing them with the motion
        and the vibration of a car that the lasers see; the manual shows it in a figure only).
        """
        words = np.ascontiguousarray(payloads[:, 14:38]).view("<u2").reshape(-1, 3, 4)
        newest = np.maximum.accumulate(np.concatenate([[self._newest_ns], t_ns[:-1]]))
        later, again = t_ns > newest, t_ns == newest
        kept = later & words.any(axis=(1, 2))
        self._report.count("positions_duplicate", int(again.sum()))
        self._report.count("positions_out_of_order", int((t_ns < newest).sum()))
        self._newest_ns = int(np.max(t_ns, initial=self._newest_ns))
        if not kept.any():
            return None
        value = ((words[kept].astype(np.int64) & 0xFFF) + 2048) % 4096 - 2048
        x, y = value[:, :, 2], value[:, :, 3]
        accel = np.column_stack([-y[:, 1] - y[:, 2], y[:, 0] - x[:, 2], x[:, 0] + x[:, 1]]) / 2
        self._report.count("imu_samples", int(kept.sum()))
        self._report.derive(DerivedKind.IMU_UNCALIBRATED, sensor=self._name)
        return ImuSamples(
            t_ns=t_ns[kept],
            gyro_rad_s=value[:, :, 0] * GYRO_UNIT_RAD_S,
            accel_m_s2=accel * ACCEL_UNIT_M_S2,
        )

    def _gnss(self, t_ns: Times, payloads: NDArray[np.uint8]) -> GnssSamples | None:
        fixes: list[tuple[int, NmeaFix]] = []
        for row, payload in enumerate(payloads):
            sentence = nmea_text(payload)
            if not sentence or sentence == self._sentence:
                continue
            self._sentence = sentence
            fix = parse_fix(sentence, int(t_ns[row]), self._report)
            if fix is None:
                continue
            sample_ns = fix.utc_ns if self._clock.is_utc else int(t_ns[row])
            if sample_ns > self._gnss_ns:
                self._gnss_ns = sample_ns
                fixes.append((sample_ns, fix))
        if not fixes:
            return None
        self._report.count("gnss_samples", len(fixes))
        if not self._clock.is_utc:
            self._report.derive(DerivedKind.POSITIONS_BY_ARRIVAL, sensor=self._name)
        return _samples(fixes)


def _samples(fixes: list[tuple[int, NmeaFix]]) -> GnssSamples:
    count = len(fixes)
    return GnssSamples(
        t_ns=np.array([t for t, _ in fixes], dtype=np.int64),
        lat_rad=np.deg2rad([fix.lat_deg for _, fix in fixes]),
        lon_rad=np.deg2rad([fix.lon_deg for _, fix in fixes]),
        height_m=np.array([fix.height_m for _, fix in fixes]),
        sd_enu_m=np.full((count, 3), np.nan),
        quality=np.array([fix.quality for _, fix in fixes], dtype=np.uint8),
        rpy_ned_rad=np.full((count, 3), np.nan),
    )
