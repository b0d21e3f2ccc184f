"""One HTTP request to an address that was judged: no redirect, no proxy, one deadline for all."""

from __future__ import annotations

import asyncio
import ssl
from collections.abc import Mapping, Sequence

import h11

from recon4 import __version__
from recon4.locales.coded import CodedText
from recon4.untrusted.names import visible
from recon4_app.settings import Network
from recon4_app.webhooks.addresses import NotReachable, Target, address_of
from recon4_app.webhooks.tuning import WEBHOOKS


async def post(
    target: Target, body: str, headers: Mapping[str, str], *, networks: Sequence[Network]
) -> int:
    """Post JSON.

    Returns:
        Status of the response; its body is not read.

    Raises:
        NotReachable: If there is none in time, or the address may not be called.
    """
    try:
        async with asyncio.timeout(WEBHOOKS.answer_s):
            address = await address_of(target, networks)
            return await _exchange(address, target, _request(target, body, headers))
    except TimeoutError as error:
        text = CodedText("host-no-answer", seconds=round(WEBHOOKS.answer_s))
        raise NotReachable(text) from error
    except (OSError, h11.ProtocolError) as error:  # errors of TLS are of the system's, too
        reason = visible(str(error) or type(error).__name__, most=WEBHOOKS.max_problem)
        raise NotReachable(CodedText("host-unreachable", reason=reason)) from error


def _request(target: Target, body: str, headers: Mapping[str, str]) -> tuple[h11.Event, ...]:
    data = body.encode()
    ours = {
        "Host": target.authority,
        "User-Agent": f"recon4/{__version__}",
        "Content-Type": "application/json",
        "Content-Length": str(len(data)),
        "Connection": "close",
    }
    head = h11.Request(method="POST", target=target.path, headers=[*{**ours, **headers}.items()])
    return head, h11.Data(data), h11.EndOfMessage()


async def _exchange(address: str, target: Target, request: tuple[h11.Event, ...]) -> int:
    tls = ssl.create_default_context() if target.secure else None
    name = target.host if target.secure else None
    reader, writer = await asyncio.open_connection(
        address, target.port, ssl=tls, server_hostname=name
    )
    try:
        connection = h11.Connection(h11.CLIENT)
        for event in request:
            writer.write(connection.send(event) or b"")
        await writer.drain()
        return await _status(connection, reader)
    finally:
        writer.transport.abort()


async def _status(connection: h11.Connection, reader: asyncio.StreamReader) -> int:
    while True:
        event = connection.next_event()
        if isinstance(event, h11.Response):
            return event.status_code
        if event is h11.NEED_DATA:
            connection.receive_data(await reader.read(1 << 14))
        elif not isinstance(event, h11.InformationalResponse):
            raise NotReachable(CodedText("host-ended"))
