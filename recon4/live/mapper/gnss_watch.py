"""GNSS during a capture: reported and checked for jumps; it does not affect the live map."""

from __future__ import annotations

import numpy as np

from recon4.live.mapper.tuning import GNSS_WATCH
from recon4.live.protocol import Fix
from recon4.model.samples import GnssSamples
from recon4.units import EARTH_RADIUS_M


class GnssWatch:
    """Reports the quality of GNSS fixes and detects jumps of the position."""

    def __init__(self) -> None:
        self._last: tuple[int, float, float] | None = None
        self._jump = (0, 0.0)

    def push(self, gnss: GnssSamples) -> Fix:
        """Build the message ``fix`` of the newest of some fixes."""
        rows = zip(gnss.t_ns.tolist(), gnss.lat_rad.tolist(), gnss.lon_rad.tolist(), strict=True)
        for t_ns, lat_rad, lon_rad in rows:
            self._take(t_ns, lat_rad, lon_rad)
        sd_m = gnss.sd_enu_m[-1]
        t_ns = int(gnss.t_ns[-1])
        jumped = t_ns - self._jump[0] < GNSS_WATCH.shown_s * 1e9
        return Fix(
            t_ns=t_ns,
            quality=int(gnss.quality[-1]),
            lat_rad=float(gnss.lat_rad[-1]),
            lon_rad=float(gnss.lon_rad[-1]),
            sd_m=None if not np.isfinite(sd_m).all() else [round(float(v), 3) for v in sd_m],
            jumped_m=round(self._jump[1], 1) if jumped else None,
        )

    def _take(self, t_ns: int, lat_rad: float, lon_rad: float) -> None:
        if self._last is not None:
            before_ns, before_lat, before_lon = self._last
            north_m = EARTH_RADIUS_M * (lat_rad - before_lat)
            east_m = EARTH_RADIUS_M * (lon_rad - before_lon) * float(np.cos(lat_rad))
            moved_m = float(np.hypot(north_m, east_m))
            if moved_m > GNSS_WATCH.noise_m + GNSS_WATCH.fastest_m_s * (t_ns - before_ns) / 1e9:
                self._jump = (t_ns, moved_m)
        self._last = (t_ns, lat_rad, lon_rad)
