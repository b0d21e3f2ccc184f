"""Recipes of a folder of clouds: a declared one, compared with the files, or a proposed one."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from recon4.errors import RecordingError
from recon4.model.point_recipes import PointRecipe
from recon4.recording.formats.cloud_files import Table, read_cloud
from recon4.recording.formats.point_messages import POINTS
from recon4.recording.recipes.check import RecipeSample, require_fitting
from recon4.recording.recipes.propose import propose, say_overlooked
from recon4.recording.recipes.refuse import require_known, with_doubts
from recon4.recording.report import ImportReport
from recon4.recording.rigs.choice import Stream
from recon4.recording.tuning import PROBE


def require_fields(
    folder: str,
    files: Sequence[Path],
    fields: PointRecipe | None,
    *,
    period_s: float,
    report: ImportReport,
) -> None:
    """Compare the recipe of the clouds with the first ones; without one, say what it could be.

    Args:
        folder: Name, for messages.
        files: Clouds.
        fields: The recipe; None = the columns have common names.
        period_s: Time from cloud to cloud [s].
        report: Receives what is suspicious, and columns that look like more.

    Raises:
        ConfigError: If the recipe does not fit, or one is needed.
    """
    sample = RecipeSample(folder, [{POINTS: table} for table in _first(files)], period_s)
    if fields is not None:
        require_fitting(fields, sample, report)
        return
    if not sample.lists:
        return  # each damaged file is said when it is read
    columns = sample.largest[POINTS]
    proposal = with_doubts(propose(folder, sample.largest, period_s), sample)
    if {"x", "y", "z"} <= set(columns):
        say_overlooked(folder, proposal, columns, report=report)
    elif proposal.recipe is not None:
        stream = Stream(folder, "generic", fields=proposal.recipe)
        require_known([(stream, proposal)], folder)


def _first(files: Sequence[Path]) -> list[Table]:
    """The first clouds that can be read."""
    found = []
    for file in files[: PROBE.files]:
        try:
            found.append(read_cloud(file))
        except RecordingError:
            continue
    return found
