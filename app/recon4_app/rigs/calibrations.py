"""What the recording of a project says of its rig: the artifact of the stage ``calibration``."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TypeVar

from pydantic import BaseModel, Field, ValidationError

from recon4.errors import StoreError
from recon4.findings.witnesses.rig import agreement
from recon4.findings.wording import text_of
from recon4.locales.coded import CodedText
from recon4.locales.languages import ENGLISH
from recon4.model.calibration_figures import CalibrationOutcome, GnssOutcome, RigOutcome
from recon4.store.frames import CALIBRATED_RIG, CALIBRATION_SLICES
from recon4.store.json_files import read_object
from recon4.untrusted.names import visible
from recon4_app.errors import NotFound
from recon4_app.projects.store import ProjectStore
from recon4_app.rigs.model import AgreementView, CalibrationSlices, CalibrationView, ParameterView
from recon4_app.rigs.tuning import CALIBRATION_FILES
from recon4_app.rigs.uses import RigUses

_SHOWN = {"rad": (math.degrees(1.0), "°", 3), "m": (100.0, " cm", 2), "s": (1e3, " ms", 2)}
"""Unit -> factor to the unit on screen, its name, decimals."""


_Model = TypeVar("_Model", bound=BaseModel)


class _Outcome(BaseModel):
    """`recon4.model.calibration_figures.CalibrationOutcome` as stored."""

    rig: RigOutcome
    names: tuple[str, ...] = Field(default=(), max_length=20_000)
    gnss: GnssOutcome = GnssOutcome.NOT_COMPARED
    gnss_names: tuple[str, ...] = Field(default=(), max_length=10)


class _Figures(BaseModel):
    """`recon4.model.calibration_figures.CalibrationFigures` as stored."""

    outcome: _Outcome | str = ""
    applied: bool = False
    windows: int = 0
    rms_m: float | None = None
    parameters: list[ParameterView] = Field(default=[], max_length=1000)
    beams: list[ParameterView] = Field(default=[], max_length=20_000)

    def said(self, language: str) -> str:
        """What came of the calibration, in words of a language."""
        kept = self.outcome
        outcome = kept if isinstance(kept, str) else CalibrationOutcome(**kept.model_dump())
        return text_of(agreement(outcome, [row.status for row in self.parameters]), language)


class _Stored(BaseModel):
    """``calibration.json``."""

    figures: _Figures
    before: AgreementView | None = None
    after: AgreementView | None = None


class Calibrations:
    """Reads the audits of all projects."""

    def __init__(self, projects: ProjectStore, uses: RigUses) -> None:
        self._projects, self._uses = projects, uses

    def of(self, project_id: str, language: str = ENGLISH) -> CalibrationView | None:
        """The audit of a project's rig; None = its latest run had none.

        Raises:
            NotFound: If there is no such project.
            StoreError: If the file of the stage is damaged.
        """
        folder = self._projects.artifact(project_id, "calibration")
        if folder is None:
            return None
        stored = _parsed(_Stored, folder / "calibration.json")
        calibrated = folder / CALIBRATED_RIG
        return CalibrationView(
            outcome=visible(stored.figures.said(language), most=400),
            applied=stored.figures.applied and calibrated.is_file(),
            windows=stored.figures.windows,
            rms_m=stored.figures.rms_m,
            parameters=[_visible(row) for row in stored.figures.parameters],
            beams=[_visible(row) for row in stored.figures.beams],
            before=stored.before,
            after=stored.after,
            rig=self._uses.of_project(project_id),
            saved=self._uses.with_file(calibrated) if calibrated.is_file() else None,
        )

    def slices(self, project_id: str) -> CalibrationSlices | None:
        """Slices before and after the calibration of a project's rig; None = there are none.

        Raises:
            NotFound: If there is no such project.
            StoreError: If the file of the stage is damaged.
        """
        folder = self._projects.artifact(project_id, "calibration")
        if folder is None or not (folder / CALIBRATION_SLICES).is_file():
            return None
        found = _parsed(CalibrationSlices, folder / CALIBRATION_SLICES)
        lidars = [one.model_copy(update={"name": visible(one.name)}) for one in found.lidars]
        return found.model_copy(update={"lidars": lidars})

    def file(self, project_id: str) -> Path:
        """The calibrated rig of a project.

        Raises:
            NotFound: If there is no such project, or its rig was not calibrated.
        """
        folder = self._projects.artifact(project_id, "calibration")
        path = folder / CALIBRATED_RIG if folder else None
        if path is None or not path.is_file():
            raise NotFound(CodedText("rig-not-calibrated", project=project_id))
        return path


def evidence_of(view: CalibrationView, project_id: str) -> str:
    """The evidence for a calibrated rig as text, a line for each parameter that changed."""
    lines = [f"Calibrated from the recording of project {project_id}. {view.outcome}"]
    lines += [_line(row) for row in view.parameters if row.status == "off"]
    unknown = [row for row in view.parameters if row.status == "not observable"]
    if unknown:
        names = ", ".join(" ".join(_names(row)) for row in unknown)
        lines.append(f"Not observable: {names}.")
    lines += _agreement_lines(view.before, view.after)
    lines.append(f"{view.windows} windows of the walk.")
    return "\n".join(lines)


def _line(row: ParameterView) -> str:
    factor, unit, digits = _SHOWN[row.unit]
    sd = "" if row.sd is None else f" ± {row.sd * factor:.{digits}f}{unit}"
    return f"{' '.join(_names(row))}: {row.change * factor:+.{digits}f}{unit}{sd}"


def _names(row: ParameterView) -> Sequence[str]:
    return [part for part in (row.sensor, row.quantity, row.axis) if part]


def _agreement_lines(before: AgreementView | None, after: AgreementView | None) -> list[str]:
    if before is None or after is None:
        return []
    rows = [
        ("distance of points from common planes", before.rms_m, after.rms_m),
        ("between surfaces as seen by two LiDARs", before.offset_m, after.offset_m),
    ]
    unused = "Windows that were not used"
    return [
        f"{unused}, {name}: {1e3 * first:.1f} mm before, {1e3 * last:.1f} mm after"
        for name, first, last in rows
        if first is not None and last is not None
    ]


def _parsed(kind: type[_Model], path: Path) -> _Model:
    found = read_object(path, max_bytes=CALIBRATION_FILES.max_calibration_bytes)
    try:
        return kind.model_validate(found)
    except ValidationError as error:
        first = error.errors()[0]
        place = ".".join(map(str, first["loc"]))
        raise StoreError(
            CodedText("calibration-unreadable", file=path.name, place=place, first=first["msg"])
        ) from error


def _visible(row: ParameterView) -> ParameterView:
    texts = {name: visible(getattr(row, name)) for name in ("sensor", "quantity", "axis")}
    return row.model_copy(update=texts)
