"""HTTP routes of several people who review one map: assign, comment, skip, second opinion."""

from __future__ import annotations

from fastapi import APIRouter

from recon4.locales.coded import CodedText
from recon4.review.decisions import Decision, DecisionKind
from recon4.review.journal import append, read_rows
from recon4_app.access.people import LOCAL, MAY, Permission, Who
from recon4_app.deps import Server, ServerParts
from recon4_app.error_responses import problems
from recon4_app.errors import BadRequest
from recon4_app.review.model import Frame, ReviewView
from recon4_app.review.reader import ReadBy
from recon4_app.review.routes import LOOK, PREFIX, REVIEW, view_of
from recon4_app.review.team_model import CommentView, LookerView, Looking, NewWork

router = APIRouter(
    prefix=PREFIX,
    tags=["review"],
    responses=problems(404, 422),
)


@router.post("/work", status_code=201, dependencies=REVIEW, summary="Share the work on a pair")
def work_on_pair(project_id: str, new: NewWork, server: Server, *, reader: ReadBy) -> ReviewView:
    """Assign, comment, leave for later, ask for a second opinion or withdraw that question.

    A row of the journal; no decision changes. An approval waits for second opinions.
    """
    root = server.projects.folder(project_id)
    if new.assignee and new.assignee not in _reviewers(server):
        raise BadRequest(CodedText("assignee-may-not-review", name=new.assignee))
    decision = Decision(
        kind=DecisionKind(new.kind),
        who=reader.who.name,
        why=new.why,
        pair=(new.frame_i, new.frame_j),
        assignee=new.assignee,
    )
    append(root, decision)
    return view_of(project_id, server, reader)


@router.get("/comments", dependencies=LOOK, summary="Comments on a pair")
def read_comments(
    project_id: str, server: Server, *, frame_i: Frame, frame_j: Frame
) -> list[CommentView]:
    """Author, time and text; the oldest first."""
    return [
        CommentView(who=row.who, time=row.time, text=row.why)
        for row in read_rows(server.projects.folder(project_id))
        if row.kind == DecisionKind.COMMENT and (row.frame_i, row.frame_j) == (frame_i, frame_j)
    ]


@router.get("/people", dependencies=REVIEW, summary="Who may review")
def read_reviewers(project_id: str, server: Server) -> list[str]:
    """Names of people to whom a pair can be assigned."""
    server.projects.folder(project_id)
    return _reviewers(server)


@router.post("/looking", dependencies=LOOK, summary="Who looks at which pair now")
def look(project_id: str, now: Looking, server: Server, *, who: Who) -> list[LookerView]:
    """Say which pair this page shows, and learn of the other pages; kept for seconds only."""
    server.projects.folder(project_id)
    i, j = now.frame_i, now.frame_j
    pair = None if i is None or j is None else (i, j)
    others = server.presence.look(project_id, who.name, page=now.page, pair=pair)
    return [
        LookerView(
            who=one.who,
            frame_i=one.pair[0] if one.pair else None,
            frame_j=one.pair[1] if one.pair else None,
        )
        for one in others
    ]


def _reviewers(server: ServerParts) -> list[str]:
    if not server.access.login:
        return [LOCAL.name]
    return [
        one.name
        for one in server.access.accounts.all()
        if not one.disabled and Permission.REVIEW in MAY[one.role]
    ]
