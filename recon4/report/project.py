"""Facts of a finished project for a report that is written again, with an evaluation."""

from __future__ import annotations

from pathlib import Path

import msgspec

from recon4.errors import StoreError
from recon4.evaluation.evaluate import Evaluation
from recon4.locales.coded import CodedText
from recon4.model.rig_origin import RigOrigin
from recon4.report.facts import ReportFacts, StageTiming
from recon4.report.tuning import PROJECT_FACTS
from recon4.store.json_files import read_object
from recon4.store.project import ProjectDescription, read_artifacts
from recon4.store.stage_settings import settings_in
from recon4.untrusted.typed import as_type


class _Stage(msgspec.Struct):
    """A stage in ``summary.json``."""

    stage: str
    seconds: float
    cpu_seconds: float
    peak_bytes: int
    reused: bool


class _Summary(msgspec.Struct):
    """The fields of ``summary.json`` that the report shows."""

    name: str
    created: str
    preset: str
    rig: str
    crs: str
    versions: dict[str, str]
    stages: tuple[_Stage, ...]
    rig_origin: RigOrigin | None = None


def project_facts(root: Path, evaluation: Evaluation | None = None) -> ReportFacts:
    """Facts of the latest run of a project, with its evaluation against ground truth.

    Args:
        root: The project folder, with ``summary.json`` and ``project.json``.
        evaluation: Shown in the section on accuracy; None = there is none.

    Raises:
        StoreError: If there is no finished run, or a file is damaged.
    """
    if not (root / "summary.json").is_file():
        raise StoreError(CodedText("report-no-run", root=str(root)))
    record = read_object(root / "summary.json", max_bytes=PROJECT_FACTS.max_bytes)
    described = ProjectDescription.read(root)
    artifacts = read_artifacts(root)
    try:
        summary = as_type(record, _Summary)
        return ReportFacts(
            title=summary.name,
            created=summary.created,
            preset=summary.preset,
            settings=settings_in(artifacts.values()),
            artifacts=artifacts,
            stages=tuple(_timing(stage) for stage in summary.stages),
            inputs=described.inputs,
            versions=summary.versions,
            rig=summary.rig,
            rig_origin=summary.rig_origin,
            crs=summary.crs,
            evaluation=evaluation,
        )
    except (KeyError, TypeError, msgspec.ValidationError) as error:
        raise StoreError(
            CodedText("file-unreadable", name=f"{root.name}/summary.json", why=repr(error))
        ) from error


def _timing(one: _Stage) -> StageTiming:
    return StageTiming(one.stage, one.seconds, one.cpu_seconds, one.peak_bytes, one.reused)
