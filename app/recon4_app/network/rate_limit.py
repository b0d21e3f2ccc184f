"""Rate limit of expensive actions, per person."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from starlette.requests import HTTPConnection

from recon4.locales.coded import CodedText
from recon4_app.access.login.login_backoff import TokenBuckets
from recon4_app.access.login.login_service import Access
from recon4_app.access.people import person
from recon4_app.errors import TooMany


def at_most(
    count: int, *, within_s: float, what: str
) -> Callable[[HTTPConnection], Iterator[None]]:
    """A dependency: at most ``count`` within that time per person; failed requests do not count.

    Without login there is one person, and no limit.

    Raises (when called by the framework):
        TooMany: With the time to wait.
    """

    def check(connection: HTTPConnection) -> Iterator[None]:
        access: Access = connection.app.state.parts.access
        name = person(connection).name
        if not access.login:
            yield
            return
        bucket = access.rates.setdefault(what, TokenBuckets(burst=count, per_s=count / within_s))
        if wait_s := bucket.take(name):
            raise TooMany(
                CodedText(
                    "too-many-started",
                    name=name,
                    count=count,
                    what=what,
                    minutes=f"{within_s / 60:.0f}",
                ),
                retry_after_s=wait_s,
            )
        try:
            yield
        except Exception:
            bucket.give_back(name)
            raise

    return check
