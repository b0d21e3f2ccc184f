"""Times and limits of webhooks."""

from __future__ import annotations

from msgspec import Struct

from recon4.units import HOUR_S


class WebhookLimits(Struct, frozen=True, kw_only=True):
    """Deliveries, and how long is tried."""

    answer_s: float = 15.0
    """From the look-up of the name to the status of the response [s]."""
    first_retry_s: float = 5.0
    """After the first failure [s]; each further one waits `growth` times as long."""
    growth: float = 4.0
    longest_retry_s: float = 6.0 * HOUR_S
    """Between two attempts [s]: 8 attempts in the first day, then four a day."""
    look_every_s: float = 3600.0
    """For what nothing announced, as approvals that a killed server had not recorded [s]."""
    batch: int = 50
    """Deliveries of one webhook in one round."""
    max_webhooks: int = 20
    max_url: int = 500
    """Characters of an address."""
    listed: int = 200
    """Deliveries in a list."""
    kept_s: float = 30.0 * 24.0 * HOUR_S
    """A delivered event of a job stays in the list for this long [s]."""
    max_problem: int = 300
    """A longer problem is cut [characters]."""
    secret_bytes: int = 32
    min_secret_bytes: int = 24
    max_secret_bytes: int = 64
    """As Standard Webhooks recommends."""


WEBHOOKS = WebhookLimits()
