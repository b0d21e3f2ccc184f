"""Limits of rig files."""

from __future__ import annotations

from msgspec import Struct


class CalibrationFileLimits(Struct, frozen=True, kw_only=True):
    """Calibrations of a project."""

    max_calibration_bytes: int = 4 << 20
    """Largest file."""


CALIBRATION_FILES = CalibrationFileLimits()


class RigContentLimits(Struct, frozen=True, kw_only=True):
    """Values in the form of a rig."""

    largest_m: float = 10.0
    """A sensor farther from the origin of a backpack is a mistake of the unit."""
    largest_deg: float = 360.0
    """Largest angle [°]."""
    largest_head_deg_s: float = 3600.0
    """Fastest head of a profiler [°/s]."""
    largest_port: int = 65535
    """Largest port."""
    gimbal_lock: float = 1e-9
    """Cosine of the pitch below which roll and yaw are not determined."""


RIG_CONTENT = RigContentLimits()


class RigTextLimits(Struct, frozen=True, kw_only=True):
    """Texts in the form of a rig."""

    longest_text: int = 1000
    """Longest text."""


RIG_TEXTS = RigTextLimits()


class RigStoreLimits(Struct, frozen=True, kw_only=True):
    """Rigs of the server."""

    max_rigs: int = 200
    """Rigs."""
    max_versions: int = 999
    """Versions of a rig."""
    max_version_bytes: int = 64 * 1024
    """Largest file of a version."""
    max_evidence: int = 4000
    """Longest note on a version."""


RIG_STORE = RigStoreLimits()


class RigUseLimits(Struct, frozen=True, kw_only=True):
    """Projects by their rig."""

    max_cached: int = 4096
    """Projects that are remembered."""


RIG_USES = RigUseLimits()
