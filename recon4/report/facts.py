"""Facts that the pipeline passes to the report."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from recon4.evaluation.evaluate import Evaluation
from recon4.model.rig_origin import RigOrigin
from recon4.settings import Settings
from recon4.store.project import InputFile


@dataclass(frozen=True, slots=True)
class StageTiming:
    """Time and memory of a stage."""

    stage: str
    seconds: float
    """Wall clock [s]; of the earlier run if it was reused."""
    cpu_seconds: float
    """Processor time [s]."""
    peak_bytes: int
    """Largest resident memory [bytes]."""
    reused: bool = False
    """Result of an earlier run was reused."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ReportFacts:
    """Input of the report. Sections without facts are left out."""

    title: str
    """Name of the recording or project; shown escaped."""
    created: str
    """Time of the run, ISO 8601 UTC."""
    preset: str
    """Name of the preset the settings started from."""
    settings: Settings
    artifacts: Mapping[str, Path] = field(default_factory=dict)
    """Stage -> folder of its artifact (``store.project.read_artifacts``); see
    docs/reference/files.md for the files in each."""
    stages: tuple[StageTiming, ...] = ()
    inputs: tuple[InputFile, ...] = ()
    versions: Mapping[str, str] = field(default_factory=dict)
    """Package -> version; ``recon4`` and ``python`` among them."""
    rig: str = ""
    """Name of the rig."""
    rig_origin: RigOrigin | None = None
    """Serial numbers and calibration of the rig; None = not known."""
    crs: str = ""
    """Name of the map's CRS or ``EPSG:…``; empty = a local frame."""
    evaluation: Evaluation | None = None
    """Evaluation against ground truth; None = there is none."""
