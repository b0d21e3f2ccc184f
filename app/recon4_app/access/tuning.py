"""Times and limits of logins, sessions, pairing and audit log."""

from __future__ import annotations

from msgspec import Struct

from recon4.units import HOUR_S


class AuditLogLimits(Struct, frozen=True, kw_only=True):
    """The audit log."""

    max_text_chars: int = 300
    """Longer texts are cut [characters]."""
    max_failures_per_minute: int = 60
    """More refusals and failures are only counted, so that a stranger cannot fill the disk."""


AUDIT_LOG = AuditLogLimits()


class BackoffLimits(Struct, frozen=True, kw_only=True):
    """Delays after wrong passwords."""

    max_keys: int = 20_000
    """Beyond that the least recently used are forgotten."""


BACKOFF = BackoffLimits()


class LoginLimits(Struct, frozen=True, kw_only=True):
    """Logins at the same time."""

    concurrent_logins: int = 2
    """Passwords verified at the same time; each takes 64 MiB."""
    waiting_logins: int = 8
    """Logins of unknown browsers at the same time, so that a flood of them from many addresses
    takes no thread from other requests."""


LOGINS = LoginLimits()


class PasswordLimits(Struct, frozen=True, kw_only=True):
    """What a password must withstand."""

    shortest: int = 12
    longest: int = 256
    """Characters of a password."""
    min_attempts: int = 10**10
    """Attempts a new password must withstand (the highest score of zxcvbn)."""
    longest_estimated: int = 64
    """Characters the estimate uses; its time grows with the square."""
    max_substitutes: int = 8
    """Different substitutes (``4`` for ``a``) in one estimate: zxcvbn tries all combinations."""


PASSWORDS = PasswordLimits()


class SessionTimes(Struct, frozen=True, kw_only=True):
    """How long sessions last."""

    browser_known_s: float = 365.0 * 24 * HOUR_S
    """A browser in which somebody signed in is known for this long [s]."""
    clock_step_s: float = 60.0
    """A password given later than this from now was given before the clock was set back [s]."""
    cached_s: float = 2.0
    """Lifetime of a cached session: one ended by another process ends after that [s]."""
    noted_every_s: float = 30.0
    """Interval at which the last use of a session is written [s]."""


SESSION_TIMES = SessionTimes()


class SessionWatchTimes(Struct, frozen=True, kw_only=True):
    """Requests whose session may end."""

    look_again_s: float = 2.0
    """An open WebSocket or stream ends at most this long after its session [s]."""
    cancel_again_s: float = 1.0
    """A request that does not end is canceled again after this time [s]."""


SESSION_WATCH = SessionWatchTimes()


class GuestLinkLimits(Struct, frozen=True, kw_only=True):
    """Guest links."""

    max_days: int = 365
    """Longest time until a link expires [days]."""
    max_open: int = 100
    """Links of a project that are neither expired nor revoked."""
    max_sessions: int = 20
    """Browsers that have one link open; the one that came first is signed out."""
    kept_s: float = 365.0 * 24 * HOUR_S
    """An expired or revoked link stays in the list for this time [s]."""
    tries_a_minute: int = 20
    """Links that one network may open in a minute."""
    burst: int = 240
    """Requests at once of all guests of one link …"""
    per_s: float = 60.0
    """… and in a second after that."""


GUEST_LINK = GuestLinkLimits()


class AccessTokenLimits(Struct, frozen=True, kw_only=True):
    """Access tokens of programs."""

    max_days: int = 365
    """Longest time until a token expires [days]."""
    usual_days: int = 30
    """Time until a token expires, if nothing else is said [days]."""
    max_of_a_person: int = 20
    """Tokens of a person that have neither expired nor been revoked."""
    longest_label: int = 64
    """Longest name of a token [characters]."""


ACCESS_TOKEN = AccessTokenLimits()


class PairingLimits(Struct, frozen=True, kw_only=True):
    """Pairing of phones."""

    invitation_s: float = 120.0
    """An invitation is valid for this time [s] …"""
    request_s: float = 300.0
    """… and a request for this time [s]."""
    max_open: int = 20
    """Invitations, and requests, that wait at the same time …"""
    max_open_a_network: int = 4
    """… of which requests from one address, so that one client cannot fill the list."""
    tries_a_minute: int = 10
    """Codes that one network may try in a minute."""
    longest_name: int = 64
    """Longest name of a phone."""


PAIRING = PairingLimits()


class PeopleTimes(Struct, frozen=True, kw_only=True):
    """Logins of people."""

    recent_login_s: float = 900.0
    """Signing with one's name requires a password given within this time [s]."""


PEOPLE_TIMES = PeopleTimes()


class ReserveSizes(Struct, frozen=True, kw_only=True):
    """Space that is kept for the access databases."""

    reserve_bytes: int = 8 << 20
    """The write-ahead log grows to 4 MiB before its space is used again."""
    needed_bytes: int = 128 << 10
    """For one transaction."""


RESERVE = ReserveSizes()
