"""What a file of a GNSS receiver, or of its post-processing, holds."""

from __future__ import annotations

import re
from array import array
from dataclasses import dataclass, field, replace
from enum import IntEnum

import numpy as np

from recon4.geometry.se3 import Array
from recon4.model.gps_time import GPS_EPOCH_NS, is_absolute, utc_of_gps_ns
from recon4.model.samples import GnssSamples
from recon4.model.trajectory import Times
from recon4.units import DAY_NS, SECOND_NS

COLUMNS = ("lat_deg", "lon_deg", "height_m", "sd_e_m", "sd_n_m", "sd_u_m")
ATTITUDE = ("roll_deg", "pitch_deg", "heading_deg")


class Dating(IntEnum):
    """What the times of a file count from."""

    UTC = 0
    """1970: they are absolute."""
    DAY = DAY_NS
    """Midnight UTC of a day that the file does not tell."""
    WEEK = 7 * DAY_NS
    """Begin of a GPS week that the file does not tell, in GPS time."""


@dataclass(frozen=True, slots=True, eq=False)
class GnssFile:
    """Positions of a file."""

    samples: GnssSamples
    """Times as ``dating`` says."""
    format: str
    """Name of the format, and of its variant."""
    dating: Dating = Dating.UTC

    def dated(self, near_ns: int) -> GnssSamples:
        """The samples on UTC, on the day or in the week nearest to a time.

        Where that time is not absolute, the samples keep the times of the file.

        Args:
            near_ns: Of the recording [ns].
        """
        t_ns = self.samples.t_ns
        if self.dating is Dating.UTC or not is_absolute(near_ns):
            return self.samples
        in_week = self.dating is Dating.WEEK
        begin_ns = GPS_EPOCH_NS if in_week else 0
        middle_ns = int(t_ns[len(t_ns) // 2]) + begin_ns
        cycles = round((near_ns - middle_ns) / int(self.dating))
        whole = t_ns + (begin_ns + cycles * int(self.dating))
        return replace(self.samples, t_ns=utc_of_gps_ns(whole) if in_week else whole)


def week_ns(week: int, second_ns: int) -> int:
    """GPS time since 1970 [ns], not corrected for leap seconds, of a week and a time in it."""
    return GPS_EPOCH_NS + week * int(Dating.WEEK) + second_ns


def seconds_ns(seconds: re.Match[str]) -> int:
    """Nanoseconds of whole seconds and their decimals as text, which a float cannot hold."""
    return int(seconds[1]) * SECOND_NS + int((seconds[2] or "").ljust(9, "0")[:9])


@dataclass(slots=True)
class FixRows:
    """Fixes as they are read, one after the other."""

    t_ns: list[int] = field(default_factory=list)
    quality: list[int] = field(default_factory=list)
    _values: array[float] = field(default_factory=lambda: array("d"))

    def __len__(self) -> int:
        return len(self.t_ns)

    def add(
        self, t_ns: int, values: tuple[float, ...], quality: int, *, rpy_deg: tuple[float, ...] = ()
    ) -> None:
        """Add a fix.

        Args:
            t_ns: Its time.
            values: As `COLUMNS`: NaN = not given.
            quality: `GnssQuality`.
            rpy_deg: As `ATTITUDE`; empty = not measured.
        """
        self.t_ns.append(t_ns)
        self.quality.append(quality)
        self._values.extend((*values, *(rpy_deg or (np.nan,) * len(ATTITUDE))))

    def times(self, *, gps: bool) -> Times:
        """Their times [ns], (N,).

        Args:
            gps: Whether they are GPS time since 1970, to be made UTC.
        """
        t_ns = np.array(self.t_ns, np.int64)
        return utc_of_gps_ns(t_ns) if gps else t_ns

    def table(self) -> Array:
        """Their values as `COLUMNS` and `ATTITUDE`, (N, 9)."""
        return np.array(self._values, np.float64).reshape(len(self.t_ns), -1)

    def samples(self, *, gps: bool) -> GnssSamples:
        """All fixes; ``gps`` as in `times`."""
        return gnss_samples(self.times(gps=gps), self.table(), self.quality)


def gnss_samples(t_ns: Times, table: Array, quality: list[int]) -> GnssSamples:
    """Samples of columns as `COLUMNS` and `ATTITUDE`, (N, 9)."""
    return GnssSamples(
        t_ns,
        np.deg2rad(table[:, 0]),
        np.deg2rad(table[:, 1]),
        table[:, 2],
        table[:, 3:6],
        np.array(quality, np.uint8),
        np.deg2rad(table[:, 6:9]),
    )
