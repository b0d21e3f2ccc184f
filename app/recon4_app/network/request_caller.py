"""The caller of a request, and whether the client is still connected."""

from __future__ import annotations

import asyncio
from collections.abc import Coroutine
from dataclasses import dataclass
from typing import Annotated, Any, TypeVar

from fastapi import Depends
from starlette.requests import Request

from recon4.locales.coded import CodedText
from recon4_app.access.people import person
from recon4_app.errors import ClientLeft
from recon4_app.pages import language_of

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class Caller:
    """The person behind a request."""

    name: str
    request: Request

    @property
    def language(self) -> str:
        """The language that the person reads."""
        return language_of(self.request)

    async def wait(self, work: Coroutine[Any, Any, T]) -> T:
        """Return the result of ``work``; cancel it as soon as the client disconnects.

        Call it after the body of the request was read.

        Raises:
            ClientLeft: If the client disconnected first.
        """
        working = asyncio.ensure_future(work)
        leaving = asyncio.ensure_future(self._left())
        try:
            await asyncio.wait({working, leaving}, return_when=asyncio.FIRST_COMPLETED)
            if working.done():
                return await working
            raise ClientLeft(CodedText("client-left"))
        finally:
            working.cancel()
            leaving.cancel()
            await asyncio.gather(working, leaving, return_exceptions=True)

    async def _left(self) -> None:
        """Return when the client has disconnected."""
        while (await self.request.receive())["type"] != "http.disconnect":
            pass


def caller(request: Request) -> Caller:
    """The caller of a request (dependency)."""
    return Caller(person(request).name, request)


CalledBy = Annotated[Caller, Depends(caller)]
