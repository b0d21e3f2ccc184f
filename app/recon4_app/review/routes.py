"""HTTP routes of the review."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Annotated, TypeVar

import numpy as np
from fastapi import APIRouter, Depends, Query, Response
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request

from recon4.findings.in_language import summary_in
from recon4.findings.summary_notes import findings_in, notes_in
from recon4.locales.coded import CodedText, coded, said
from recon4.model.plain import finite_or_none
from recon4.model.usability import verdict_in
from recon4.review.approval import NotApprovable, make_read_only, reason_needed, signed_figures
from recon4.review.approval import approve as sign
from recon4.review.approved import Approval
from recon4.review.decisions import CHANGE_NOTHING, Decided, Decision, DecisionKind, fold
from recon4.review.journal import JournalChanged, JournalRow, NothingToUndo, append, read_rows
from recon4.review.newest_approval import judging_folders
from recon4.review.pairs import (
    PairFacts,
    TrajectoryNodes,
    align,
    fit_points,
    pair_facts,
    pair_points,
    trajectory_nodes,
)
from recon4.review.preview import Effect
from recon4.review.source import Source, graph_key
from recon4.review.state import artifact_keys, decisions_in_map, read_summary
from recon4.review.teamwork import second_opinion_missing, team_work
from recon4.review.trusted_keys import SIGNING_KEY, ensure_own_key
from recon4.review.tuning import APPROVALS
from recon4_app.access.audit import audit
from recon4_app.access.people import Permission, needs, recent_login
from recon4_app.compute_pool.model import FileAccess, Lane, Terms
from recon4_app.deps import Server, ServerParts
from recon4_app.error_responses import problems
from recon4_app.errors import Conflict, project_page
from recon4_app.network.request_caller import CalledBy, Caller
from recon4_app.review.model import (
    AlignmentView,
    Approve,
    Frame,
    MapFacts,
    NewDecision,
    PointPairs,
    PredictedPose,
    ReviewView,
    RowView,
    StandingView,
    Step,
    SupersededEffect,
    work_view,
)
from recon4_app.review.newest_approvals import record_signed
from recon4_app.review.reader import ReadBy, Reader
from recon4_app.review.store import terms_of
from recon4_app.review.tuning import SIGNING

T = TypeVar("T")

LOOK = [Depends(needs(Permission.LOOK))]
REVIEW = [Depends(needs(Permission.REVIEW))]
SIGN = [Depends(needs(Permission.REVIEW)), Depends(recent_login)]
PREFIX = "/api/projects/{project_id}/review"

router = APIRouter(
    prefix=PREFIX,
    tags=["review"],
    responses=problems(403, 404, 409),
)


@router.get("", dependencies=LOOK, summary="State of the review")
def read_review(project_id: str, server: Server, reader: ReadBy) -> ReviewView:
    """Decisions in force, undo and redo counts, and whether the map includes the decisions."""
    return view_of(project_id, server, reader)


@router.get("/queue", dependencies=LOOK, summary="Pairs to decide about")
async def read_queue(project_id: str, server: Server, caller: CalledBy) -> Response:
    """All pairs except odometry: good registrations first, then weak ones, by influence.

    ``columns`` names the values of each of the ``rows``. Figures are those before any decision.
    """
    root = server.projects.folder(project_id)
    source = await run_in_threadpool(Source.of, root)
    record = await caller.wait(server.reviews.queue(root, source, person=caller.name))
    return Response(record, media_type="application/json")


def _pair(frame_i: Frame, frame_j: Frame) -> tuple[int, int]:
    """The multiframes of a pair, from the query."""
    return frame_i, frame_j


@router.get("/walk", dependencies=LOOK, summary="Nodes along the trajectory")
async def read_walk(project_id: str, server: Server, caller: CalledBy) -> TrajectoryNodes:
    """Nodes of the graph: multiframe, seconds since the start, position."""
    return await _of_pairs(server, caller, trajectory_nodes, project_id=project_id)


@router.get("/pair", dependencies=LOOK, summary="One pair")
async def read_pair(
    project_id: str, server: Server, caller: CalledBy, *, frame_i: Frame, frame_j: Frame
) -> PairFacts:
    """Poses of a pair, registered or not, and its alternative paths."""
    return await _of_pairs(server, caller, pair_facts, (frame_i, frame_j), project_id=project_id)


@router.get("/points", dependencies=LOOK, summary="Points of a pair")
async def read_points(
    project_id: str,
    server: Server,
    caller: CalledBy,
    *,
    pair: Annotated[tuple[int, int], Depends(_pair)],
    reach: Annotated[int, Query(ge=0, le=10)] = 0,
) -> Response:
    """Points of two multiframes and ``reach`` others before and after each, at most 30 000 each.

    Little-endian: ``R4PP``, uint32 version (1), uint32 numbers of points of i and of j, then
    float32 x y z of the points of i in the body frame at i, then of j at j [m].
    """
    record = await _of_pairs(server, caller, pair_points, pair, reach, project_id=project_id)
    return Response(record, media_type="application/octet-stream")


@router.post("/align", dependencies=REVIEW, summary="Register a pair")
async def align_pair(
    project_id: str, predicted: PredictedPose, server: Server, *, caller: CalledBy
) -> AlignmentView:
    """Register two multiframes like the loop closure search, from a predicted pose.

    The journal is not changed.
    """
    root, pair = server.projects.folder(project_id), (predicted.frame_i, predicted.frame_j)
    found = await _of_pairs(
        server, caller, align, pair, tuple(predicted.T_i_j), project_id=project_id
    )
    measured = found.measurement
    return AlignmentView(
        measurement=server.reviews.remember(root, pair, found) if found.converged else "",
        T_i_j=list(measured.T_i_j),
        converged=found.converged,
        reason=found.reason,
        overlap=finite_or_none(measured.overlap),
        error_m=finite_or_none(measured.error_m),
        limit_m=finite_or_none(measured.limit_m),
        degeneracy=finite_or_none(measured.degeneracy),
        iterations=measured.iterations,
    )


@router.post("/fit", dependencies=REVIEW, summary="Fit picked points")
def fit_picked(project_id: str, picked: PointPairs, server: Server) -> list[float]:
    """``T_i_j`` that aligns the points of the second multiframe with those of the first.

    The journal is not changed.
    """
    server.projects.folder(project_id)  # raises if there is none
    return list(fit_points(np.array(picked.p_i), np.array(picked.p_j)))


@router.post("/decisions", status_code=201, dependencies=REVIEW, summary="Decide")
def decide(project_id: str, new: NewDecision, server: Server, *, reader: ReadBy) -> ReviewView:
    """Append a decision to the journal; it is on disk before the response is sent."""
    root, pair = server.projects.folder(project_id), (new.frame_i, new.frame_j)
    measured = new.kind in ("replace", "add")
    decision = Decision(
        kind=DecisionKind(new.kind),
        who=reader.who.name,
        why=new.why,
        pair=pair,
        T_i_j=tuple(new.T_i_j),
        measurement=server.reviews.measurement(root, pair, new.measurement) if measured else None,
    )
    try:
        append(root, decision, seen_seq=new.seen_seq)
    except JournalChanged as error:
        raise Conflict(coded(error)) from error
    return view_of(project_id, server, reader)


@router.post("/undo", status_code=201, dependencies=REVIEW, summary="Undo")
def undo(project_id: str, step: Step, server: Server, *, reader: ReadBy) -> ReviewView:
    """Undo the last decision, by any reviewer."""
    return _step(DecisionKind.UNDO, project_id, step, server=server, reader=reader)


@router.post("/redo", status_code=201, dependencies=REVIEW, summary="Redo")
def redo(project_id: str, step: Step, server: Server, *, reader: ReadBy) -> ReviewView:
    """Redo the decision that was undone last."""
    return _step(DecisionKind.REDO, project_id, step, server=server, reader=reader)


@router.get("/effect", dependencies=LOOK, summary="Effect of the decisions")
async def read_effect(
    project_id: str, server: Server, caller: CalledBy
) -> Effect | SupersededEffect:
    """The graph solved with the decisions in force: chi², moves, conflicts. The map is not rebuilt.

    The response is ``{"superseded": true}`` when a newer decision was made meanwhile.
    """
    root = server.projects.folder(project_id)
    source = await run_in_threadpool(Source.of, root)
    decided, before = _now_and_before(await run_in_threadpool(read_rows, root))
    effect = await caller.wait(
        server.reviews.effect(root, source, decided=decided, before=before, person=caller.name)
    )
    return effect or SupersededEffect()


@router.get("/journal", dependencies=LOOK, summary="Journal")
def read_journal(
    project_id: str, server: Server, most: Annotated[int, Query(ge=1, le=1000)] = 200
) -> list[RowView]:
    """Reviewer, decision, time and reason of each row; the newest first."""
    rows = read_rows(server.projects.folder(project_id))
    names = ("seq", "time", "who", "kind", "frame_i", "frame_j", "why", "hash")
    return [RowView(**{n: getattr(row, n) for n in names}) for row in reversed(rows[-most:])]


@router.post("/approve", status_code=201, dependencies=SIGN, summary="Approve map")
async def approve(
    project_id: str, asked: Approve, request: Request, *, server: Server, reader: ReadBy
) -> ReviewView:
    """Sign the current results; no later run or decision changes the approved version.

    409 if they cannot be signed as they are, or if ``map.reason_needed`` of the state is not empty
    and ``why`` is shorter than ``map.min_reason_characters``.
    """
    root = server.projects.folder(project_id)
    if await run_in_threadpool(server.jobs.is_busy, project_id):
        raise Conflict(
            CodedText("approve-while-running"),
            remedy=project_page(project_id),
        )
    signer = {"who": reader.who.name, "role": str(reader.who.role), "why": asked.why}
    key = server.settings.state / SIGNING_KEY
    try:
        approval = await _sign(root, key, signer, asked=asked, server=server)
    except NotApprovable as error:
        raise Conflict(coded(error)) from error
    await run_in_threadpool(make_read_only, approval)
    await run_in_threadpool(record_signed, root, key.parent)
    server.webhooks.wake()
    what = f"{project_id} version {approval.version} {approval.hash}"
    await run_in_threadpool(audit, request, "approve", what)
    return await run_in_threadpool(view_of, project_id, server, reader)


async def _of_pairs(
    server: ServerParts, caller: Caller, function: Callable[..., T], *args: object, project_id: str
) -> T:
    """Run a function of the project's graph in the compute pool and return its result."""
    root = server.projects.folder(project_id)
    source = await run_in_threadpool(Source.of, root)
    terms = terms_of(root, caller.name)
    return await caller.wait(
        server.compute_pool.run_interactive(Lane.PAIR, terms, function, source, *args)
    )


