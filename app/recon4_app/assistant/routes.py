"""The address of the server for assistants: the Model Context Protocol over streamable HTTP."""

from __future__ import annotations

from fastapi import APIRouter, Depends, Request
from fastapi.responses import Response

from recon4.locales.coded import CodedText
from recon4_app.access.middleware.session import MCP_PATH
from recon4_app.access.people import Permission, Who, needs
from recon4_app.deps import Server
from recon4_app.error_responses import problems
from recon4_app.errors import Unknown

router = APIRouter(
    tags=["assistants"],
    dependencies=[Depends(needs(Permission.LOOK))],
    responses=problems(401, 403, 404, 429),
)


@router.post(MCP_PATH, include_in_schema=False)
async def answer_assistant(request: Request, who: Who, server: Server) -> Response:
    """One message of an assistant, with the access token of a person.

    A token with the role viewer has only tools that look. Without login there are no others.

    Raises:
        Unknown: If the caller signed in as a person, in a browser.
    """
    session = request.scope["state"].get("session")
    if server.access.login and not (session and session.access_token):
        raise Unknown(CodedText("token-needed"))
    allow_write = server.access.login and who.may(Permission.PROCESS)
    return await server.assistants.response(request, allow_write=allow_write)
