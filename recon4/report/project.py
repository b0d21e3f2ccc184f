"""Facts of a finished project for a report that is written again, with an evaluation."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from recon4.errors import StoreError
from recon4.evaluation.evaluate import Evaluation
from recon4.report.facts import InputFile, ReportFacts, StageTiming
from recon4.store.json_files import read_object
from recon4.store.project import read_artifacts, read_description
from recon4.store.recipes import settings_in

_MAX_BYTES = 16 << 20


def project_facts(root: Path, evaluation: Evaluation) -> ReportFacts:
    """Facts of the latest run of a project, with its evaluation against ground truth.

    Args:
        root: The project folder, with ``summary.json`` and ``project.json``.
        evaluation: Shown in the section on accuracy.

    Raises:
        StoreError: If there is no finished run, or a file is damaged.
    """
    if not (root / "summary.json").is_file():
        raise StoreError(f"expected a project with a finished run, got {root}")
    summary = read_object(root / "summary.json", max_bytes=_MAX_BYTES)
    described = read_description(root)
    artifacts = read_artifacts(root)
    try:
        return ReportFacts(
            title=summary["name"],
            created=summary["created"],
            preset=summary["preset"],
            settings=settings_in(artifacts.values()),
            artifacts=artifacts,
            stages=tuple(_timing(stage) for stage in summary["stages"]),
            inputs=tuple(
                InputFile(file["name"], file["bytes"], file["sha256"])
                for file in described.get("inputs", [])
            ),
            versions=summary["versions"],
            rig=summary["rig"],
            crs=summary["crs"],
            evaluation=evaluation,
            warnings=_later_warnings(summary),
        )
    except (KeyError, TypeError) as error:
        raise StoreError(f"{root.name}/summary.json cannot be read: {error!r}") from error


def _timing(stage: dict[str, Any]) -> StageTiming:
    return StageTiming(
        stage["stage"],
        stage["seconds"],
        stage["cpu_seconds"],
        stage["peak_bytes"],
        stage["reused"],
    )


def _later_warnings(summary: dict[str, Any]) -> tuple[str, ...]:
    """Warnings of the stages after the import; the report reads those of the import itself."""
    imported = [stage["figures"] for stage in summary["stages"] if stage["stage"] == "frames"]
    known = {text for figures in imported for text in figures["warnings"]}
    return tuple(text for text in summary["warnings"] if text not in known)