async def _sign(
    root: Path, key: Path, signer: dict[str, str], *, asked: Approve, server: ServerParts
) -> Approval:
    """Sign in a separate child process, the only one that may read the key.

    It is not canceled when the client disconnects: an approval is complete or absent.
    """
    await run_in_threadpool(ensure_own_key, key.parent)
    terms = Terms(
        person=signer["who"],
        access=FileAccess(read=(key, *judging_folders(key.parent)), write=(root,)),
        limit_s=SIGNING.signing_limit_s,
    )
    seen = (asked.after_seq, asked.graph)
    return await server.compute_pool.run_background(
        Lane.SIGN, terms, sign, root, key, signer, confirmed=asked.confirmed, seen=seen
    )


def _step(
    kind: DecisionKind,
    project_id: str,
    step: Step,
    *,
    server: ServerParts,
    reader: Reader,
) -> ReviewView:
    root = server.projects.folder(project_id)
    try:
        append(
            root, Decision(kind=kind, who=reader.who.name, why=step.why), after_seq=step.after_seq
        )
    except (NothingToUndo, JournalChanged) as error:
        raise Conflict(coded(error)) from error
    return view_of(project_id, server, reader)


def view_of(project_id: str, server: ServerParts, reader: Reader) -> ReviewView:
    """The state of the review, for a person who reads a language."""
    root = server.projects.folder(project_id)
    rows = read_rows(root)
    decisions = [row.decision() for row in rows]
    decided = fold(decisions)
    in_map = decisions_in_map(root)
    approval = server.checks.state(root, artifact_keys(read_summary(root) or {}))
    return ReviewView(
        seq=len(rows),
        key=decided.key,
        graph=graph_key(root),
        undoable=decided.undoable,
        redoable=decided.redoable,
        standing=[
            StandingView(
                frame_i=one.pair[0],
                frame_j=one.pair[1],
                accepted=one.accepted,
                who=one.who,
                why=one.why,
                measured=one.measurement is not None,
                T_i_j=list(one.measurement.T_i_j) if one.measurement else [],
            )
            for one in decided.standing
        ],
        work=[work_view(one) for one in team_work(decisions)],
        obstacle=second_opinion_missing(decisions, reader.language),
        in_map=in_map == decided.key,
        finished=in_map is not None,
        map=_map_facts(root, reader.language),
        busy=server.jobs.is_busy(project_id),
        may_review=reader.who.may(Permission.REVIEW),
        may_process=reader.who.may(Permission.PROCESS),
        approval=approval.in_language(reader.language),
    )


def _map_facts(root: Path, language: str) -> MapFacts | None:
    found = read_summary(root)
    if found is None:
        return None
    summary = summary_in(language, found)
    verdict = verdict_in(summary)
    return MapFacts(
        verdict=verdict,
        reason_needed=said(reason_needed(verdict) or "", language),
        min_reason_characters=APPROVALS.min_reason_characters,
        notes=notes_in(summary),
        findings=findings_in(summary),
        figures=signed_figures(summary),
    )


def _now_and_before(rows: Sequence[JournalRow]) -> tuple[Decided, Decided]:
    """Decisions in force now, and before the last decision."""
    decisions = [row.decision() for row in rows]
    decisions = [one for one in decisions if one.kind not in CHANGE_NOTHING]
    return fold(decisions), fold(decisions[:-1])
