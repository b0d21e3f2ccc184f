"""The server's HTTP API for one person: signs in, and again when the session has ended."""

from __future__ import annotations

import hashlib
import ipaddress
import ssl
from collections.abc import AsyncIterator, Mapping
from contextlib import asynccontextmanager, suppress
from pathlib import Path
from typing import TypeVar
from urllib.parse import unquote, urlsplit

import anyio
import httpx2
import msgspec
from mcp.server.mcpserver.exceptions import ToolError

from recon4.errors import ConfigError, Recon4Error
from recon4.locales.coded import CodedText
from recon4.store.atomic import atomic_file
from recon4.untrusted.typed import decoded
from recon4_app.assistant.records import Downloaded, SignedIn, WatchedJob
from recon4_app.assistant.tuning import ASSISTANT

T = TypeVar("T")
Query = Mapping[str, str | int | float | bool]


class ServerClient:
    """Requests to one server. Every error of a request is a `ToolError` with the server's words."""

    def __init__(
        self,
        url: str,
        *,
        password: str = "",
        certificate: Path | None = None,
        transport: httpx2.AsyncBaseTransport | None = None,
    ) -> None:
        """Name the server, and the person.

        Args:
            url: Address of the server, also below a path of a host; with the name of an account
                before the host, as ``https://rita@backpack.local:8000/``, if there is a login.
            password: Of that account.
            certificate: That of the server, PEM, where no authority signed it.
            transport: Instead of the network.

        Raises:
            ConfigError: If the address is none, the certificate cannot be read, or the password
                would go through a network without TLS.
        """
        parts = urlsplit(url)
        if parts.scheme not in ("http", "https") or not parts.hostname:
            raise ConfigError(CodedText("assistant-address", url=url))
        if parts.password is not None:
            raise ConfigError(CodedText("assistant-password"))
        self._name, self._password = unquote(parts.username or ""), password
        if self._name and parts.scheme == "http" and not _is_this_computer(parts.hostname):
            raise ConfigError(CodedText("assistant-tls", url=url))
        place = parts.netloc.rpartition("@")[2]
        self._url = f"{parts.scheme}://{place}{parts.path.rstrip('/')}/"
        self._http = httpx2.AsyncClient(
            base_url=self._url,
            verify=_trust(certificate) if transport is None else False,
            transport=transport,
            timeout=httpx2.Timeout(ASSISTANT.answer_s, connect=ASSISTANT.connect_s),
        )
        self._signing_in = anyio.Lock()
        self._sign_ins = 0

    @property
    def url(self) -> str:
        """Address of the server."""
        return self._url

    @property
    def needs_password(self) -> bool:
        """Whether an account is named."""
        return bool(self._name)

    async def close(self) -> None:
        """Sign out, if the server can be reached, and close the connections."""
        with anyio.move_on_after(ASSISTANT.connect_s, shield=True):
            if self._sign_ins:
                with suppress(httpx2.TransportError):  # it ends by itself when it is not used
                    await self._http.post("api/logout")
            await self._http.aclose()

    async def me(self) -> SignedIn:
        """The person as whom requests are made."""
        return await self.get("api/me", SignedIn)

    async def get(self, path: str, kind: type[T], query: Query | None = None) -> T:
        """Read the JSON of a path."""
        return _read((await self._request("GET", path, query=query)).content, kind)

    async def post(self, path: str, kind: type[T], body: object = None) -> T:
        """Send JSON to a path, and read that of the response."""
        return _read((await self._request("POST", path, body=body)).content, kind)

    async def download(self, path: str, target: Path, query: Query | None = None) -> Downloaded:
        """Write a file of the server; ``target`` is complete or absent."""
        digest, size = hashlib.sha256(), 0
        try:
            async with self._stream(path, query) as response:
                with atomic_file(target) as part, part.open("wb") as file:
                    async for piece in response.aiter_bytes(ASSISTANT.chunk_bytes):
                        digest.update(piece)
                        size += file.write(piece)
        except Recon4Error as error:
            raise ToolError(str(error)) from error
        return Downloaded(path=str(target), bytes=size, sha256=digest.hexdigest())

    @asynccontextmanager
    async def job_events(self) -> AsyncIterator[AsyncIterator[WatchedJob]]:
        """The stream of changes of jobs, open when this is entered."""
        async with self._stream("api/events", quiet=True) as response:
            yield self._jobs_of(response)

    @asynccontextmanager
    async def _stream(
        self, path: str, query: Query | None = None, *, quiet: bool = False
    ) -> AsyncIterator[httpx2.Response]:
        """A response whose bytes are read as they come; with ``quiet`` it may say nothing."""
        await self._sign_in_first()
        timeout = httpx2.Timeout(None if quiet else ASSISTANT.answer_s)
        for again in (True, False):
            seen = self._sign_ins
            try:
                async with self._http.stream("GET", path, params=query, timeout=timeout) as found:
                    if not self._must_sign_in(found, again=again):
                        if found.is_error:
                            await found.aread()
                            raise _refusal(found)
                        yield found
                        return
            except httpx2.TransportError as error:
                raise self._unreachable(error) from error
            await self._sign_in(seen)

    async def _request(
        self, method: str, path: str, *, query: Query | None = None, body: object = None
    ) -> httpx2.Response:
        await self._sign_in_first()
        for again in (True, False):
            seen = self._sign_ins
            try:
                found = await self._http.request(method, path, params=query, json=body)
            except httpx2.TransportError as error:
                raise self._unreachable(error) from error
            if not self._must_sign_in(found, again=again):
                break
            await self._sign_in(seen)
        if found.is_error:
            raise _refusal(found)
        return found

    def _must_sign_in(self, found: httpx2.Response, *, again: bool) -> bool:
        return found.status_code == 401 and again and self.needs_password

    async def _sign_in_first(self) -> None:
        if self.needs_password and not self._sign_ins:
            await self._sign_in(0)

    async def _sign_in(self, seen: int) -> None:
        """Begin a session, unless another request did so after the sign-in number ``seen``."""
        async with self._signing_in:
            if self._sign_ins != seen:
                return
            body = {"name": self._name, "password": self._password}
            try:
                found = await self._http.post("api/login", json=body)
            except httpx2.TransportError as error:
                raise self._unreachable(error) from error
            if found.is_error:
                raise _refusal(found)
            self._http.headers["X-Recon4-Token"] = _read(found.content, SignedIn).token
            self._sign_ins += 1

    async def _jobs_of(self, response: httpx2.Response) -> AsyncIterator[WatchedJob]:
        try:
            async for line in response.aiter_lines():
                if line.startswith("data:"):
                    yield _read(line[5:].encode(), WatchedJob)
        except httpx2.TransportError as error:
            raise self._unreachable(error) from error

    def _unreachable(self, error: httpx2.TransportError) -> ToolError:
        return ToolError(f"no answer from {self.url}: {error or type(error).__name__}")


class _RefusalBody(msgspec.Struct):
    """The body of every error of the server."""

    detail: str
    problems: dict[str, str] = {}


def _refusal(response: httpx2.Response) -> ToolError:
    """The server's own words about what it refused."""
    try:
        problem = decoded(response.content, _RefusalBody)
    except msgspec.DecodeError:  # the length of a body is refused in plain text
        problem = _RefusalBody(response.text[:500])
    said = [problem.detail, *(f"{name}: {text}" for name, text in problem.problems.items())]
    if wait := response.headers.get("Retry-After"):
        said.append(f"try again in {wait} s")
    return ToolError(f"{response.status_code}: " + "; ".join(said))


def _read(text: bytes, kind: type[T]) -> T:
    try:
        return decoded(text, kind)
    except msgspec.DecodeError as error:
        raise ToolError(
            f"the server answered otherwise than this version of recon4 expects: {error}"
        ) from error


def _trust(certificate: Path | None) -> ssl.SSLContext:
    try:
        return ssl.create_default_context(cafile=certificate)
    except OSError as error:
        raise ConfigError(
            CodedText("assistant-certificate", certificate=str(certificate), why=str(error))
        ) from error


def _is_this_computer(host: str) -> bool:
    try:
        return host == "localhost" or ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False
