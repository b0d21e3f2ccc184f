"""IMU and GNSS samples in UDP datagrams: NMEA sentences, or JSON with the names of the CSV columns.

    {"t_ns": 1790000000000000000, "gx_rad_s": 0.01, "gy_rad_s": 0.0, "gz_rad_s": -0.2,
     "ax_m_s2": 0.1, "ay_m_s2": 0.0, "az_m_s2": 9.8}
    {"t_ns": …, "lat_deg": 49.2, "lon_deg": 16.6, "ellipsoidal_height_m": 250.1, "sd_e_m": 0.02}

One object a line, one or more lines a datagram. ``t_ns`` is absolute; without it the time of
arrival counts: in UTC, independent of the recorder's clock, where GPS drives a LiDAR. What is
missing is not measured.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from recon4.model.derived_kinds import DerivedKind
from recon4.model.samples import GnssSamples, ImuSamples
from recon4.recording.clocks.stamps import StampClock
from recon4.recording.packets.velodyne.position_packets import is_on_earth, parse_fix
from recon4.recording.report import ImportReport
from recon4.recording.samples.csv_files import GNSS_HEADER, IMU_HEADER
from recon4.recording.samples.heights import STATED_COLUMNS, height_above_ellipsoid
from recon4.recording.samples.tuning import CARRIED_ON, NMEA

_GNSS_KEYS = (*GNSS_HEADER, *STATED_COLUMNS)


@dataclass(frozen=True, slots=True)
class _Sample:
    """A decoded sample."""

    kind: str
    """``imu`` or ``gnss``."""
    t_ns: int
    values: list[float]
    lag_ns: int | None
    """Time of arrival minus stamp [ns]; None = it has no stamp of its own."""


@dataclass(slots=True)
class SampleDecoder:
    """Converts datagrams of one recording to samples in order of time; counts the others."""

    report: ImportReport
    _last_ns: dict[str, int] = field(default_factory=dict)
    _last_imu: list[float] = field(default_factory=list)
    _stamps: dict[str, StampClock] = field(default_factory=dict)
    _arrived_ns: dict[str, int] = field(default_factory=dict)
    """Kind -> arrival of its last sample [ns]."""
    _sd: tuple[int, list[float]] = (0, [math.nan] * 3)
    """Time of arrival [ns] of the last GST sentence, and its standard deviations e, n, u [m]."""
    _gga_ns: int = -NMEA.lasts_ns
    """Time of arrival of the last GGA sentence [ns]."""

    def push(
        self, t_arrival_ns: list[int], texts: list[bytes]
    ) -> tuple[ImuSamples | None, GnssSamples | None]:
        """Decode the samples of datagrams.

        Counts ``sample_datagrams``, ``imu_samples``, ``gnss_samples``, ``samples_damaged``,
        ``samples_out_of_order``, ``imu_copies``, ``gnss_copies``, ``nmea_damaged`` and
        ``nmea_no_fix``.

        Args:
            t_arrival_ns: Times of arrival [ns].
            texts: The payloads.
        """
        rows: dict[str, list[list[float]]] = {"imu": [], "gnss": []}
        times: dict[str, list[int]] = {"imu": [], "gnss": []}
        ahead_ns = self.report.utc_ahead_ns
        self.report.count("sample_datagrams", len(texts))
        samples = [
            sample
            for arrival_ns, text in zip(t_arrival_ns, texts, strict=True)
            for sample in self._lines(arrival_ns + ahead_ns, text)
        ]
        self._learn_clocks(samples)
        for sample in samples:
            self._find_set_back(sample)
            if not self._is_of_the_clock(sample):
                self.report.count("samples_damaged")
            elif sample.t_ns <= (last_ns := self._last_ns.get(sample.kind, -1)):
                same = sample.kind == "gnss" or sample.values == self._last_imu
                if sample.t_ns == last_ns and same:
                    self.report.count(f"{sample.kind}_copies")
                else:
                    self.report.count("samples_out_of_order")
            else:
                self._last_ns[sample.kind] = sample.t_ns
                if sample.kind == "imu":
                    self._last_imu = sample.values
                times[sample.kind].append(sample.t_ns)
                rows[sample.kind].append(sample.values)
        for kind in rows:
            self.report.count(f"{kind}_samples", len(rows[kind]))
        return _imu(times["imu"], rows["imu"]), _gnss(times["gnss"], rows["gnss"])

    def _learn_clocks(self, samples: list[_Sample]) -> None:
        """Usual lag of the first stamps: the first one alone may be wrong."""
        for kind in {sample.kind for sample in samples} - self._stamps.keys():
            head = [
                (sample.t_ns, sample.t_ns + sample.lag_ns)
                for sample in samples
                if sample.kind == kind and sample.lag_ns is not None
            ]
            if head:
                self._stamps[kind] = StampClock(head[:3] if len(head) >= 3 else head[:1])

    def _find_set_back(self, sample: _Sample) -> None:
        """Begin again where the recorder's clock was set back: a sample arrives before the last."""
        arrival_ns = sample.t_ns + (sample.lag_ns or 0)
        last_ns = self._arrived_ns.get(sample.kind, arrival_ns)
        self._arrived_ns[sample.kind] = arrival_ns
        if arrival_ns < last_ns - CARRIED_ON.least_ns:
            self._last_ns.pop(sample.kind, None)

    def _is_of_the_clock(self, sample: _Sample) -> bool:
        """Whether the stamp of a sample is in its place among the others."""
        if sample.lag_ns is None:
            return True
        clock = self._stamps[sample.kind]
        if not clock.is_sound(sample.t_ns, sample.t_ns + sample.lag_ns):
            return False
        if clock.was_set:
            self._last_ns.pop(sample.kind, None)
        self.report.note_lag(sample.kind.upper(), sample.lag_ns)
        return True

    def _lines(self, arrival_ns: int, text: bytes) -> Iterator[_Sample]:
        for line in text.splitlines():
            line = line.strip(b"\0 \t")
            if line.startswith(b"$"):
                yield from self._nmea(arrival_ns, line)
            elif line:
                yield from self._json(arrival_ns, line)

    def _json(self, arrival_ns: int, line: bytes) -> Iterator[_Sample]:
        try:
            record = json.loads(line)
            t_ns = int(record.get("t_ns", arrival_ns))
            kind, names = ("imu", IMU_HEADER) if IMU_HEADER[1] in record else ("gnss", _GNSS_KEYS)
            values = [float(record.get(name, math.nan)) for name in names[1:]]
        except (ValueError, TypeError, AttributeError, OverflowError, RecursionError):
            self.report.count("samples_damaged")
            return
        sound = all(map(math.isfinite, values[:3])) if kind == "imu" else is_on_earth(*values[:2])
        if not sound or not 0 < t_ns < 1 << 62:
            self.report.count("samples_damaged")
            return
        if kind == "gnss":
            columns = {name: np.array([x]) for name, x in zip(names[1:], values, strict=True)}
            values[2] = float(height_above_ellipsoid(columns, self.report)[0])
            values = values[: len(GNSS_HEADER) - 1]
        yield _Sample(kind, t_ns, values, arrival_ns - t_ns if "t_ns" in record else None)

    def _nmea(self, arrival_ns: int, line: bytes) -> Iterator[_Sample]:
        if line[3:6] == b"GST":
            self._sd = arrival_ns, gst_sd_enu_m(line)
            return
        if line[3:6] not in (b"GGA", b"RMC"):
            return
        if line[3:6] == b"GGA":
            self._gga_ns = arrival_ns
        elif 0 <= arrival_ns - self._gga_ns < NMEA.lasts_ns:
            return
        fix = parse_fix(line, arrival_ns, self.report)
        if fix is None:
            return
        t_ns = fix.utc_ns
        if abs(t_ns - arrival_ns) > NMEA.utc_within_ns:
            t_ns = arrival_ns
            self.report.derive(DerivedKind.POSITIONS_BY_ARRIVAL, nmea=True)
        fresh = arrival_ns - self._sd[0] < NMEA.lasts_ns
        sd = self._sd[1] if fresh else [math.nan] * 3
        place = [fix.lat_deg, fix.lon_deg, fix.height_m]
        values = [*place, *sd, float(fix.quality), *([math.nan] * 3)]
        yield _Sample("gnss", t_ns, values, None)


def gst_sd_enu_m(line: bytes) -> list[float]:
    """Standard deviations east, north, up [m] of a GST sentence; NaN where it has none."""
    cells = line.split(b"*")[0].split(b",")[6:9]
    try:
        north, east, up = (float(cell) for cell in cells)
    except ValueError:
        return [math.nan] * 3
    return [east, north, up]


def _imu(t_ns: list[int], rows: list[list[float]]) -> ImuSamples | None:
    if not rows:
        return None
    table = np.array(rows)
    return ImuSamples(np.array(t_ns, dtype=np.int64), table[:, :3], table[:, 3:])


def _gnss(t_ns: list[int], rows: list[list[float]]) -> GnssSamples | None:
    if not rows:
        return None
    table = np.array(rows)
    quality = np.nan_to_num(table[:, 6], nan=1.0).clip(0, 255).astype(np.uint8)
    return GnssSamples(
        t_ns=np.array(t_ns, dtype=np.int64),
        lat_rad=np.deg2rad(table[:, 0]),
        lon_rad=np.deg2rad(table[:, 1]),
        height_m=table[:, 2],
        sd_enu_m=table[:, 3:6],
        quality=quality,
        rpy_ned_rad=np.deg2rad(table[:, 7:10]),
    )
