"""Where the remedy of an error is: named in the response, for those who may go there."""

import asyncio

import httpx
import pytest
from fastapi import FastAPI

from recon4.errors import ConfigError, NoSpace
from recon4.locales.coded import CodedText
from recon4_app.access.people import Person, Role
from recon4_app.error_responses import install
from recon4_app.errors import Conflict, NoRoom, project_page


def answer(error: Exception, role: Role) -> dict[str, object]:
    """The body of the response to an error that a person of this role caused."""
    app = FastAPI()
    install(app)

    @app.get("/api/fail")
    def fail() -> None:
        raise error

    async def signed_in(scope, receive, send):
        scope.setdefault("state", {})["person"] = Person("Jan", role)
        await app(scope, receive, send)

    async def get() -> httpx.Response:
        transport = httpx.ASGITransport(signed_in)
        async with httpx.AsyncClient(transport=transport, base_url="http://server") as client:
            return await client.get("/api/fail")

    body: dict[str, object] = asyncio.run(get()).json()
    return body


@pytest.mark.parametrize("error", [NoRoom(CodedText("disk-full")), NoSpace("no space left")])
def test_a_full_disk_leads_those_who_may_delete_to_what_takes_space(error):
    remedy = {"text": "See what takes space", "page": "/storage", "needs": "process"}

    assert answer(error, Role.OPERATOR)["remedy"] == remedy
    assert "remedy" not in answer(error, Role.VIEWER)


def test_the_page_of_a_project_is_named_as_it_is_addressed():
    error = Conflict(CodedText("job-no-log"), remedy=project_page("2. patro"))

    remedy = answer(error, Role.VIEWER)["remedy"]

    assert remedy == {"text": "Open 2. patro", "page": "/projects/2.%20patro/", "needs": "look"}


@pytest.mark.parametrize(
    "error", [Conflict(CodedText("capture-none")), ConfigError("voxel_m must be positive")]
)
def test_an_error_without_another_page_names_none(error):
    assert "remedy" not in answer(error, Role.ADMIN)
