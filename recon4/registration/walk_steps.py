"""The steps of a whole walk in columns, and their dense poses as one trajectory.

Two hours have 72 000 multiframes. A step takes 0.7 kB as a row and its dense poses 1.1 kB until
they are thinned; as objects both take 6 kB.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import SE3, Array
from recon4.model.trajectory import Times, Trajectory
from recon4.registration.smoother import smooth
from recon4.registration.step import OdometryStep
from recon4.registration.tuning_motion import DENSE

_POSES = {"T_odom_body", "t_ns", "T_dense"}
_SHAPES = {"motion_cov": (6, 6), "weak_direction": (3,), "weak_twist": (6,)}
_TYPES = {"int": np.int64, "bool": np.bool_, "float": np.float64, "Array": np.float64}
_PLAIN = [field for field in fields(OdometryStep) if field.name not in _POSES]
_ROW = np.dtype(
    [
        *((one.name, _TYPES[str(one.type)], _SHAPES.get(one.name, ())) for one in _PLAIN),
        ("R", np.float64, (3, 3)),
        ("t_m", np.float64, (3,)),
        ("ends_ns", np.int64, (2,)),
        ("R_ends", np.float64, (2, 3, 3)),
        ("t_ends_m", np.float64, (2, 3)),
    ]
)
_ENDS = [0, -1]


class WalkSteps:
    """Steps of a walk in order, in memory that grows block by block.

    Of the dense poses of a step the first and the last are kept.
    """

    def __init__(self, steps: Iterable[OdometryStep] = ()) -> None:
        """Take some steps."""
        self._blocks: list[NDArray[np.void]] = []
        self._count = 0
        for step in steps:
            self.append(step)

    def append(self, step: OdometryStep) -> None:
        """Add the next step."""
        if self._count == len(self._blocks) * DENSE.block:
            self._blocks.append(np.empty(DENSE.block, _ROW))
        self._count += 1
        self._put(self._count - 1, step)

    def update(self, changed: Iterable[tuple[int, OdometryStep]]) -> None:
        """Put steps in place of those with some numbers."""
        for number, step in changed:
            self._put(number, step)

    def __len__(self) -> int:
        """Number of steps."""
        return self._count

    def __iter__(self) -> Iterator[OdometryStep]:
        """All steps, each made when it is asked for."""
        return (self[number] for number in range(len(self)))

    def __getitem__(self, number: int) -> OdometryStep:
        """A step by its number; changing it changes nothing here."""
        number = range(self._count)[number]
        row = self._blocks[number // DENSE.block][number % DENSE.block].copy()
        plain = {name: row[name] for name in _SHAPES}
        plain |= {one.name: row[one.name].item() for one in _PLAIN if one.name not in _SHAPES}
        return OdometryStep(
            T_odom_body=SE3(row["R"], row["t_m"]),
            t_ns=row["ends_ns"],
            T_dense=SE3(row["R_ends"], row["t_ends_m"]),
            **plain,
        )

    def column(self, name: str) -> NDArray[Any]:
        """What all steps have under a name of `OdometryStep` that is no pose, (N, …)."""
        rest, parts = self._count, []
        for block in self._blocks:
            parts.append(block[name][:rest])
            rest -= len(block)
        return np.concatenate(parts) if parts else np.empty(0, _ROW)[name]

    @property
    def T_odom_body(self) -> SE3:
        """Poses at the middle of the multiframes, a batch of N."""
        return SE3(self.column("R"), self.column("t_m"))

    def _put(self, number: int, step: OdometryStep) -> None:
        T, dense = step.T_odom_body, step.T_dense
        self._blocks[number // DENSE.block][number % DENSE.block] = (
            *(getattr(step, one.name) for one in _PLAIN),
            T.R, T.t, step.t_ns[_ENDS], dense.R[_ENDS], dense.t[_ENDS],
        )  # fmt: skip


def dense_trajectory(steps: Iterable[OdometryStep]) -> Trajectory:
    """The dense poses of an odometry, smoothed, as one trajectory of at most about 100 Hz."""
    poses = DensePoses()
    for step in smooth(steps):
        poses.add(step)
    return poses.trajectory()


class DensePoses:
    """Dense poses of the steps of a walk, until they become one trajectory."""

    def __init__(self) -> None:
        """There are none yet."""
        self._parts: list[tuple[Times, Array, Array]] = []
        self._fresh: list[tuple[Times, Array, Array]] = []

    def add(self, step: OdometryStep) -> None:
        """Add those of the next step."""
        self._fresh.append((step.t_ns, step.T_dense.R, step.T_dense.t))
        if len(self._fresh) == DENSE.block:
            self._join()

    def trajectory(self) -> Trajectory:
        """At most about 100 Hz of them; here there are none any more."""
        self._join()
        t_ns = np.concatenate([part[0] for part in self._parts])
        # The first pose of a frame updates the last pose of the frame before.
        newest = len(t_ns) - 1 - np.unique(t_ns[::-1], return_index=True)[1]
        slot = (t_ns[newest] - t_ns[newest[0]]) // DENSE.step_ns
        kept = np.append(np.diff(slot) > 0, True)
        kept[0] = True
        rows = newest[kept]
        R, t_m, first = np.empty((len(rows), 3, 3)), np.empty((len(rows), 3)), 0
        self._parts.reverse()
        while self._parts:  # each is free before the next one is copied
            _, *poses = self._parts.pop()
            last = first + len(poses[0])
            here = np.flatnonzero((rows >= first) & (rows < last))
            R[here], t_m[here] = (values[rows[here] - first] for values in poses)
            first = last
        return Trajectory(t_ns[rows], SE3(R, t_m))

    def _join(self) -> None:
        """Many small arrays become few large ones."""
        if self._fresh:
            t_ns, R, t_m = (np.concatenate(column) for column in zip(*self._fresh, strict=True))
            self._parts.append((t_ns, R, t_m))
            self._fresh.clear()
