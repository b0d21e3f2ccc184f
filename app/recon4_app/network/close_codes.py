"""Why the server closes a WebSocket, in codes that the pages know."""

from __future__ import annotations

from enum import IntEnum

from starlette.requests import HTTPConnection

from recon4.locales.coded import said, text_of
from recon4_app.network.tuning import STREAMS
from recon4_app.pages import language_of


class CloseCode(IntEnum):
    """Close codes of our own: 4000 and the HTTP status that says the same."""

    STALLED = 4408
    """The browser read nothing for too long."""
    TOO_MANY = 4429
    """Beyond the limit of streams; the reason has the message for the user."""


def close_reason(error: BaseException, connection: HTTPConnection) -> str:
    """The message of an error in the language of a browser, as the reason of a closed WebSocket.

    What is too long ends after a whole character.
    """
    text = said(text_of(error), language_of(connection))
    return text.encode()[: STREAMS.longest_reason_bytes].decode(errors="ignore")
