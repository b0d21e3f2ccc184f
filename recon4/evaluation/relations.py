"""Errors of relative poses against reference relations (Kuemmerle 2009, the Freiburg benchmark).

A reference relation is the true pose of the laser at one time, seen from its pose at another time.
The error of a trajectory is the remaining motion between its relative pose and the reference. No
alignment is needed, and errors far apart do not mix with errors close by.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from recon4.errors import ConfigError, CorruptFile, EmptyRecording
from recon4.evaluation.tuning import RELATIONS
from recon4.geometry.se3 import SE3, Array
from recon4.locales.coded import CodedText
from recon4.model.trajectory import Times, Trajectory
from recon4.untrusted.bounded import lines_limited, parse_float

_COLUMNS = 8


@dataclass(frozen=True, slots=True, eq=False)
class ReferenceRelations:
    """True relative poses."""

    t_i_ns: Times
    """Time of the first pose [ns], (R,)."""
    t_j_ns: Times
    """Time of the second pose [ns], (R,)."""
    T_i_j: SE3
    """True pose of the second in the first, a batch of R."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RelationErrors:
    """Errors of a trajectory against reference relations."""

    relations: int
    """Relations compared."""
    outside: int
    """Relations outside of the time of the trajectory; not compared."""
    translation_mean_m: float
    translation_sd_m: float
    translation_largest_m: float
    rotation_mean_rad: float
    rotation_sd_rad: float
    rotation_largest_rad: float
    hints: tuple[str, ...] = ()
    """What the reader of the figures must know of the trajectory's file."""


def read_relations(path: Path) -> ReferenceRelations:
    """Read lines of ``t1 t2 x y z roll pitch yaw``, in seconds, meters and radians.

    Raises:
        CorruptFile: Naming the line that is not eight finite numbers, or times out of range.
        EmptyRecording: If there is no relation.
    """
    rows: list[list[float]] = []
    times: list[tuple[int, int]] = []
    for number, line in enumerate(lines_limited(path, max_bytes=RELATIONS.max_bytes), start=1):
        words = line.split("#", 1)[0].split()
        if not words:
            continue
        try:
            values = [parse_float(word) for word in words]
        except ValueError as error:
            raise CorruptFile(
                CodedText("relations-line", file=path.name, number=number, why=str(error))
            ) from error
        if len(values) != _COLUMNS or not np.all(np.isfinite(values)):
            raise CorruptFile(
                CodedText(
                    "relations-numbers",
                    file=path.name,
                    number=number,
                    columns=_COLUMNS,
                    line=line[:80],
                )
            )
        if max(abs(value) for value in values[:2]) > RELATIONS.latest_s:
            raise CorruptFile(
                CodedText("relations-seconds", file=path.name, number=number, line=line[:80])
            )
        times.append((round(values[0] * 1e9), round(values[1] * 1e9)))
        rows.append(values[2:])
    if not rows:
        raise EmptyRecording(CodedText("relations-none", file=path.name))
    table, t_ns = np.array(rows), np.array(times, np.int64)
    T = SE3.stack(SE3.from_rpy(*row[3:], t=row[:3]) for row in table)
    return ReferenceRelations(t_ns[:, 0], t_ns[:, 1], T)


def relation_errors(trajectory: Trajectory, reference: ReferenceRelations) -> RelationErrors:
    """Compare relative poses of a trajectory with reference relations.

    Args:
        trajectory: Poses of the sensor that the relations are about; interpolated at their times.
        reference: The relations.

    Raises:
        ConfigError: If the trajectory covers none of them.
    """
    low, high = trajectory.t_ns[0] - RELATIONS.slack_ns, trajectory.t_ns[-1] + RELATIONS.slack_ns
    both = np.stack([reference.t_i_ns, reference.t_j_ns])
    inside = np.all((both >= low) & (both <= high), axis=0)
    if not inside.any():
        raise ConfigError(
            CodedText(
                "relations-cover",
                low_s=float(low / 1e9),
                high_s=float(high / 1e9),
                count=len(inside),
                begin_s=float(both.min() / 1e9),
                end_s=float(both.max() / 1e9),
            )
        )
    T_i = trajectory.at(reference.t_i_ns[inside], slack_ns=RELATIONS.slack_ns)
    T_j = trajectory.at(reference.t_j_ns[inside], slack_ns=RELATIONS.slack_ns)
    error = reference.T_i_j[inside].inverse() @ (T_i.inverse() @ T_j)
    shift_m: Array = np.linalg.norm(error.t, axis=1)
    turn_rad: Array = error.angle()
    return RelationErrors(
        relations=int(inside.sum()),
        outside=int((~inside).sum()),
        translation_mean_m=float(shift_m.mean()),
        translation_sd_m=float(shift_m.std()),
        translation_largest_m=float(shift_m.max()),
        rotation_mean_rad=float(turn_rad.mean()),
        rotation_sd_rad=float(turn_rad.std()),
        rotation_largest_rad=float(turn_rad.max()),
    )
