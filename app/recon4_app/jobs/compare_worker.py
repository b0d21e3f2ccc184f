"""The worker of a comparison: ``python -m recon4_app.jobs.compare_worker JOB_FOLDER``.

It may read its two projects only, and write its own folder only.
"""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

from recon4.delivery.kinds import ExportedFile
from recon4.errors import ConfigError
from recon4.locales.coded import CodedText
from recon4.progress import Progress
from recon4.review.approval_state import latest_state
from recon4.sandbox import Policy
from recon4.store.atomic import make_folders
from recon4.system.stopping import end_process
from recon4_app.jobs.export_worker import policy as export_policy
from recon4_app.jobs.folder import JobFolder
from recon4_app.jobs.model import CompareOrder
from recon4_app.jobs.worker import main


def compare(folder: JobFolder, progress: Progress) -> ExportedFile:
    """Compare the maps that a job names.

    Raises:
        Altered: If a map was approved and is not what was approved.
        ConfigError: If they have no common frame, or there is nothing to compare.
        NoSpace: If the disk is full.
    """
    from recon4.comparison.common_frame import open_side
    from recon4.comparison.run import MapPair
    from recon4.comparison.write import write_comparison

    project = folder.request().project
    order = _order(folder)
    make_folders(folder.made)
    path = folder.made / f"{project.name}-differences.laz"
    pair = MapPair.of(open_side(project), open_side(_other_map(project, order)), align=order.align)
    found = write_comparison(pair, path, core_spacing_m=order.core_spacing_m, progress=progress)
    points = found.counts.core_points
    made = ExportedFile.of(
        path,
        f"{points} core points",
        latest_state(project),
        map_key=found.first.key,
        progress=progress,
    )
    return replace(made, points=points)


def policy(folder: JobFolder) -> Policy:
    """The sandbox policy: read both projects and who may approve them, write the job's folder."""
    project = folder.request().project
    allowed = export_policy(folder)
    return replace(allowed, read=(*allowed.read, _other_map(project, _order(folder))))


def _order(folder: JobFolder) -> CompareOrder:
    order = folder.request().inputs.compare
    if order is None:
        raise ConfigError(CodedText("comparison-no-order"))
    return order


def _other_map(project: Path, order: CompareOrder) -> Path:
    """The other project, or the folder of an earlier map; the server has checked the name."""
    kind, _, name = order.against.partition(":")
    if Path(name).name != name:
        raise ConfigError(CodedText("comparison-map-unknown", map=order.against))
    return project.parent / name if kind == "project" else project / "artifacts" / name


if __name__ == "__main__":
    end_process(lambda _: main(Path(sys.argv[1]), compare, policy))
