"""HTTP routes of the keys whose signatures count on this server."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from fastapi import APIRouter, Depends, Path, Request

from recon4.review.trusted_keys import TrustedKey, TrustedKeys, add_key, read_keys, remove_key
from recon4.untrusted.names import visible
from recon4_app.access.audit import audit
from recon4_app.access.login.routes import Wire
from recon4_app.access.people import Permission, Who, needs, recent_login
from recon4_app.deps import Server, ServerParts
from recon4_app.error_responses import problems
from recon4_app.names import Name

router = APIRouter(
    prefix="/api/keys",
    tags=["administration"],
    dependencies=[Depends(needs(Permission.ADMINISTER))],
    responses=problems(403, 422),
)
RECENT_LOGIN = Depends(recent_login)
Fingerprint = Annotated[str, Path(pattern="^[0-9a-f]{16}$")]


class NewKey(Wire):
    """A key to be trusted."""

    name: Name
    """Whose it is."""
    public_key: Name
    """64 hexadecimal digits."""


@dataclass(frozen=True, slots=True, kw_only=True)
class KeyView:
    """A key, and whether its signatures count."""

    fingerprint: str
    public_key: str
    name: str
    own: bool
    """Whether this server made it."""
    added: str
    """UTC, ISO 8601."""
    by: str
    removed: str
    """When it was removed; empty = its signatures count."""
    removed_by: str


@router.get("", summary="Trusted keys")
def list_keys(server: Server) -> list[KeyView]:
    """List the keys of this server and those that were added; removed ones come last."""
    keys = _trusted(server).keys.values()
    ordered = sorted(keys, key=lambda key: (bool(key.removed), not key.own, key.added))
    return [_view(key) for key in ordered]


@router.post("", status_code=201, dependencies=[RECENT_LOGIN], summary="Trust a key")
def trust_key(new: NewKey, request: Request, server: Server, *, who: Who) -> KeyView:
    """Count what a key signed. Compare the key with the signer first."""
    key = add_key(_trusted(server), new.name, new.public_key, by=who.name)
    audit(request, "trust key", f"{key.fingerprint} {key.name}")
    return _view(key)


@router.delete("/{fingerprint}", dependencies=[RECENT_LOGIN], summary="Remove a key")
def remove_trusted_key(
    fingerprint: Fingerprint, request: Request, server: Server, *, who: Who
) -> KeyView:
    """Count nothing that a key signed, whenever it was."""
    key = remove_key(_trusted(server), fingerprint, by=who.name)
    audit(request, "remove key", f"{key.fingerprint} {key.name}")
    return _view(key)


def _trusted(server: ServerParts) -> TrustedKeys:
    return read_keys(server.settings.state, server=True)


def _view(key: TrustedKey) -> KeyView:
    return KeyView(
        fingerprint=key.fingerprint,
        public_key=key.public_key,
        name=visible(key.name),
        own=key.own,
        added=key.added,
        by=visible(key.by),
        removed=key.removed,
        removed_by=visible(key.removed_by),
    )
