"""Webhooks and their deliveries in ``access.sqlite``: secrets lie where those of people do.

An event is stored for each webhook before anything is sent, and marked once the receiver took it.
A server that is killed in between sends it again.
"""

from __future__ import annotations

import json
import secrets
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict
from datetime import UTC, datetime

import sqlalchemy as sa

from recon4.errors import ConfigError
from recon4.locales.coded import CodedText, StoredText, stored_text
from recon4_app.access.database import DELIVERIES, WEBHOOKS_TABLE, writing
from recon4_app.errors import Conflict, NotFound
from recon4_app.webhooks.addresses import target_of
from recon4_app.webhooks.model import EventKind, Waiting, Webhook, WebhookDelivery, WebhookEvent
from recon4_app.webhooks.signing import key_of
from recon4_app.webhooks.tuning import WEBHOOKS

_HOOKS, _SENT = WEBHOOKS_TABLE.c, DELIVERIES.c
_UNDELIVERED = _SENT.delivered_s.is_(None)


class WebhookStore:
    """All webhooks of a server."""

    def __init__(self, engine: sa.Engine, clock: Callable[[], float] = time.time) -> None:
        self._engine, self._clock = engine, clock

    def add(self, url: str, events: Sequence[EventKind], *, secret: str, by: str) -> Webhook:
        """Add a webhook; from now on its events are kept for it.

        Raises:
            ConfigError: If the address, the secret or the events cannot be used.
            Conflict: If there are too many.
        """
        target_of(url)
        key_of(secret)
        if not events:
            raise ConfigError(CodedText("webhook-no-event"))
        row = {
            "id": secrets.token_hex(8),
            "url": url,
            "secret": secret,
            "events": " ".join(events),
            "created_s": self._clock(),
            "by": by,
        }
        with writing(self._engine) as connection:
            count = sa.select(sa.func.count()).select_from(WEBHOOKS_TABLE)
            if connection.execute(count).scalar_one() >= WEBHOOKS.max_webhooks:
                raise Conflict(CodedText("webhooks-too-many", limit=WEBHOOKS.max_webhooks))
            connection.execute(WEBHOOKS_TABLE.insert().values(**row))
        return self.get(str(row["id"]))

    def get(self, webhook_id: str) -> Webhook:
        """One webhook.

        Raises:
            NotFound: If there is none.
        """
        found = [one for one in self.all() if one.id == webhook_id]
        if not found:
            raise NotFound(CodedText("webhook-unknown", webhook=webhook_id[:32]))
        return found[0]

    def remove(self, webhook_id: str) -> Webhook:
        """Remove a webhook, and what waits for it.

        Raises:
            NotFound: If there is none.
        """
        removed = self.get(webhook_id)
        with writing(self._engine) as connection:
            connection.execute(DELIVERIES.delete().where(_SENT.webhook == webhook_id))
            connection.execute(WEBHOOKS_TABLE.delete().where(_HOOKS.id == webhook_id))
        return removed

    def all(self) -> list[Webhook]:
        """All webhooks in the order in which they were added."""
        waiting = (
            sa.select(_SENT.webhook, sa.func.count().label("count"))
            .where(_UNDELIVERED)
            .group_by(_SENT.webhook)
        )
        problems = (
            sa.select(_SENT.webhook, _SENT.problem)
            .where(_UNDELIVERED, _SENT.problem != "")
            .order_by(_SENT.number)
        )
        with self._engine.connect() as connection:
            counts = {row[0]: int(row[1]) for row in connection.execute(waiting)}
            last = {row.webhook: row.problem for row in connection.execute(problems)}
            rows = connection.execute(WEBHOOKS_TABLE.select().order_by(_HOOKS.created_s)).all()
        return [
            Webhook(
                id=row.id,
                url=row.url,
                events=tuple(map(EventKind, row.events.split())),
                created=_iso(row.created_s),
                by=row.by,
                waiting=counts.get(row.id, 0),
                problem=_read(last.get(row.id, "")),
            )
            for row in rows
        ]

    def wants(self, kind: EventKind) -> bool:
        """Whether any webhook takes events of a kind."""
        return any(kind in one.events for one in self.all())

    def keep(self, event: WebhookEvent, *, only: str = "") -> None:
        """Keep an event for all webhooks that take it, or for one; once, however often it is kept.

        Events of before a webhook was added are left out.
        """
        happened_s = self._happened_s(event)
        chosen = [
            one.id
            for one in self.all()
            if one.id == only
            or (not only and event.kind in one.events and _began_s(one) <= happened_s)
        ]
        rows = [
            {
                "webhook": one,
                "event": event.id,
                "kind": event.kind,
                "body": event.body(),
                "created_s": self._clock(),
                "attempts": 0,
                "due_s": self._clock(),
                "problem": "",
            }
            for one in chosen
        ]
        if rows:
            with writing(self._engine) as connection:
                connection.execute(DELIVERIES.insert().prefix_with("OR IGNORE"), rows)

    def due(self) -> list[Waiting]:
        """What is to be sent now, oldest first."""
        query = (
            sa.select(DELIVERIES, _HOOKS.url, _HOOKS.secret)
            .join(WEBHOOKS_TABLE, _HOOKS.id == _SENT.webhook)
            .where(_UNDELIVERED, _SENT.due_s <= self._clock())
            .order_by(_SENT.number)
        )
        with self._engine.connect() as connection:
            return [
                Waiting(
                    number=row.number,
                    webhook=row.webhook,
                    url=row.url,
                    secret=row.secret,
                    event=row.event,
                    kind=row.kind,
                    body=row.body,
                    attempts=row.attempts,
                )
                for row in connection.execute(query)
            ]

    def next_due_s(self) -> float | None:
        """How long until something is to be sent [s]; None = nothing waits."""
        query = sa.select(sa.func.min(_SENT.due_s)).where(_UNDELIVERED)
        with self._engine.connect() as connection:
            due_s: float | None = connection.execute(query).scalar()
        return None if due_s is None else max(0.0, due_s - self._clock())

    def delivered(self, number: int) -> None:
        """Mark what a receiver took."""
        self._change(number, delivered_s=self._clock(), attempts=_SENT.attempts + 1, problem="")

    def failed(self, number: int, problem: StoredText, *, again_s: float) -> None:
        """Note a failed attempt and why; the next one is due after ``again_s``."""
        self._change(
            number,
            attempts=_SENT.attempts + 1,
            problem=_written(problem),
            due_s=self._clock() + again_s,
        )

    def try_now(self, webhook_id: str) -> None:
        """Make everything that waits for a webhook due."""
        self.get(webhook_id)
        with writing(self._engine) as connection:
            mine = (_SENT.webhook == webhook_id) & _UNDELIVERED
            connection.execute(DELIVERIES.update().where(mine).values(due_s=self._clock()))

    def deliveries(self, webhook_id: str) -> list[WebhookDelivery]:
        """The newest deliveries of a webhook, newest first."""
        self.get(webhook_id)
        mine = DELIVERIES.select().where(_SENT.webhook == webhook_id)
        query = mine.order_by(_SENT.number.desc()).limit(WEBHOOKS.listed)
        with self._engine.connect() as connection:
            return [_delivery(row) for row in connection.execute(query)]

    def sweep(self) -> None:
        """Forget deliveries of jobs that ended long ago; approvals are seen again, and stay."""
        old = (_SENT.delivered_s < self._clock() - WEBHOOKS.kept_s) & (
            _SENT.kind != EventKind.APPROVAL_SIGNED
        )
        with writing(self._engine) as connection:
            connection.execute(DELIVERIES.delete().where(old))

    def _happened_s(self, event: WebhookEvent) -> float:
        try:
            return datetime.fromisoformat(event.time).timestamp()
        except ValueError:  # a row of a job that is damaged
            return self._clock()

    def _change(self, number: int, **values: object) -> None:
        with writing(self._engine) as connection:
            connection.execute(DELIVERIES.update().where(_SENT.number == number).values(**values))


def _delivery(row: sa.Row[tuple[object, ...]]) -> WebhookDelivery:
    return WebhookDelivery(
        number=row.number,
        event=row.event,
        kind=EventKind(row.kind),
        created=_iso(row.created_s),
        attempts=row.attempts,
        delivered="" if row.delivered_s is None else _iso(row.delivered_s),
        next_attempt=_iso(row.due_s) if row.delivered_s is None else "",
        problem=_read(row.problem),
    )


def _written(problem: StoredText) -> str:
    """A problem as its column has it: in English, and with code and values if it has a code."""
    return json.dumps(asdict(problem)) if problem.code else problem.text[: WEBHOOKS.max_problem]


def _read(column: str) -> str:
    """The problem that `_written` kept, or an earlier version, which kept only the text."""
    if not column.startswith("{"):
        return column
    kept = StoredText(**json.loads(column))
    return stored_text(kept.code, kept.values, kept.text)


def _began_s(webhook: Webhook) -> float:
    return datetime.fromisoformat(webhook.created).timestamp()


def _iso(t_s: float) -> str:
    return datetime.fromtimestamp(t_s, UTC).isoformat(timespec="seconds")
