"""Times and limits of reviews."""

from __future__ import annotations

from msgspec import Struct


class CheckTimes(Struct, frozen=True, kw_only=True):
    """Checks of an approval."""

    answer_within_s: float = 2.0
    """A request waits this long for a comparison [s]."""


CHECKS = CheckTimes()


class SigningTimes(Struct, frozen=True, kw_only=True):
    """Signing."""

    signing_limit_s: float = 1800.0
    """A map of tens of gigabytes is read and written once for its approval."""


SIGNING = SigningTimes()


class ReviewCacheLimits(Struct, frozen=True, kw_only=True):
    """What is kept in memory."""

    max_measurements: int = 500
    """Registrations."""
    max_queues: int = 4
    """Queues."""


REVIEW_CACHE = ReviewCacheLimits()


class PresenceLimits(Struct, frozen=True, kw_only=True):
    """Open review pages."""

    gone_s: float = 12.0
    """A page that says nothing for this long is closed [s]; it speaks every 4 s."""
    max_pages: int = 2000
    """Beyond that the oldest are forgotten."""


PRESENCE = PresenceLimits()
