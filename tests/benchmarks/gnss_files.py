"""How far solutions of receivers lie from the truth, by the quality that they state.

    python -m tests.benchmarks.gnss_files FOLDER

FOLDER is ``gnss/rtklib`` of the real recordings.
"""

from __future__ import annotations

import gzip
import sys
import tempfile
from pathlib import Path

import numpy as np

from recon4.geometry.se3 import Array
from recon4.model.gps_time import GPS_EPOCH_NS, utc_of_gps_ns
from recon4.model.samples import GnssQuality, GnssSamples
from recon4.recording.gnss.files import read_gnss
from recon4.units import EARTH_RADIUS_M

_WEEK_NS = 7 * 86_400 * 10**9
_MARKERS = (
    ("2", "16:49:00", "16:56:00"),
    ("42", "16:58:00", "17:01:00"),
    ("27", "17:03:00", "17:08:00"),
    ("413", "17:15:00", "17:19:00"),
    ("50", "17:20:50", "17:25:20"),
    ("23", "17:26:10", "17:30:30"),
    ("2", "17:32:00", "17:36:50"),
)
"""Marker, and the times (UTC) between which the rover stood on it, as the surveyors noted them."""


def _off_m(fixes: GnssSamples, truth: Array) -> tuple[Array, Array]:
    """Horizontal and vertical distances from latitude, longitude [deg], height [m], (3, …)."""
    lat, lon = np.rad2deg(fixes.lat_rad), np.rad2deg(fixes.lon_rad)
    north = np.deg2rad(lat - truth[0]) * EARTH_RADIUS_M
    east = np.deg2rad(lon - truth[1]) * EARTH_RADIUS_M * np.cos(fixes.lat_rad)
    return np.hypot(north, east), np.abs(fixes.height_m - truth[2])


def _drive(folder: Path) -> None:
    """A car between houses against its reference."""
    fixes = read_gnss(folder / "rover_rtk.pos").samples
    with gzip.open(folder / "reference.csv.gz", "rt") as file:
        truth = np.genfromtxt(file, delimiter=",", skip_header=1, usecols=range(5))
    of_week_ns = np.rint(truth[:, 0] * 10.0).astype(np.int64) * 10**8
    t_ns = utc_of_gps_ns(GPS_EPOCH_NS + truth[:, 1].astype(np.int64) * _WEEK_NS + of_week_ns)
    row = np.searchsorted(t_ns, fixes.t_ns - 50_000_000)
    together = np.abs(t_ns[row] - fixes.t_ns) < 10_000_000
    flat_m, up_m = _off_m(fixes, truth[row, 2:5].T)
    stated_m = np.linalg.norm(fixes.sd_enu_m[:, :2], axis=1)
    for quality in (GnssQuality.RTK_FIXED, GnssQuality.RTK_FLOAT):
        own = together & (fixes.quality == quality)
        print(
            f"{quality.name}: {own.sum()} fixes, horizontal {_percentiles(flat_m[own])}, vertical "
            f"{_percentiles(up_m[own])}, stated {np.median(stated_m[own]):.4f} m; "
            f"{100 * np.mean(flat_m[own] < 3 * stated_m[own]):.0f} % within 3 σ"
        )


def _survey(folder: Path) -> None:
    """A rover that was put on markers."""
    with tempfile.TemporaryDirectory() as temporary:
        solution = Path(temporary) / "rover.pos"
        packed = next(folder.glob("*.pos.gz"))
        solution.write_bytes(gzip.decompress(packed.read_bytes()))
        fixes = read_gnss(solution).samples
    lines = (folder / "gcp.csv").read_text("utf-8").split()[1:]
    places = {line.split(",")[0]: list(map(float, line.split(",")[1:])) for line in lines}
    for name, begin, end in _MARKERS:
        span_ns = np.array([f"2019-08-24T{one}" for one in (begin, end)], "datetime64[ns]")
        first, last = span_ns.astype(np.int64)
        here = fixes.take((fixes.t_ns >= first) & (fixes.t_ns <= last))
        lon, lat, height = places[name]
        flat_m, up_m = _off_m(here, np.array([lat, lon, height]))
        fixed = here.quality == GnssQuality.RTK_FIXED
        said = ""
        if fixed.any():
            said = f", {np.median(flat_m[fixed]):.3f} m, {np.median(up_m[fixed]):.3f} m up"
        print(
            f"marker {name}: {len(here)} fixes, median {np.median(flat_m):.3f} m; fixed: "
            f"{fixed.sum()}{said}"
        )


def _percentiles(values_m: Array) -> str:
    usual, most = np.percentile(values_m, [50, 95])
    return f"{usual:.3f} m (95 %: {most:.2f} m)"


def main(folder: Path) -> None:
    """Print the figures of both sets."""
    _drive(folder / "urban-kinematic")
    _survey(folder / "marker-survey")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
