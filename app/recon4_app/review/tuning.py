"""Times and limits of reviews."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class CheckTimes:
    """Checks of an approval."""

    answer_within_s: float = 2.0
    """A request waits this long for a comparison [s]."""


CHECKS = CheckTimes()


@dataclass(frozen=True, slots=True, kw_only=True)
class SigningTimes:
    """Signing."""

    signing_limit_s: float = 1800.0
    """A map of tens of gigabytes is read and written once for its approval."""


SIGNING = SigningTimes()


@dataclass(frozen=True, slots=True, kw_only=True)
class ReviewCacheLimits:
    """What is kept in memory."""

    max_measurements: int = 500
    """Registrations."""
    max_queues: int = 4
    """Queues."""


REVIEW_CACHE = ReviewCacheLimits()
