"""Packets of a VLS-128 or HDL-64E written: the inverse of `wide_packets`."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from recon4.recording.packets.family import Payloads
from recon4.recording.packets.velodyne.models import (
    CHANNELS,
    DATA_PACKET,
    DATA_SIZE,
    DUAL,
    STRONGEST,
)
from recon4.recording.packets.velodyne.wide_models import VLS128, VLS128_PRODUCT, WideModel
from recon4.units import HOUR_US


def encode_wide(
    t_us: NDArray[np.integer],
    azimuth_cdeg: NDArray[np.integer],
    returns: NDArray[np.integer],
    *,
    model: WideModel,
    dual: bool = False,
) -> Payloads:
    """Data packets.

    Args:
        t_us: Time stamp of each packet [µs]; only the part past the hour is kept, (P,).
        azimuth_cdeg: Azimuth of each firing and return [0.01°], (P, B): the last returns before
            the strongest ones of the same firing.
        returns: Distances in units of the model, 0 = no return, and intensities, (P, B, L, 2).
        model: The sensor.
        dual: Whether there are two returns.

    Returns:
        UDP payloads, (P, 1206).
    """
    packets = np.zeros(len(t_us), dtype=DATA_PACKET)
    blocks = packets["blocks"]
    order = model.order_of(dual=dual)
    used = model.used_blocks(dual=dual)
    blocks["flag"][:, :used] = model.wire_flags(dual=dual)
    azimuth = np.repeat(np.asarray(azimuth_cdeg) % 36000, model.rows, axis=1)
    blocks["azimuth_cdeg"][:, order[:used]] = azimuth[:, :used]
    rows = np.asarray(returns).reshape(len(t_us), -1, CHANNELS, 2)[:, :used]
    blocks["returns"]["distance"][:, order[:used]] = rows[..., 0]
    blocks["returns"]["intensity"][:, order[:used]] = rows[..., 1]
    packets["time_us"] = np.asarray(t_us) % HOUR_US
    if model is VLS128:
        packets["return_mode"] = DUAL if dual else STRONGEST
        packets["product"] = VLS128_PRODUCT
    return packets.view(np.uint8).reshape(-1, DATA_SIZE)
