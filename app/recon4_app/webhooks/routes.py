"""HTTP routes of the webhooks."""

from __future__ import annotations

import asyncio
import secrets
from collections.abc import Sequence
from dataclasses import replace
from typing import Annotated

from fastapi import APIRouter, Depends, Path, Request
from pydantic import Field
from starlette.concurrency import run_in_threadpool

from recon4.errors import ConfigError
from recon4.locales.coded import CodedText, said, text_of
from recon4_app.access.audit import audit
from recon4_app.access.login.routes import Text, Wire
from recon4_app.access.people import Permission, Who, needs, recent_login
from recon4_app.deps import Server
from recon4_app.error_responses import problems
from recon4_app.jobs.supervisor import now
from recon4_app.pages import Language
from recon4_app.settings import Network
from recon4_app.webhooks.addresses import NotReachable, address_of, target_of
from recon4_app.webhooks.deliver import trial_event
from recon4_app.webhooks.model import EventKind, NewWebhookView, Webhook, WebhookDelivery
from recon4_app.webhooks.signing import new_secret
from recon4_app.webhooks.tuning import WEBHOOKS

router = APIRouter(
    prefix="/api/webhooks",
    tags=["administration"],
    dependencies=[Depends(needs(Permission.ADMINISTER))],
    responses=problems(403, 404, 409, 422),
)
RECENT_LOGIN = Depends(recent_login)
WebhookId = Annotated[str, Path(pattern="^[0-9a-f]{16}$")]


class NewWebhook(Wire):
    """A webhook to be added."""

    url: Text
    """Address of the receiver, https."""
    events: list[EventKind] = Field(
        default=[EventKind.JOB_FINISHED, EventKind.APPROVAL_SIGNED], min_length=1, max_length=3
    )
    secret: Text = ""
    """``whsec_`` and 24 to 64 bytes in base64; empty = the server makes one."""


@router.get("", summary="Webhooks")
def list_webhooks(server: Server, language: Language) -> list[Webhook]:
    """List the webhooks with how many events wait, and why."""
    return [
        replace(one, problem=said(one.problem, language)) for one in server.webhooks.store.all()
    ]


@router.post("", status_code=201, dependencies=[RECENT_LOGIN], summary="Add a webhook")
async def add_webhook(
    new: NewWebhook, request: Request, server: Server, *, who: Who
) -> NewWebhookView:
    """Post finished jobs and approvals to an address from now on; shows the secret once."""
    await _require_reachable(new.url, server.webhooks.networks)
    secret = new.secret or new_secret()
    add = server.webhooks.store.add
    events = tuple(dict.fromkeys(new.events))
    added = await run_in_threadpool(add, new.url, events, secret=secret, by=who.name)
    await run_in_threadpool(audit, request, "add webhook", _named(added))
    return NewWebhookView(webhook=added, secret=secret)


@router.delete(
    "/{webhook_id}", status_code=204, dependencies=[RECENT_LOGIN], summary="Remove a webhook"
)
def remove_webhook(webhook_id: WebhookId, request: Request, server: Server) -> None:
    """Post nothing more; what waits is dropped."""
    removed = server.webhooks.store.remove(webhook_id)
    audit(request, "remove webhook", _named(removed))


@router.get("/{webhook_id}/deliveries", summary="Deliveries")
def list_deliveries(
    webhook_id: WebhookId, server: Server, language: Language
) -> list[WebhookDelivery]:
    """List the newest events of a webhook: delivered, or when and why they are sent again."""
    found = server.webhooks.store.deliveries(webhook_id)
    return [replace(one, problem=said(one.problem, language)) for one in found]


@router.post("/{webhook_id}/test", status_code=201, summary="Send a test")
def send_test(
    webhook_id: WebhookId, request: Request, server: Server, *, language: Language
) -> Webhook:
    """Post a test, and everything that waits, now."""
    store = server.webhooks.store
    store.try_now(webhook_id)
    store.keep(trial_event(webhook_id, secrets.token_hex(8), time=now()), only=webhook_id)
    tested = store.get(webhook_id)
    audit(request, "test webhook", _named(tested))
    server.webhooks.wake()
    return replace(tested, problem=said(tested.problem, language))


def _named(webhook: Webhook) -> str:
    """A webhook in the audit log: its host only, because the paths of some services are secrets."""
    return f"{webhook.id} {target_of(webhook.url).authority}"


async def _require_reachable(url: str, networks: Sequence[Network]) -> None:
    """Refuse an address that is never posted to, at once.

    Raises:
        ConfigError: If it is none, not known, or in a network that is not allowed.
    """
    target = target_of(url)
    try:
        async with asyncio.timeout(WEBHOOKS.answer_s):
            await address_of(target, networks)
    except TimeoutError:
        raise ConfigError(CodedText("webhook-host-unknown", host=target.host)) from None
    except NotReachable as error:
        raise ConfigError(CodedText("webhook-url", detail=text_of(error))) from error
