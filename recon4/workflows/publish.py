"""Write what a finished run leaves in the project folder for people.

What that is depends on the kind of walk: a table of files, `Results`, in
`recon4.workflows.map_results` and `recon4.workflows.planar_results`.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Generic, TypedDict, TypeVar

from recon4.progress import Progress, track
from recon4.settings import values_by_group
from recon4.store.atomic import write_json
from recon4.store.hashing import hash_file
from recon4.store.package_versions import versions
from recon4.store.project import SUMMARY
from recon4.store.seal import changing
from recon4.store.stage import StageRun
from recon4.workflows.earlier_picks import keep_earlier_picks
from recon4.workflows.summary import About, RunSummary, StageSummary, peak_bytes_of, seconds_of

Gathered = TypeVar("Gathered")
"""What the files of a kind of walk are written from."""


@dataclass(frozen=True, slots=True, eq=False)
class FinishedRun:
    """A run whose stages are all done."""

    runs: Mapping[str, StageRun[Any]]
    """How the stages went, in order."""
    about: About
    """Request of the run."""
    created: str
    """When it ended, ISO 8601 UTC."""

    @property
    def folder(self) -> dict[str, Path]:
        """Stage -> folder of its artifact."""
        return {name: run.artifact.folder for name, run in self.runs.items()}


@dataclass(frozen=True, slots=True)
class Results(Generic[Gathered]):
    """What a kind of walk leaves in the project folder."""

    gather: Callable[[FinishedRun], Gathered]
    """Reads from the artifacts what more than one file needs."""
    files: Mapping[str, Callable[[Gathered, Path], None]]
    """Name of a file -> what writes it, in order."""
    summary: Callable[[Path, Gathered], RunSummary]
    """Contents of ``summary.json``, when all files are in the project folder."""


def publish(
    root: Path,
    results: Results[Any],
    runs: Mapping[str, StageRun[Any]],
    *,
    about: About,
    progress: Progress,
) -> RunSummary:
    """Write the results; ``summary.json`` comes last and vouches for the others.

    Args:
        root: The project folder.
        results: What the kind of walk leaves.
        runs: How the stages went, in order.
        about: Request of the run.
        progress: Counts the files.

    Raises:
        StoreError: If an artifact is damaged or the folder cannot be written.
    """
    run = FinishedRun(runs, about, time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime()))
    keep_earlier_picks(root, run.folder, progress)
    with changing(root, SUMMARY, compared=False):
        (root / SUMMARY).unlink(missing_ok=True)
        gathered = results.gather(run)
        files = list(results.files.items())
        for name, write in track(files, progress, what="results", unit="files"):
            write(gathered, root / name)
        summary = results.summary(root, gathered)
        write_json(root / SUMMARY, summary.to_json())
    return summary


class RunKeys(TypedDict):
    """The keys of ``summary.json`` that follow from the run alone; see `RunSummary`."""

    name: str
    created: str
    preset: str
    seconds: float
    peak_bytes: int
    stages: tuple[StageSummary, ...]
    versions: Mapping[str, str]
    settings: Mapping[str, Mapping[str, object]]
    hashes: Mapping[str, Mapping[str, str]]
    folder: Path


def run_keys(root: Path, run: FinishedRun, files: tuple[str, ...]) -> RunKeys:
    """What ``summary.json`` of any map says of the run.

    Args:
        root: The project folder.
        run: The run.
        files: Names of its result files; they are hashed as they are now.
    """
    project = run.about.project
    return {
        "name": project.name,
        "created": run.created,
        "preset": project.preset,
        "seconds": seconds_of(run.runs),
        "peak_bytes": peak_bytes_of(run.runs),
        "stages": tuple(StageSummary.of(stage) for stage in run.runs.values()),
        "versions": versions(),
        "settings": values_by_group(run.about.settings),
        "hashes": {
            "inputs": {file.name: file.sha256 for file in project.inputs},
            "results": {name: hash_file(root / name) for name in files},
        },
        "folder": root,
    }
