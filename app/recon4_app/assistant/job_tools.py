"""The tool that watches a job, and those that start, stop and decide."""

from __future__ import annotations

from collections.abc import AsyncIterator
from typing import Annotated, Any, Literal

import anyio
from mcp.server.mcpserver import Context
from mcp.server.mcpserver.exceptions import ToolError
from pydantic import Field

from recon4_app.assistant.arguments import JobId, JobRequest, Pair, ProjectId, Why
from recon4_app.assistant.http_client import ServerClient
from recon4_app.assistant.records import ReviewFacts, WatchedJob
from recon4_app.assistant.tuning import ASSISTANT


class WatchTools:
    """The tool that waits for jobs."""

    def __init__(self, server: ServerClient) -> None:
        self._server = server

    async def watch_job(
        self,
        job: JobId,
        context: Context[Any, Any],
        *,
        until: Literal["end", "stage"] = "end",
        wait_s: Annotated[float, Field(ge=0.0, le=ASSISTANT.longest_wait_s)] = 60.0,
    ) -> WatchedJob:
        """Watch a job until it ends (or its stage changes), at most for `wait_s` seconds.

        Returns its state then; call it again if it still runs. Progress is reported meanwhile.
        """
        view = await self._server.get(f"api/jobs/{job}", WatchedJob)
        stage = view.stage
        with anyio.move_on_after(wait_s):
            async with self._server.job_events() as events:
                # the stream says nothing of jobs that ended before it began
                view = await self._server.get(f"api/jobs/{job}", WatchedJob)
                while not view.over and not (until == "stage" and view.stage != stage):
                    await context.report_progress(view.run_progress, 1.0, view.status.what)
                    view = await _next_of(job, events)
        return view


async def ended_job(server: ServerClient, job: str, *, wait_s: float) -> WatchedJob:
    """A job when it has ended, or as it is after some time.

    Raises:
        ToolError: If the server cannot be asked.
    """
    view = await server.get(f"api/jobs/{job}", WatchedJob)
    with anyio.move_on_after(wait_s):
        async with server.job_events() as events:
            view = await server.get(f"api/jobs/{job}", WatchedJob)
            while not view.over:
                view = await _next_of(job, events)
    return view


async def _next_of(job: str, events: AsyncIterator[WatchedJob]) -> WatchedJob:
    """The next event of a job.

    Raises:
        ToolError: If the stream ended, with the server or with the session; jobs go on.
    """
    async for view in events:
        if view.job.id == job:
            return view
    raise ToolError("the server ended the stream of events; the job goes on: watch it again")


class ActTools:
    """Tools that change something on the server; they exist only if the person allowed it."""

    def __init__(self, server: ServerClient) -> None:
        self._server = server

    async def start_job(self, job: JobRequest) -> WatchedJob:
        """Start a job that makes a map of recordings. Inspect them first."""
        return await self._server.post("api/jobs", WatchedJob, job.model_dump())

    async def resume_job(self, job: JobId) -> WatchedJob:
        """Run a failed or canceled job again; it continues after its last finished stage."""
        return await self._server.post(f"api/jobs/{job}/retry", WatchedJob)

    async def cancel_job(self, job: JobId) -> WatchedJob:
        """Stop a job; its finished stages are kept."""
        return await self._server.post(f"api/jobs/{job}/cancel", WatchedJob)

    async def decide_loop(
        self,
        project: ProjectId,
        pair: Pair,
        *,
        kind: Literal["accept", "reject", "restore"],
        why: Why,
        seen_decisions: Annotated[
            int, Field(ge=0, description="`decisions` of `project_summary` when you looked.")
        ],
    ) -> ReviewFacts:
        """Accept or reject a loop closure, or restore the automatic verdict, with a reason.

        The journal keeps it under the name of the person. Rebuild the map afterwards.
        """
        body = {"kind": kind, "frame_i": pair[0], "frame_j": pair[1], "why": why}
        path = f"api/projects/{project}/review/decisions"
        return await self._server.post(path, ReviewFacts, {**body, "seen_seq": seen_decisions})

    async def undo_decision(self, project: ProjectId, why: Why, seen_decisions: int) -> ReviewFacts:
        """Undo the last decision of a review; the journal keeps both."""
        path = f"api/projects/{project}/review/undo"
        return await self._server.post(path, ReviewFacts, {"why": why, "after_seq": seen_decisions})

    async def rebuild_map(self, project: ProjectId) -> WatchedJob:
        """Apply the decisions about loop closures: runs only the stages that depend on them."""
        return await self._server.post(f"api/projects/{project}/remake", WatchedJob)
