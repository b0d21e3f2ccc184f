"""A GNSS/INS receiver on the backpack, outdoors."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from recon4.geometry.se3 import Array
from recon4.model.rig import Rig
from recon4.model.samples import GnssQuality, GnssSamples
from recon4.model.trajectory import Times
from recon4.simulation.walk import Walk
from recon4.simulation.world import WorldOrigin
from recon4.units import SECOND_NS


@dataclass(frozen=True, slots=True, kw_only=True)
class GnssModel:
    """Errors of an RTK receiver with two antennas and an INS (requirements A1); zeros: perfect."""

    RATE_HZ: ClassVar[int] = 10
    """Of the samples."""
    sd_enu_m: tuple[float, float, float] = (0.008, 0.008, 0.015)
    """White noise of a fixed solution east, north, up [m]."""
    slow_sd_enu_m: tuple[float, float, float] = (0.015, 0.015, 0.03)
    """Error that changes within a minute: atmosphere, multipath [m]."""
    slow_s: float = 60.0
    """Correlation time of it [s]."""
    outages_per_minute: float = 0.7
    """How often the fix is lost for 2 to 8 s: float (0.4 m) or single (2 m) solutions."""
    outlier_ratio: float = 0.003
    """Ratio of outliers: samples wrong by about 1 m but reported as fixed."""
    roll_pitch_sd_deg: float = 0.03
    heading_sd_deg: float = 0.06

    @staticmethod
    def perfect() -> GnssModel:
        """No errors."""
        return GnssModel(
            sd_enu_m=(0.0, 0.0, 0.0),
            slow_sd_enu_m=(0.0, 0.0, 0.0),
            outages_per_minute=0.0,
            outlier_ratio=0.0,
            roll_pitch_sd_deg=0.0,
            heading_sd_deg=0.0,
        )


def simulate_gnss(
    walk: Walk,
    rig: Rig,
    model: GnssModel,
    *,
    origin: WorldOrigin,
    rng: np.random.Generator,
) -> GnssSamples:
    """Antenna positions and attitudes at 10 Hz over the whole walk; times since its start."""
    period_ns = SECOND_NS // model.RATE_HZ
    t_ns = np.arange(int(walk.seconds * model.RATE_HZ) + 1, dtype=np.int64) * period_ns
    T_map_body = walk.poses(1e-9 * t_ns)
    p_map = T_map_body @ np.broadcast_to(rig.p_body_antenna, (len(t_ns), 3))
    quality, sd = _quality(t_ns, model, rng)
    error = sd * rng.standard_normal(p_map.shape)
    error += np.array(model.slow_sd_enu_m) * _slow(len(t_ns), model, rng)
    outlier = rng.random(len(t_ns)) < model.outlier_ratio
    error[outlier] += rng.standard_normal((int(outlier.sum()), 3))
    lat_rad, lon_rad, height_m = geodetic(p_map + error, origin)
    return GnssSamples(
        t_ns - round(1e9 * rig.gnss_time_offset_s),
        lat_rad,
        lon_rad,
        height_m,
        np.maximum(sd, 0.001),
        quality.astype(np.uint8),
        _attitude(walk.state(1e-9 * t_ns)[:, 3:], model, rng),
    )


def geodetic(p_enu_m: Array, origin: WorldOrigin) -> tuple[Array, Array, Array]:
    """WGS 84 latitude [rad], longitude [rad], ellipsoidal height [m] of points, (N, 3).

    Exact: east, north, up at the origin to geocentric to geodetic (EPSG method 9837 inverted).
    """
    from pyproj import Transformer

    place = f"+lat_0={origin.lat_deg!r} +lon_0={origin.lon_deg!r} +h_0={origin.height_m!r}"
    to_geodetic = Transformer.from_pipeline(
        f"+proj=pipeline +step +inv +proj=topocentric +ellps=WGS84 {place} "
        "+step +inv +proj=cart +ellps=WGS84"
    )
    east, north, up = np.asarray(p_enu_m, dtype=np.float64).T
    lon, lat, height = to_geodetic.transform(east, north, up, radians=True)
    return np.asarray(lat), np.asarray(lon), np.asarray(height)


def _attitude(rpy: Array, model: GnssModel, rng: np.random.Generator) -> Array:
    """Roll, pitch, heading in NED of a body with z down, from those of one with z up [rad]."""
    sd = np.deg2rad([model.roll_pitch_sd_deg, model.roll_pitch_sd_deg, model.heading_sd_deg])
    ned = np.stack([rpy[:, 0], -rpy[:, 1], 0.5 * np.pi - rpy[:, 2]], axis=1)
    ned += sd * rng.standard_normal(ned.shape)
    ned[:, 2] = np.mod(ned[:, 2], 2.0 * np.pi)
    return ned


def _quality(t_ns: Times, model: GnssModel, rng: np.random.Generator) -> tuple[Array, Array]:
    """Quality (N,) and standard deviations (N, 3): fixed but for some outages."""
    quality = np.full(len(t_ns), float(GnssQuality.RTK_FIXED))
    sd = np.tile(np.array(model.sd_enu_m), (len(t_ns), 1))
    minutes = t_ns[-1] / 60e9
    outages = rng.poisson(model.outages_per_minute * minutes)
    for start_s in 60.0 * rng.uniform(0.05, max(minutes, 0.1), outages):
        out = (t_ns >= 1e9 * start_s) & (t_ns < 1e9 * (start_s + rng.uniform(2.0, 8.0)))
        single = rng.random() < 0.3
        quality[out] = GnssQuality.SINGLE if single else GnssQuality.RTK_FLOAT
        sd[out] = np.array([1.0, 1.0, 2.0]) * (2.0 if single else 0.4)
    return quality, sd


def _slow(count: int, model: GnssModel, rng: np.random.Generator) -> Array:
    """A first-order Gauss-Markov process of standard deviation 1, (count, 3)."""
    from scipy.signal import lfilter

    keep = np.exp(-1.0 / (model.RATE_HZ * model.slow_s))
    noise = rng.standard_normal((count, 3))
    noise[1:] *= np.sqrt(1.0 - keep**2)
    return np.asarray(lfilter([1.0], [1.0, -keep], noise, axis=0))
