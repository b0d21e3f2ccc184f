"""What rows of the journal contain: registrations of reviewers, approvals, findings."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from recon4.geometry.se3 import SE3, Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Measurement:
    """A registration requested by a reviewer."""

    T_i_j: tuple[float, ...]
    """Pose of ``j`` in ``i``: x y z [m], quaternion x y z w."""
    information: tuple[float, ...]
    """As `Edge.information`, row by row, 36 numbers."""
    overlap: float
    error_m: float
    limit_m: float
    degeneracy: float
    iterations: int

    def motion(self) -> SE3:
        """``T_i_j``."""
        return pose_of(self.T_i_j)

    def matrix(self) -> Array:
        """``information``, (6, 6)."""
        return np.array(self.information).reshape(6, 6)


@dataclass(frozen=True, slots=True, kw_only=True)
class ApprovalFacts:
    """What the journal says of an approval; the fields are its keys."""

    version: int
    approval: str
    """SHA-256 of the signed statement."""
    artifacts: str = ""
    """SHA-256 of the keys of all artifacts."""
    verdict: str = ""
    """On the map; empty before statement format 3."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SeenFinding:
    """A finding as the journal keeps it: without wording and place; the fields are its keys."""

    kind: str
    """Its code."""
    level: str
    span_s: tuple[float, float] | None
    """Its stretch of the walk [s]; None = the whole walk."""
    direction: str
    sensor: str
    values: dict[str, bool | int | float | str | None]


def pose_of(numbers: Iterable[float]) -> SE3:
    """A pose of x y z [m] and a quaternion x y z w."""
    listed = list(numbers)
    return SE3.from_quat(np.array(listed[3:]), np.array(listed[:3]))


def numbers_of(T_a_b: SE3) -> tuple[float, ...]:
    """The inverse of `pose_of`."""
    return (*map(float, T_a_b.t), *map(float, T_a_b.quat_xyzw()))


def measurement_in(record: Mapping[str, Any]) -> Measurement:
    """The measurement of a row of the journal; null = not a number."""
    known = {name: math.nan if value is None else value for name, value in record.items()}
    return Measurement(
        T_i_j=tuple(record["T_i_j"]),
        information=tuple(record["information"]),
        overlap=known["overlap"],
        error_m=known["error_m"],
        limit_m=known["limit_m"],
        degeneracy=known["degeneracy"],
        iterations=record["iterations"],
    )
