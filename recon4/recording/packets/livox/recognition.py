"""Which Livox sends packets: by how fast it shoots, and where to."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.distinct import distinct
from recon4.recording.packets.family import Payloads
from recon4.recording.packets.livox.models import MODELS, LivoxModel, PointLayout, header_of
from recon4.recording.packets.livox.points import LivoxSource, decode_points
from recon4.recording.packets.livox.sound import stamps_ns
from recon4.recording.packets.livox.tuning import LIVOX_VIEWS
from recon4.recording.report import ImportReport
from recon4.settings import IngestSettings

_EVERYTHING = IngestSettings(min_range_m=0.0, max_range_m=1000.0)


def likely_models(layout: PointLayout, packet_s: float) -> tuple[str, ...]:
    """Models whose packets of a layout come at an interval [s]; the usual one first."""
    names = [
        model.name
        for model in MODELS.values()
        if model.sdk == layout.sdk
        and abs(packet_s / (layout.shots * model.shot_s) - 1.0) < LIVOX_VIEWS.alike
    ]
    if layout.sdk == 1 and layout.data_type > 1 and "Mid-70" in names:
        names.sort(key=lambda name: name != "Mid-70")  # a Mid-40 has no tags
    return tuple(names)


def likely_model(layout: PointLayout, payloads: Payloads) -> tuple[LivoxModel, bool]:
    """The model of sound packets, and whether it is known, not only assumed.

    Models that shoot alike differ in their field of view.

    Args:
        layout: Of the packets.
        payloads: From the head of a stream, (N, size), N > 0.
    """
    names = likely_models(layout, _packet_s(layout, payloads))
    default = "Mid-360" if layout.sdk == 2 else "Avia" if layout.data_type > 1 else "Mid-40"
    if not names:
        return MODELS[default], False
    if "Avia" not in names:
        return MODELS[names[0]], True
    return MODELS[_by_view(layout, payloads)], True


def livox_of_points(xyz: NDArray[np.float32], lines: int) -> str:
    """The model of points that a driver has published; ``generic`` = not known.

    Args:
        xyz: Points of a frame [m], (N, 3), N > 0.
        lines: Number of lasers.
    """
    azimuth_deg, elevation_deg = _extent_deg(xyz)
    if lines == MODELS["Mid-360"].lines:
        return "Mid-360"
    if lines == 1:
        return "Mid-70" if max(azimuth_deg, elevation_deg) > LIVOX_VIEWS.mid_40_deg else "Mid-40"
    if lines != MODELS["Avia"].lines:
        return "generic"
    if azimuth_deg > LIVOX_VIEWS.hap_deg:
        return "HAP"
    return _of_view(azimuth_deg, elevation_deg, len(xyz))


def _packet_s(layout: PointLayout, payloads: Payloads) -> float:
    """Usual time of the shots of a packet [s]."""
    if layout.sdk == 2:
        stated = np.median(header_of(payloads, 2)["interval"]) * 1e-7
        if stated > 0:
            return float(stated)
    steps = np.diff(distinct(stamps_ns(payloads, layout.sdk)))
    return float(np.median(steps)) * 1e-9 if len(steps) else float("nan")


def _by_view(layout: PointLayout, payloads: Payloads) -> str:
    """Horizon, Avia or Tele-15."""
    azimuth_deg, elevation_deg, points = _view(layout, payloads)
    return "Avia" if layout.returns == 3 else _of_view(azimuth_deg, elevation_deg, points)


def _of_view(azimuth_deg: float, elevation_deg: float, points: int) -> str:
    if elevation_deg > LIVOX_VIEWS.high_deg:
        return "Avia"
    if azimuth_deg > LIVOX_VIEWS.wide_deg:
        return "Horizon"
    if (
        max(azimuth_deg, elevation_deg) < LIVOX_VIEWS.tele_deg
        and points > LIVOX_VIEWS.enough_points
    ):
        return "Tele-15"
    return "Avia"


def _view(layout: PointLayout, payloads: Payloads) -> tuple[float, float, int]:
    """Largest directions of points to the side and up or down [°], and the number of points."""
    source = LivoxSource(0, MODELS["Avia"], layout, _EVERYTHING)
    none_ns = np.zeros(len(payloads), np.int64)
    xyz = decode_points(none_ns, payloads, source, report=ImportReport()).xyz
    return (*_extent_deg(xyz), len(xyz)) if len(xyz) else (0.0, 0.0, 0)


def _extent_deg(xyz: NDArray[np.float32]) -> tuple[float, float]:
    """Largest directions of points to the side and up or down [°]."""
    azimuth = np.abs(np.arctan2(xyz[:, 1], xyz[:, 0]))
    elevation = np.abs(np.arctan2(xyz[:, 2], np.hypot(xyz[:, 0], xyz[:, 1])))
    return _largest_deg(azimuth), _largest_deg(elevation)


def _largest_deg(angles_rad: NDArray[np.floating]) -> float:
    """Without single damaged values."""
    return float(np.rad2deg(np.percentile(angles_rad, 99.5)))
