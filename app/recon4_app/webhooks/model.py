"""Webhooks: what happens is posted to an address that an admin named."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum


class EventKind(StrEnum):
    """What is posted."""

    JOB_FINISHED = "job.finished"
    """A job ended: succeeded, failed or canceled."""
    APPROVAL_SIGNED = "approval.signed"
    """A person signed a map."""
    TEST = "test"
    """An admin asked for it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class WebhookEvent:
    """Something that happened once."""

    id: str
    """The same however many times it is posted: receivers leave out what they had."""
    kind: EventKind
    time: str
    """When it happened, UTC, ISO 8601."""
    data: Mapping[str, str | int]

    def body(self) -> str:
        """The JSON that is posted."""
        record = {"type": self.kind, "timestamp": self.time, "data": dict(self.data)}
        return json.dumps(record, ensure_ascii=False, separators=(",", ":"))


@dataclass(frozen=True, slots=True, kw_only=True)
class Webhook:
    """An address to which events are posted."""

    id: str
    url: str
    events: tuple[EventKind, ...]
    created: str
    """UTC, ISO 8601; events before it are not posted."""
    by: str
    """The admin who added it."""
    waiting: int = 0
    """Events that are not delivered yet."""
    problem: str = ""
    """Why the last attempt of a waiting event failed; empty = none waits, or none failed."""


@dataclass(frozen=True, slots=True, kw_only=True)
class NewWebhookView:
    """A webhook that was just added."""

    webhook: Webhook
    secret: str
    """Shown once: the receiver checks the signatures with it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class WebhookDelivery:
    """An event on its way to one address."""

    number: int
    event: str
    """Id of the event."""
    kind: EventKind
    created: str
    attempts: int
    delivered: str
    """UTC, ISO 8601; empty = it waits."""
    next_attempt: str
    """UTC, ISO 8601; empty = delivered."""
    problem: str
    """Why the last attempt failed; empty = it did not."""


@dataclass(frozen=True, slots=True)
class Waiting:
    """A delivery that is due, with all that the attempt needs."""

    number: int
    webhook: str
    url: str
    secret: str
    event: str
    kind: str
    body: str
    attempts: int
