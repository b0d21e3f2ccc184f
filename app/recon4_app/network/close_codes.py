"""Why the server closes a WebSocket, in codes that the pages know."""

from __future__ import annotations

from enum import IntEnum


class CloseCode(IntEnum):
    """Close codes of our own: 4000 and the HTTP status that says the same."""

    STALLED = 4408
    """The browser read nothing for too long."""
    TOO_MANY = 4429
    """Beyond the limit of streams; the reason has the message for the user."""
