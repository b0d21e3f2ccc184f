"""HTTP routes that give points another class, by decisions in the journal of the review."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from fastapi import APIRouter, Request
from fastapi import Path as InPath
from starlette.concurrency import run_in_threadpool

from recon4.locales.coded import CodedText, coded
from recon4.model.alike import Alike
from recon4.model.class_corrections import GIVEN_CLASSES, ClassCorrection, titles_of
from recon4.model.classes import CLASSES
from recon4.review.class_corrections import CorrectionTrial, corrections_in_map, not_in_map
from recon4.review.decisions import Decision, DecisionKind, fold
from recon4.review.journal import JournalChanged, JournalRow, NothingToUndo, append, read_rows
from recon4.review.state import read_summary
from recon4_app.access.audit import audit
from recon4_app.access.people import Permission, Person, Who
from recon4_app.compute_pool.messages import decode_record
from recon4_app.deps import Server, ServerParts
from recon4_app.error_responses import problems
from recon4_app.errors import Conflict
from recon4_app.network.request_caller import CalledBy, Caller
from recon4_app.review import correction_work
from recon4_app.review.alike_model import AlikeView, LikeSpec
from recon4_app.review.correction_model import (
    CorrectionCount,
    CorrectionSpec,
    CorrectionsView,
    CorrectionView,
    NewCorrection,
)
from recon4_app.review.routes import LOOK, REVIEW
from recon4_app.review.routes import router as review_router

router = APIRouter(
    prefix=f"{review_router.prefix}/classes",
    tags=["review"],
    responses=review_router.responses | problems(422),
)


@router.get("", dependencies=LOOK, summary="Corrections of classes")
def read_corrections(project_id: str, server: Server, who: Who) -> CorrectionsView:
    """The corrections in force, whether the map has them, and the classes that points can get."""
    return _view(server.projects.folder(project_id), who)


@router.post("/count", dependencies=LOOK, summary="Count what a correction would change")
async def count_points(
    project_id: str, asked: CorrectionSpec, server: Server, *, caller: CalledBy
) -> CorrectionCount:
    """Points in the volume by their present class; nothing is changed."""
    rows = await run_in_threadpool(read_rows, server.projects.folder(project_id))
    trial = await _tried(server, caller, project_id, asked=asked, rows=rows)
    return CorrectionCount(
        points=trial.points,
        now=trial.now,
        inside=trial.inside,
        refused=trial.refused.said(caller.language) if trial.refused else "",
        seq=len(rows),
    )


@router.post("/like", dependencies=LOOK, summary="Find all things like one")
async def find_alike(
    project_id: str, asked: LikeSpec, server: Server, *, caller: CalledBy
) -> AlikeView:
    """Clusters of the same class whose evidence is like that of the picked one.

    Evidence: height, extents, number of cells, height above the ground, planarity, and how many
    beams see through it. Nothing is changed; the cubes of those that are meant are the volume
    ``clusters`` of a correction.
    """
    picked = asked.picked()  # what has no such class is refused before the request waits
    rows = await run_in_threadpool(read_rows, server.projects.folder(project_id))
    artifacts, before = await _looked_at(server, project_id, asked.map, rows=rows)
    terms = server.slices.terms(project_id, caller.name)
    data = await caller.wait(
        server.slices.run_interactive(terms, correction_work.alike, artifacts, picked, before)
    )
    return AlikeView.of(decode_record(data, Alike))


@router.post("", status_code=201, dependencies=REVIEW, summary="Correct classes")
async def correct(
    project_id: str, new: NewCorrection, server: Server, *, caller: CalledBy, who: Who
) -> CorrectionsView:
    """Note a correction in the journal; the map follows when it is made again (``remake``).

    409 if it changes no point, or another person corrected classes since ``seen_seq``.
    """
    root = server.projects.folder(project_id)
    rows = await run_in_threadpool(read_rows, root)
    trial = await _tried(server, caller, project_id, asked=new, rows=rows)
    if trial.refused is not None:
        detail = trial.refused.said(caller.language)
        raise Conflict(CodedText("correction-refused", detail=detail))
    assert trial.correction is not None
    decision = Decision(
        kind=DecisionKind.CLASSIFY, who=who.name, why=new.why, correction=trial.correction
    )
    await run_in_threadpool(_decide, root, decision, seen_seq=new.seen_seq)
    what = f"{project_id}: {trial.points} points to {new.to}"
    await run_in_threadpool(audit, caller.request, "correct classes", what)
    return await run_in_threadpool(_view, root, who)


@router.delete("/{correction}", dependencies=REVIEW, summary="Withdraw a correction of classes")
def withdraw(
    project_id: str,
    correction: Annotated[str, InPath(pattern="^[0-9a-f]{12}$")],
    server: Server,
    *,
    who: Who,
    request: Request,
) -> CorrectionsView:
    """Note in the journal that it no longer applies, whatever was decided since."""
    root = server.projects.folder(project_id)
    decision = Decision(kind=DecisionKind.WITHDRAW, who=who.name, withdraws=correction)
    _decide(root, decision)
    audit(request, "withdraw correction of classes", f"{project_id}: {correction}")
    return _view(root, who)


async def _tried(
    server: ServerParts,
    caller: Caller,
    project_id: str,
    *,
    asked: CorrectionSpec,
    rows: list[JournalRow],
) -> CorrectionTrial:
    what = asked.reclassified()  # what is no volume is refused before the request waits
    artifacts, before = await _looked_at(server, project_id, asked.map, rows=rows)
    terms = server.slices.terms(project_id, caller.name)
    data = await caller.wait(
        server.slices.run_interactive(terms, correction_work.tried, artifacts, what, before)
    )
    return decode_record(data, CorrectionTrial)


async def _looked_at(
    server: ServerParts, project_id: str, key: str, *, rows: list[JournalRow]
) -> tuple[dict[str, str], tuple[ClassCorrection, ...]]:
    """Artifacts of the map that a person looks at, and corrections that are not in it yet."""
    artifacts = await run_in_threadpool(server.slices.artifacts, project_id)
    if Path(artifacts["map"]).name != key:
        raise Conflict(CodedText("map-remade-classes"))
    summary = await run_in_threadpool(read_summary, server.projects.folder(project_id))
    decided = fold(row.decision() for row in rows)
    return artifacts, not_in_map(decided, corrections_in_map(summary)).corrections


def _decide(root: Path, decision: Decision, *, seen_seq: int | None = None) -> None:
    try:
        append(root, decision, seen_seq=seen_seq)
    except (JournalChanged, NothingToUndo) as error:
        raise Conflict(coded(error)) from error


def _view(root: Path, who: Person) -> CorrectionsView:
    rows = read_rows(root)
    decided = fold(row.decision() for row in rows)
    in_map = corrections_in_map(read_summary(root))
    return CorrectionsView(
        seq=len(rows),
        corrections=[
            CorrectionView(
                id=one.id,
                to=titles_of([one.correction.what.to])[0],
                only=list(titles_of(one.correction.what.only)),
                points=one.correction.points,
                who=one.who,
                why=one.why,
                time=one.time,
                in_map=one.id in in_map,
            )
            for one in decided.corrections
        ],
        withdrawn=list(not_in_map(decided, in_map).withdrawn),
        may_correct=who.may(Permission.REVIEW),
        may_process=who.may(Permission.PROCESS),
        classes=[CLASSES[one].title for one in GIVEN_CLASSES],
        left_out=[CLASSES[one].title for one in GIVEN_CLASSES if not CLASSES[one].delivered],
    )
