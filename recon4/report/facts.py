"""What the pipeline tells the report."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from recon4.evaluation.evaluate import Evaluation
from recon4.settings import Settings


@dataclass(frozen=True, slots=True)
class StageTiming:
    """What one stage took."""

    stage: str
    seconds: float
    """Wall clock [s]; of the earlier run if it was reused."""
    cpu_seconds: float
    """Processor time [s]."""
    peak_bytes: int
    """Largest resident memory [bytes]."""
    reused: bool = False
    """Found finished from an earlier run."""


@dataclass(frozen=True, slots=True)
class InputFile:
    """A file the result was made from."""

    name: str
    size_bytes: int
    sha256: str


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ReportFacts:
    """Everything the report is written from. What is missing is left out of the report."""

    title: str
    """Name of the recording or project; shown escaped."""
    created: str
    """When the result was made, ISO 8601 UTC."""
    preset: str
    """Name of the preset the settings started from."""
    settings: Settings
    artifacts: Mapping[str, Path] = field(default_factory=dict)
    """Stage -> folder of its artifact (``store.project.read_artifacts``); see
    docs/architecture.md for the files in each."""
    stages: tuple[StageTiming, ...] = ()
    inputs: tuple[InputFile, ...] = ()
    versions: Mapping[str, str] = field(default_factory=dict)
    """Package -> version; ``recon4`` and ``python`` among them."""
    rig: str = ""
    """Name of the rig."""
    crs: str = ""
    """The map's CRS in words or as ``EPSG:…``; empty = a local frame."""
    evaluation: Evaluation | None = None
    """Figures against a truth, when there is one."""
    warnings: tuple[str, ...] = ()
    """Further things a person should know, in words."""
