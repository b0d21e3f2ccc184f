"""Reading trajectories to judge: ``.tum``, ``.npz`` or a project folder."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from recon4.errors import CorruptFile, EmptyRecording, UnknownFormat
from recon4.geometry.se3 import SE3
from recon4.model.trajectory import Trajectory
from recon4.store.arrays import load_trajectory


def find_trajectory(path: Path) -> Trajectory:
    """The trajectory at a path: a file, or ``trajectory.tum`` of a project folder.

    Raises:
        UnknownFormat: If there is none, or the ending is neither ``.tum``, ``.txt`` nor ``.npz``.
        CorruptFile: If a line is not eight finite numbers or the times do not increase.
        EmptyRecording: If the file holds no pose.
    """
    file = path / "trajectory.tum" if path.is_dir() else path
    if not file.is_file():
        raise UnknownFormat(f"{path.name}: expected a trajectory file or a project with one")
    if file.suffix == ".npz":
        return load_trajectory(file)
    if file.suffix in {".tum", ".txt"}:
        return read_tum(file)
    raise UnknownFormat(f"{file.name}: expected a trajectory as .tum, .txt or .npz")


def read_tum(path: Path) -> Trajectory:
    """Read ``t x y z qx qy qz qw`` a line; times keep their nanoseconds.

    Raises:
        CorruptFile: If a line is not eight finite numbers or the times do not increase.
        EmptyRecording: If there is no pose.
    """
    t_ns, numbers = [], []
    for k, line in enumerate(path.read_text("utf-8", errors="replace").splitlines(), start=1):
        words = line.replace(",", " ").split()
        if not words or words[0].startswith("#"):
            continue
        try:
            t_ns.append(_nanoseconds(words[0]))
            numbers.append([float(word) for word in words[1:]])
        except ValueError as error:
            raise CorruptFile(f"{path.name} line {k}: expected numbers, got {line!r}") from error
        if len(numbers[-1]) != 7 or not np.all(np.isfinite(numbers[-1])):
            raise CorruptFile(f"{path.name} line {k}: expected 8 finite numbers, got {line!r}")
    if not t_ns:
        raise EmptyRecording(f"{path.name}: no pose in it")
    times, table = np.array(t_ns, dtype=np.int64), np.array(numbers)
    if np.any(np.diff(times) <= 0):
        k = int(np.argmax(np.diff(times) <= 0)) + 1
        raise CorruptFile(f"{path.name}: pose {k} is not later than the one before")
    return Trajectory(times, SE3.from_quat(table[:, 3:], table[:, :3]))


def _nanoseconds(text: str) -> int:
    """Seconds as text to ns, without the rounding of a float (200 ns at today's dates)."""
    whole, point, fraction = text.partition(".")
    if not whole.lstrip("+-").isdigit() or (point and not fraction.isdigit()):
        return round(float(text) * 1e9)
    sign = -1 if whole.startswith("-") else 1
    return int(whole) * 1_000_000_000 + sign * int((fraction + "0" * 9)[:9])
