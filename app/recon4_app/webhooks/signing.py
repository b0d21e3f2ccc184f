"""Signatures of webhooks, by the scheme of Standard Webhooks (HMAC-SHA256).

https://github.com/standard-webhooks/standard-webhooks/blob/main/spec/standard-webhooks.md
"""

from __future__ import annotations

import base64
import binascii
import hashlib
import hmac
import secrets

from recon4.errors import ConfigError
from recon4.locales.coded import CodedText
from recon4_app.webhooks.tuning import WEBHOOKS

PREFIX = "whsec_"


def new_secret() -> str:
    """A random secret."""
    return PREFIX + base64.b64encode(secrets.token_bytes(WEBHOOKS.secret_bytes)).decode()


def key_of(secret: str) -> bytes:
    """The key in a secret.

    Raises:
        ConfigError: If it is none.
    """
    try:
        key = base64.b64decode(secret.removeprefix(PREFIX), validate=True)
    except (binascii.Error, ValueError):
        key = b""
    if not WEBHOOKS.min_secret_bytes <= len(key) <= WEBHOOKS.max_secret_bytes:
        raise ConfigError(
            CodedText(
                "webhook-secret",
                prefix=PREFIX,
                least=WEBHOOKS.min_secret_bytes,
                most=WEBHOOKS.max_secret_bytes,
            )
        )
    return key


def signed_headers(secret: str, event: str, body: str, *, now_s: float) -> dict[str, str]:
    """Headers that prove who sent a body, and when.

    Args:
        secret: That of the webhook.
        event: Id of the event.
        body: What is posted.
        now_s: Time of this attempt [s]; receivers refuse old ones.
    """
    timestamp = str(int(now_s))
    signed = f"{event}.{timestamp}.{body}".encode()
    signature = base64.b64encode(hmac.digest(key_of(secret), signed, hashlib.sha256)).decode()
    return {
        "webhook-id": event,
        "webhook-timestamp": timestamp,
        "webhook-signature": f"v1,{signature}",
    }
