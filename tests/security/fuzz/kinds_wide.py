"""Packets of Velodynes whose firing takes several blocks, and the calibration of an HDL-64E."""

from __future__ import annotations

from functools import cache, partial
from pathlib import Path

import numpy as np

from recon4.recording.packets.family import Companion
from recon4.recording.packets.velodyne.family import FAMILY as VELODYNE
from recon4.recording.packets.velodyne.laser_calibration import calibration_of_file
from recon4.recording.packets.velodyne.models import DATA_SIZE
from recon4.recording.packets.velodyne.wide_encode import encode_wide
from recon4.recording.packets.velodyne.wide_models import VLS128, WideModel, hdl64_model
from tests.security.fuzz.kind import Kind, Reading
from tests.security.fuzz.packets import PacketRun

_PACKETS = 12
_YAML = "lasers:\n" + "".join(
    f"- {{laser_id: {k}, rot_correction: 0.01, vert_correction: {-0.4 + 0.006 * k:.3f}, "
    f"dist_correction: 1.2, dist_correction_x: 1.3, dist_correction_y: 1.25, "
    f"vert_offset_correction: 0.2, horiz_offset_correction: 0.026, focal_distance: 10.0, "
    f"focal_slope: 1.1}}\n"
    for k in range(64)
)
CALIBRATION = Companion("HDL64.yaml", _YAML.encode())


def _model(name: str) -> WideModel:
    calibration = calibration_of_file(CALIBRATION)
    assert calibration is not None
    return VLS128 if name == VLS128.name else hdl64_model(calibration, s3=False)


@cache
def _seeds(name: str) -> tuple[bytes, ...]:
    model = _model(name)
    blocks = 12 // model.rows
    t_us = np.arange(_PACKETS) * round(1e6 * model.packet_s(dual=False))
    azimuth = 20 * (np.arange(_PACKETS)[:, None] * blocks + np.arange(blocks))
    returns = np.full((_PACKETS, blocks, model.lasers, 2), [3000, 90])
    return (encode_wide(t_us, azimuth, returns, model=model).tobytes(),)


def _calibration(path: Path) -> Reading:
    """A file beside a recording: a calibration, or none."""
    found = calibration_of_file(Companion(path.name, path.read_bytes()))
    return Reading(0 if found is None else len(found.far_m), salvaged=found is None)


KINDS = (
    *(
        Kind(
            name=f"velodyne-{name.lower()}",
            file_name="packets.bin",
            seeds=partial(_seeds, name),
            read=PacketRun(VELODYNE, name, DATA_SIZE, _PACKETS, (CALIBRATION,)).read,
            # A run of packets has no end mark.
            knows_end=False,
        )
        for name in (VLS128.name, "HDL-64E")
    ),
    Kind(
        name="velodyne-calibration",
        file_name="hdl64.yaml",
        seeds=lambda: (CALIBRATION.content,),
        read=_calibration,
        knows_end=False,
    ),
)
"""Data packets, and the file that they need."""
