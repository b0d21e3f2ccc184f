"""Limits of login attempts: a delay that grows with failures, and token buckets that refill.

Kept in memory: a restart forgets it, which an attacker on the network cannot cause.
"""

from __future__ import annotations

import ipaddress
import threading
import time
from collections import OrderedDict
from collections.abc import Callable, Hashable

from recon4_app.access.tuning import BACKOFF


class LoginBackoff:
    """After some failures each further attempt has to wait twice as long as the one before."""

    def __init__(
        self,
        *,
        free: int = 5,
        longest_s: float = 900.0,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._free, self._longest_s, self._clock = free, longest_s, clock
        self._failures: OrderedDict[Hashable, tuple[int, float]] = OrderedDict()
        self._lock = threading.Lock()

    def begin(self, key: Hashable) -> float:
        """Begin an attempt; it counts as a failure until `succeed` is called.

        Returns:
            0 if the attempt is allowed now, else the seconds to wait; then nothing is counted.
        """
        with self._lock:
            count, last_s = self._failures.get(key, (0, 0.0))
            over = count - self._free
            wait_s = min(2.0 ** min(over, 30), self._longest_s) if over >= 0 else 0.0
            left_s = last_s + wait_s - self._clock()
            if left_s > 0:
                return left_s
            self._failures[key] = (count + 1, self._clock())
            self._failures.move_to_end(key)
            while len(self._failures) > BACKOFF.max_keys:
                self._failures.popitem(last=False)
            return 0.0

    def succeed(self, key: Hashable) -> None:
        """Reset the failures of a key."""
        with self._lock:
            self._failures.pop(key, None)


class TokenBuckets:
    """Token bucket per key: ``burst`` tokens at once, ``per_s`` tokens a second after that."""

    def __init__(
        self, *, burst: int, per_s: float, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._burst, self._per_s, self._clock = burst, per_s, clock
        self._left: OrderedDict[Hashable, tuple[float, float]] = OrderedDict()
        self._lock = threading.Lock()

    def take(self, key: Hashable) -> float:
        """Take a token.

        Returns:
            0 if there was one, else the seconds until there is one.
        """
        with self._lock:
            now_s = self._clock()
            left, then_s = self._left.get(key, (float(self._burst), now_s))
            left = min(float(self._burst), left + (now_s - then_s) * self._per_s)
            taken = left >= 1.0
            self._left[key] = (left - taken, now_s)
            self._left.move_to_end(key)
            while len(self._left) > BACKOFF.max_keys:
                self._left.popitem(last=False)
            return 0.0 if taken else (1.0 - left) / self._per_s

    def give_back(self, key: Hashable) -> None:
        """Return a token that was taken but not used."""
        with self._lock:
            if key in self._left:
                left, then_s = self._left[key]
                self._left[key] = (min(float(self._burst), left + 1.0), then_s)


def network(address: str) -> str:
    """The network by which attempts are counted: one household has 2^64 IPv6 addresses."""
    try:
        parsed = ipaddress.ip_address(address)
    except ValueError:
        return address
    if isinstance(parsed, ipaddress.IPv6Address):
        if parsed.ipv4_mapped is not None:
            return str(parsed.ipv4_mapped)
        return str(ipaddress.ip_network((parsed, 64), strict=False))
    return str(parsed)
