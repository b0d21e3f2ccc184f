"""What ``summary.json`` says of every finished run, with a 3-D or a 2-D map."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any

from recon4.findings.wording import said
from recon4.model.figures import Figures
from recon4.model.finding import Finding
from recon4.model.plain import to_plain
from recon4.model.trajectory import Trajectory
from recon4.model.usability import MapVerdict
from recon4.report.facts import StageTiming
from recon4.settings import Settings
from recon4.store.formats import FORMATS
from recon4.store.ledger import FinishedStage
from recon4.store.project import ProjectDescription
from recon4.store.stage import StageRun


@dataclass(frozen=True, slots=True)
class About:
    """Request of a run."""

    project: ProjectDescription
    settings: Settings
    """In force."""


@dataclass(frozen=True, slots=True, kw_only=True)
class StageSummary:
    """How a stage went; the fields are its keys in ``summary.json``."""

    key: str
    """Of its artifact."""
    stage: str
    version: int
    finished: str
    """When its artifact was made, ISO 8601 UTC."""
    seconds: float
    """Wall clock [s]."""
    cpu_seconds: float
    """Processor time, children included [s]."""
    peak_bytes: int
    reused: bool
    """Whether an earlier run made it."""
    figures: Figures

    @staticmethod
    def of(run: StageRun[Any]) -> StageSummary:
        """The summary of a stage that ran."""
        done = spent(run)
        return StageSummary(
            key=done.key,
            stage=done.stage,
            version=done.version,
            finished=done.finished,
            seconds=round(done.seconds, 3),
            cpu_seconds=round(done.cpu_seconds, 3),
            peak_bytes=done.peak_bytes,
            reused=run.reused,
            figures=run.figures,
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class RunSummary:
    """The keys of ``summary.json`` that all maps have."""

    name: str
    """Of the project."""
    created: str
    """When the run ended, ISO 8601 UTC."""
    preset: str
    """What the settings started from."""
    duration_s: float
    """Time covered by the trajectory [s]."""
    path_length_m: float
    """Path length, in steps of half a second [m]."""
    edges: Mapping[str, int]
    """Edges by verdict, as ``edges.json`` has them."""
    verdict: MapVerdict
    findings: tuple[Finding, ...]
    """Worst first; written with their title, text and remedy."""
    seconds: float
    """Wall clock of all stages, of the earlier run where reused [s]."""
    peak_bytes: int
    """Largest resident memory of any stage [bytes]."""
    stages: tuple[StageSummary, ...]
    """How each stage went, in order."""
    versions: Mapping[str, str]
    settings: Mapping[str, Mapping[str, object]]
    """Group -> setting -> value."""
    hashes: Mapping[str, Mapping[str, str]]
    """SHA-256 of ``inputs`` and of ``results``, by file name."""
    folder: Path
    """The project; not written, so that it may be moved."""

    def to_json(self) -> dict[str, object]:
        """Plain JSON values."""
        names = [one.name for one in fields(self) if one.name != "folder"]
        record = {name: to_plain(getattr(self, name)) for name in names}
        record["findings"] = [to_plain(said(finding)) for finding in self.findings]
        return {"format": FORMATS.summary} | record


def duration_s(trajectory: Trajectory) -> float:
    """Time covered by a trajectory [s]."""
    return round(int(trajectory.t_ns[-1] - trajectory.t_ns[0]) / 1e9, 3)


def spent(run: StageRun[Any]) -> FinishedStage:
    """The record of a stage with the time and memory of all its times in this run."""
    times = (*run.before, run.done)
    return replace(
        run.done,
        seconds=sum(done.seconds for done in times),
        cpu_seconds=sum(done.cpu_seconds for done in times),
        peak_bytes=max(done.peak_bytes for done in times),
    )


def timings(runs: Mapping[str, StageRun[Any]]) -> tuple[StageTiming, ...]:
    """Time and memory of all stages, for the report."""
    spents = ((name, run.reused, spent(run)) for name, run in runs.items())
    return tuple(
        StageTiming(name, done.seconds, done.cpu_seconds, done.peak_bytes, reused)
        for name, reused, done in spents
    )


def seconds_of(runs: Mapping[str, StageRun[Any]]) -> float:
    """Wall clock of all stages, of the earlier run where reused [s]."""
    return round(sum(spent(run).seconds for run in runs.values()), 3)


def peak_bytes_of(runs: Mapping[str, StageRun[Any]]) -> int:
    """Largest resident memory of any stage [bytes]."""
    return max(spent(run).peak_bytes for run in runs.values())
