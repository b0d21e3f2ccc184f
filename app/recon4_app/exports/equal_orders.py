"""Exports that were ordered before: the same file is made once."""

from __future__ import annotations

from pathlib import Path

from recon4.delivery.kinds import KINDS
from recon4.review.approval_state import WRITTEN_AS_DRAFT, approval_state
from recon4_app.deps import ServerParts
from recon4_app.jobs.model import ExportOrder, Job, JobKind


def equal_order(server: ServerParts, project_id: str, wanted: ExportOrder) -> Job | None:
    """The newest export that gives the same file: it waits, runs, or its file is kept.

    A file counts if it is of the latest map, with the state that its approval has now, unless it
    holds what people add to a finished map.

    Raises:
        NotFound: If there is no such project, or it has no map.
    """
    artifacts, root = server.slices.artifacts(project_id), server.projects.folder(project_id)
    keys = {stage: Path(folder).name for stage, folder in artifacts.items()}
    state = WRITTEN_AS_DRAFT if wanted.options.draft else approval_state(root, keys)
    kind = KINDS.get(wanted.file)  # a delivery is none of them
    may_differ = kind is None or kind.with_notes
    for job in server.jobs.of_project(project_id, JobKind.EXPORT):
        if job.inputs.export != wanted:
            continue
        if not job.over:
            return job
        if may_differ:
            continue
        made = job.made if server.exports.path(job) else None
        if made and (made.map_key, made.approval) == (keys["map"], state.text):
            return job
    return None
