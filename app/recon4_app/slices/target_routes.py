"""HTTP routes that find survey targets in a whole map."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated

from fastapi import APIRouter, Depends, Query
from starlette.concurrency import run_in_threadpool

from recon4.slices.targets.named import TargetList
from recon4_app.access.people import Permission, needs
from recon4_app.deps import Server
from recon4_app.error_responses import problems
from recon4_app.network.request_caller import CalledBy
from recon4_app.slices import readers, target_work

LOOK = [Depends(needs(Permission.LOOK))]
TARGETS = "targets.json"
"""Name of the file that a child process writes in its working folder."""

router = APIRouter(
    prefix="/api/projects/{project_id}/slices/control/targets",
    tags=["slices"],
    responses=problems(404, 422),
)


@router.get("", dependencies=LOOK, summary="Find survey targets")
async def find_targets(
    project_id: str,
    server: Server,
    *,
    caller: CalledBy,
    crs: Annotated[str, Query(max_length=64)] = "",
) -> TargetList:
    """Plates, boards and spheres of the whole map, named by the stored survey; proposals only."""
    slices = server.slices
    folder = (await run_in_threadpool(slices.artifacts, project_id))["map"]
    state = await run_in_threadpool(slices.control, project_id)
    radii = sorted({round(one.radius_m, 4) for one in state.points if one.radius_m > 0.0})
    terms = slices.terms(project_id, caller.name)
    sizes = "-".join(f"{1e4 * one:.0f}" for one in radii[:8])
    path = await caller.wait(
        slices.kept(
            f"{Path(folder).name}-targets-{sizes}.json",
            lambda out: slices.run_background(
                replace(terms, outputs={TARGETS: out}),
                target_work.search_targets,
                folder,
                radii[:8],
                TARGETS,
            ),
        )
    )
    found = await run_in_threadpool(readers.read_targets, path)
    return await caller.wait(
        slices.run_interactive(terms, target_work.name_targets, found, state, crs)
    )
