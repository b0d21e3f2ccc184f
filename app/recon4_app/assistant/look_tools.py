"""Tools that only look: projects, findings, runs, loop closures, recordings."""

from __future__ import annotations

from typing import Annotated

from mcp.server.mcpserver.exceptions import ToolError
from pydantic import Field

from recon4.errors import Recon4Error
from recon4.findings.explain import explained, listed
from recon4_app.assistant.arguments import AnyProject, ProjectId
from recon4_app.assistant.comparing import compare, figures_of
from recon4_app.assistant.http_client import ServerClient
from recon4_app.assistant.records import (
    JobRow,
    LoopPairs,
    LoopQueue,
    ProjectFacts,
    ProjectList,
    ProjectReading,
    ProjectRow,
    RecordingFacts,
    ReviewFacts,
    RunComparison,
    ServerFile,
    WatchedJob,
)
from recon4_app.assistant.tuning import ASSISTANT


class LookTools:
    """Tools that change nothing. Their docstrings are what an assistant reads of them."""

    def __init__(self, server: ServerClient) -> None:
        self._server = server

    async def list_projects(
        self,
        search: Annotated[str, Field(description="Part of a name or a tag; empty = all.")] = "",
        archived: Annotated[bool, Field(description="Also those that people archived.")] = False,
        most: Annotated[int, Field(ge=1, le=ASSISTANT.most_projects)] = 50,
    ) -> ProjectList:
        """List projects, the newest first: verdict, size, approval of each."""
        rows = await self._server.get("api/projects", list[ProjectRow])
        wanted = search.strip().lower()
        found = [
            row
            for row in rows
            if wanted in " ".join([row.name, row.id, *row.tags]).lower()
            and (archived or not row.archived)
        ]
        return ProjectList(total=len(found), projects=found[:most])

    async def project_summary(self, project: ProjectId) -> ProjectReading:
        """Read a project: verdict on its map, findings with stretch and place, figures, approval.

        The verdict is that of the worst finding. Quote the code of a finding (`kind`), and give
        people the address of the page.
        """
        facts = await self._facts(project)
        review = await self._server.get(f"api/projects/{project}/review", ReviewFacts)
        return ProjectReading(
            id=facts.id,
            name=facts.name,
            page=f"{self._server.url}projects/{facts.id}/",
            finished=facts.finished,
            busy=review.busy,
            updated=facts.updated,
            bytes=facts.bytes,
            preset=facts.preset,
            rig=facts.rig,
            verdict=review.map.verdict if review.map else None,
            findings=review.map.findings if review.map else None,
            figures=figures_of(facts.summary),
            approval=facts.approval,
            decisions=review.seq,
            decisions_in_map=review.in_map,
            problem=facts.problem,
        )

    async def explain_finding(
        self,
        code: Annotated[str, Field(description="As TIME-GAP; empty = list all codes.")] = "",
    ) -> str:
        """Explain a code of a finding: what it means, how it is detected, what to do about it."""
        try:
            return explained(code) if code.strip() else listed()
        except Recon4Error as error:
            raise ToolError(str(error)) from error

    async def compare_runs(self, first: ProjectId, second: ProjectId) -> RunComparison:
        """Compare the latest runs of two projects: verdicts, findings, figures and settings.

        Only what differs is listed. To try other settings, start a job with `clone_of`, then
        compare the clone with the original.
        """
        summaries = [(await self._facts(one)).summary for one in (first, second)]
        for name, summary in zip((first, second), summaries, strict=True):
            if not summary:
                raise ToolError(f"{name} has no finished run to compare")
        try:
            return compare(*summaries)
        except Recon4Error as error:
            raise ToolError(str(error)) from error

    async def list_jobs(self, project: AnyProject = "") -> list[JobRow]:
        """List all jobs of a project, or the newest of each: state, inputs, what went wrong."""
        path = f"api/projects/{project}/jobs" if project else "api/jobs"
        return [view.job for view in await self._server.get(path, list[WatchedJob])]

    async def list_loops(
        self,
        project: ProjectId,
        most: Annotated[int, Field(ge=1, le=ASSISTANT.most_pairs)] = 20,
    ) -> LoopPairs:
        """List pairs of multiframes to decide about (loop closures), by influence on the map."""
        queue = await self._server.get(f"api/projects/{project}/review/queue", LoopQueue)
        pairs = [dict(zip(queue.columns, row, strict=True)) for row in queue.rows[:most]]
        return LoopPairs(total=len(queue.rows), limit_m=queue.limit_m, pairs=pairs)

    async def browse_recordings(
        self,
        folder: Annotated[
            str, Field(description="Path on the server's computer; empty = where recordings lie.")
        ] = "",
    ) -> list[ServerFile]:
        """List files and folders on the server's computer that a job may read."""
        return await self._server.get("api/recordings", list[ServerFile], {"folder": folder})

    async def inspect_recording(
        self, path: Annotated[str, Field(description="A path of `browse_recordings`.")]
    ) -> RecordingFacts:
        """Say what a recording holds, what is missing, and which inputs suit it."""
        return await self._server.get("api/look", RecordingFacts, {"path": path})

    async def _facts(self, project: str) -> ProjectFacts:
        return await self._server.get(f"api/projects/{project}", ProjectFacts)
