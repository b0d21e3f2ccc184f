"""Records as ``.npz`` files: plain arrays, never pickles."""

from __future__ import annotations

import zipfile
import zlib
from dataclasses import fields
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from recon4.errors import StoreError
from recon4.geometry.se3 import SE3
from recon4.model.trajectory import Trajectory

Record = TypeVar("Record")

_DAMAGED = (OSError, KeyError, ValueError, EOFError, TypeError, zipfile.BadZipFile, zlib.error)
"""What numpy raises over a file that is missing, cut off, altered or something else."""


def save_record(path: Path, record: Any) -> None:
    """Write a dataclass of arrays (`ImuSamples`, `GnssSamples`, …)."""
    np.savez(path, **{f.name: getattr(record, f.name) for f in fields(record)})


def load_record(path: Path, kind: type[Record]) -> Record:
    """Read what `save_record` wrote.

    Raises:
        StoreError: If the file is missing, damaged or of another kind.
    """
    return kind(**load_arrays(path, [f.name for f in fields(kind)]))  # type: ignore[arg-type]


def save_trajectory(path: Path, trajectory: Trajectory) -> None:
    """Write ``t_ns``, ``quat_xyzw`` and ``t_m``."""
    T = trajectory.T_a_b
    np.savez(path, t_ns=trajectory.t_ns, quat_xyzw=T.quat_xyzw(), t_m=T.t)


def load_trajectory(path: Path) -> Trajectory:
    """Read what `save_trajectory` wrote.

    Raises:
        StoreError: If the file is missing, damaged or of another kind.
    """
    arrays = load_arrays(path, ["t_ns", "quat_xyzw", "t_m"])
    return Trajectory(arrays["t_ns"], SE3.from_quat(arrays["quat_xyzw"], arrays["t_m"]))


def load_arrays(path: Path, names: list[str]) -> dict[str, Any]:
    """Named arrays of an ``.npz`` file.

    Raises:
        StoreError: If the file is missing, damaged or lacks one of the names.
    """
    try:
        # Opened here: numpy leaves a file that it cannot read open behind its error.
        with path.open("rb") as raw, np.load(raw, allow_pickle=False) as file:
            return {name: file[name] for name in names}
    except _DAMAGED as error:
        raise StoreError(f"{path.name}: expected arrays {names}: {error}") from error
