"""What orders of files and of comparisons share: jobs that are made of the map of a project."""

from __future__ import annotations

import secrets

from fastapi import Request

from recon4.locales.coded import CodedText
from recon4_app.access.people import Permission, person
from recon4_app.deps import ServerParts
from recon4_app.errors import NotFound, Refused
from recon4_app.jobs.model import Inputs, Job, JobKind
from recon4_app.jobs.supervisor import now


def add_order(server: ServerParts, project_id: str, inputs: Inputs, *, request: Request) -> Job:
    """Add a job to the queue; it runs beside jobs that process."""
    job = Job(
        id=secrets.token_hex(8),
        project=project_id,
        inputs=inputs,
        created=now(),
        person=person(request).name,
    )
    server.jobs.add(job)
    server.supervisor.wake(job)
    return job


def find_order(server: ServerParts, project_id: str, job_id: str, *, kind: JobKind) -> Job:
    """The job of a project.

    Raises:
        NotFound: If the project has no job of this kind and id.
    """
    server.projects.folder(project_id)
    job = server.jobs.get(job_id)
    if job.project != project_id or job.kind is not kind:
        raise NotFound(CodedText("order-unknown", project=project_id, job=job_id[:64]))
    return job


def refuse_others(request: Request, job: Job) -> None:
    """Refuse to change what another person ordered, without the permission to process."""
    who = person(request)
    if who.name != job.person and not who.may(Permission.PROCESS):
        raise Refused(
            CodedText("order-of-other", name=job.person)
            if job.person
            else CodedText("order-of-another")
        )


def latest_map_key(server: ServerParts, project_id: str) -> str:
    """Key of the map of the latest run, empty if there is none."""
    found = server.projects.artifact(project_id, "map")
    return found.name if found else ""
