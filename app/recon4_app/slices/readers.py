"""Readers of what child processes of slices wrote."""

from __future__ import annotations

from pathlib import Path

import msgspec
from pydantic import ValidationError

from recon4.errors import StoreError
from recon4.locales.coded import at, unreadable
from recon4.slices.double_places import DoubleReport
from recon4.slices.targets.named import TargetList
from recon4.store.json_files import read_object
from recon4.untrusted.typed import as_type
from recon4_app.slices.model import WindowSpec
from recon4_app.slices.tuning import READERS


def read_window(path: Path) -> WindowSpec:
    """Read the window of an image that a child process wrote.

    Raises:
        StoreError: If it is damaged or too large.
    """
    try:
        return WindowSpec.model_validate(read_object(path, max_bytes=READERS.max_bytes))
    except ValidationError as error:
        raise StoreError(at(path.name, str(error))) from error


def read_double_walls(path: Path) -> DoubleReport:
    """Read what `double_walls` wrote.

    Raises:
        StoreError: If it is damaged or too large.
    """
    try:
        record = read_object(path, max_bytes=READERS.max_bytes)
        return as_type(record, DoubleReport)
    except msgspec.ValidationError as error:
        raise StoreError(unreadable(path.name, error)) from error


def read_targets(path: Path) -> TargetList:
    """Read what a worker found (`recon4_app.jobs.target_worker`).

    Raises:
        StoreError: If it is damaged or too large.
    """
    try:
        record = read_object(path, max_bytes=READERS.max_bytes)
        return as_type(record, TargetList)
    except msgspec.ValidationError as error:
        raise StoreError(unreadable(path.name, error)) from error
