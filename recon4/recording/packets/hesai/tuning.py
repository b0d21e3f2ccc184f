"""Tuning of the packets of Hesai."""

from __future__ import annotations

import numpy as np
from msgspec import Struct


class HesaiAngleTuning(Struct, frozen=True, kw_only=True):
    """Tables of the angles of one unit."""

    same_model_rad: float = float(np.deg2rad(2.5))
    """Elevations of two units of one model differ by less [rad]."""
    limits_deg: tuple[float, float] = (90.0, 360.0)
    """Largest elevation and azimuth."""
    most_head: int = 3
    """Lines up to and with the names of the columns: ``eeff,1,1`` and the number of channels may
    precede them."""


HESAI_ANGLES = HesaiAngleTuning()


class HesaiPacketTuning(Struct, frozen=True, kw_only=True):
    """What no packet exceeds."""

    longest: int = 1500
    """Bytes: those of a frame of Ethernet."""
    fastest_rpm: float = 3600.0
    """Revolutions a minute."""


HESAI_PACKETS = HesaiPacketTuning()
