"""Records as ``.npz`` files: plain arrays, never pickles."""

from __future__ import annotations

import io
import math
import tokenize
import zipfile
import zlib
from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from recon4.errors import StoreError
from recon4.geometry.se3 import SE3, poses_by_blocks
from recon4.locales.coded import CodedText
from recon4.model.intensity_table import IntensityTable
from recon4.model.trajectory import Trajectory
from recon4.untrusted.bounded import check_file_size, open_regular
from recon4.untrusted.limits import LIMITS

Record = TypeVar("Record")

ARRAY_HEADERS = {
    (1, 0): np.lib.format.read_array_header_1_0,
    (2, 0): np.lib.format.read_array_header_2_0,
}
DAMAGED = (
    *(OSError, KeyError, ValueError, EOFError, TypeError, NotImplementedError, OverflowError),
    *(zipfile.BadZipFile, zlib.error, tokenize.TokenError, RuntimeError, SyntaxError),
    *(AttributeError, IndexError),
)
"""Errors that numpy and zipfile raise for a file that is missing, truncated, altered or foreign."""


def save_record(path: Path, record: Any) -> None:
    """Write a dataclass of arrays (`ImuSamples`, `GnssSamples`, …)."""
    np.savez(path, **{f.name: getattr(record, f.name) for f in fields(record)})


def load_record(path: Path, kind: type[Record]) -> Record:
    """Read a dataclass of arrays written by `save_record`.

    Raises:
        StoreError: If the file is missing, damaged or of another kind.
    """
    return kind(**load_arrays(path, [f.name for f in fields(kind)]))  # type: ignore[arg-type]


def save_arrays(path: Path, arrays: Mapping[str, NDArray[Any]]) -> None:
    """Write named arrays."""
    np.savez(path, allow_pickle=False, **arrays)


def save_trajectory(path: Path, trajectory: Trajectory) -> None:
    """Write ``t_ns``, ``quat_xyzw`` and ``t_m``."""
    T = trajectory.T_a_b
    np.savez(path, t_ns=trajectory.t_ns, quat_xyzw=T.quat_xyzw(), t_m=T.t)


def load_trajectory(path: Path) -> Trajectory:
    """Read a trajectory written by `save_trajectory`.

    Raises:
        StoreError: If the file is missing, damaged or of another kind.
    """
    arrays = load_arrays(path, ["t_ns", "quat_xyzw", "t_m"])
    quat_xyzw, t_m = arrays["quat_xyzw"], arrays["t_m"]
    T_a_b = poses_by_blocks(lambda rows: SE3.from_quat(quat_xyzw[rows], t_m[rows]), len(t_m))
    return Trajectory(arrays["t_ns"], T_a_b)


def save_intensity_table(path: Path, table: IntensityTable) -> None:
    """Write ``mean``, ``std``, ``level`` and the ``numbers`` of a table."""
    numbers = [table.target_mean, table.target_std, table.upper]
    numbers += [table.incidence_bin_rad, table.range_bin_m]
    np.savez_compressed(
        path, mean=table.mean, std=table.std, level=table.level, numbers=np.array(numbers)
    )


def load_intensity_table(path: Path) -> IntensityTable:
    """Read a table written by `save_intensity_table`.

    Raises:
        StoreError: If the file is missing or damaged.
    """
    arrays = load_arrays(path, ["mean", "std", "level", "numbers"])
    mean, std, level, numbers = (arrays[name] for name in ("mean", "std", "level", "numbers"))
    fits = mean.ndim == 4 and mean.shape == std.shape == level.shape and numbers.shape == (5,)
    if not fits or not np.isfinite(mean).all() or not np.isfinite(std).all():
        raise StoreError(f"{path.name} is not a table of intensities")
    target_mean, target_std, upper, incidence_bin_rad, range_bin_m = numbers.tolist()
    return IntensityTable(
        mean=mean,
        std=std,
        level=level,
        target_mean=target_mean,
        target_std=target_std,
        upper=upper,
        incidence_bin_rad=incidence_bin_rad,
        range_bin_m=range_bin_m,
    )


def load_arrays(path: Path, names: list[str] | None = None) -> dict[str, NDArray[Any]]:
    """Read named arrays of an ``.npz`` file, or all of them.

    Raises:
        StoreError: If the file is missing, damaged, lacks one of the names, or its arrays are
            larger than `LIMITS.array_bytes` together.
    """
    with open_regular(path, failure=StoreError) as raw:
        try:
            with zipfile.ZipFile(raw) as archive:
                return _members(archive, names, path.name)
        except DAMAGED as error:
            raise StoreError(f"{path.name}: expected arrays {names or ''}: {error}") from error


def load_array(path: Path, dtype: np.dtype[Any]) -> NDArray[Any]:
    """Read an ``.npy`` file of one dimension and a known type.

    Raises:
        StoreError: If the file is missing, damaged, of another type or length.
    """
    with open_regular(path, failure=StoreError) as raw:
        check_file_size(raw, path, LIMITS.array_bytes, failure=StoreError)
        try:
            return _array(raw.read(), path.name, dtype)
        except DAMAGED as error:
            raise StoreError(f"{path.name}: expected an array of {dtype}: {error}") from error


def _members(
    archive: zipfile.ZipFile, names: list[str] | None, where: str
) -> dict[str, NDArray[Any]]:
    found = {info.filename: info for info in archive.infolist()}
    if names is None:
        names = [name.removesuffix(".npy") for name in found if name.endswith(".npy")]
    missing = [name for name in names if f"{name}.npy" not in found]
    if missing:
        raise StoreError(
            CodedText("arrays-missing", file=where, names=str(names), missing=str(missing))
        )
    chosen = {name: found[f"{name}.npy"] for name in names}
    size = sum(info.file_size for info in chosen.values())
    packed = sum(info.compress_size for info in chosen.values())
    if size > LIMITS.array_bytes or size > LIMITS.expansion * packed + LIMITS.free_bytes:
        raise StoreError(
            f"{where}: expected at most {LIMITS.array_bytes} bytes and {LIMITS.expansion} times "
            f"the packed size, got {size} bytes from {packed}"
        )
    out = {}
    for name, info in chosen.items():
        with archive.open(info) as member:
            # The stated size is not trusted: no more bytes than that are read.
            out[name] = _array(member.read(info.file_size), f"{where}: {name}", None)
    return out


def _array(data: bytes, where: str, dtype: np.dtype[Any] | None) -> NDArray[Any]:
    """Parse an ``.npy`` file; its header must match its size before memory is allocated."""
    file = io.BytesIO(data)
    version = np.lib.format.read_magic(file)
    if version not in ARRAY_HEADERS:
        raise StoreError(f"{where}: expected an array of version 1 or 2, got {version}")
    shape, fortran, found = ARRAY_HEADERS[version](file)
    if found.hasobject or (dtype is not None and (found != dtype or len(shape) != 1)):
        raise StoreError(f"{where}: expected {dtype or 'plain values'}, got {found} of {shape}")
    left = len(data) - file.tell()
    if min(shape, default=1) < 0 or math.prod(shape) * found.itemsize != left:
        raise StoreError(
            f"{where}: an array of {found} of {shape} needs "
            f"{math.prod(shape) * found.itemsize} bytes, got {left}"
        )
    flat = np.frombuffer(data, found, offset=file.tell()) if left else np.empty(0, found)
    return flat.reshape(shape, order="F" if fortran else "C").copy()
