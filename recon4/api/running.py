"""From recordings to a finished project."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

from recon4.api.project import MapProject, open_project
from recon4.cli.kernel_cache import settle_kernel_cache
from recon4.recording.sources import Sources

if TYPE_CHECKING:
    from recon4.model.events import Event

OnProgress = Callable[[str, int, int], None]
"""Is called with the piece of work, and with how many units are done and how many there are."""


def process(
    recording: str | PathLike[str] | Sources,
    out: str | PathLike[str],
    *,
    preset: str = "indoor",
    settings: Mapping[str, object] | None = None,
    on_progress: OnProgress | None = None,
) -> MapProject:
    """Make a map of a recording, or continue where an earlier call stopped.

    Args:
        recording: A file or folder; `Sources.of` for several, a rig, or samples from CSV files.
        out: Project folder; made when missing. The result files end up in it.
        preset: What the settings start from: ``indoor``, ``outdoor``, ``hector``,
            ``thesis`` or ``wuerzburg``.
        settings: Name -> value, as ``{"map.voxel_m": 0.02}``; `recon4 settings` lists them.
        on_progress: Called often with what is done, the units done and the units in all (0 = not
            known). Raise `errors.Cancelled` in it to stop; the next call continues from there.

    Returns:
        The finished project.

    Raises:
        RecordingError: If a recording cannot be read.
        ConfigError: If a setting, a preset or the rig is wrong.
        StoreError: If ``out`` is in use, damaged or cannot be written (`NoSpace`: disk full).
        Recon4Error: Whatever else stops a stage.

    >>> files = {"imu": "recording/imu.csv", "rig": "recording/rig.toml"}
    >>> sources = api.Sources.of("recording/recording.pcap", **files)
    >>> project = api.process(sources, "walk", settings={"map.voxel_m": 0.05})
    >>> project.summary.lost
    0
    """
    settle_kernel_cache()
    from recon4 import pipeline
    from recon4.progress import Silent
    from recon4.settings import override
    from recon4.settings import preset as settings_of

    sources = recording if isinstance(recording, Sources) else Sources.of(recording)
    sources.require()
    chosen = override(
        settings_of(preset), [f"{name}={value}" for name, value in (settings or {}).items()]
    )
    _warn_of(sources)
    progress = Reported(on_progress) if on_progress else Silent()
    pipeline.process(sources, Path(out), settings=chosen, preset=preset, progress=progress)
    return open_project(out)


def _warn_of(sources: Sources) -> None:
    """Warn the caller of `process` of files that are not read, or read in place of others."""
    from recon4.recording.info.nearby_samples import unread_samples
    from recon4.recording.kinds import located_elsewhere

    for text in (*unread_samples(sources), *located_elsewhere(sources)):
        warnings.warn(text, stacklevel=3)


@dataclass(slots=True)
class Reported:
    """Progress as calls of a function."""

    call: OnProgress
    what: str = ""
    done: int = 0
    total: int = 0

    def start(self, what: str, total: int, unit: str) -> None:
        """Begin a piece of work."""
        self.what, self.done, self.total = what, 0, total
        self.call(what, 0, total)

    def advance(self, done: int = 1) -> None:
        """Count."""
        self.done += done
        self.call(self.what, self.done, self.total)

    def event(self, event: Event) -> None:
        """Leave out: what is found stands in the project."""
