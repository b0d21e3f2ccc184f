"""Names of constant offsets between clocks: leap seconds, hours, time since power-on."""

from __future__ import annotations

from collections.abc import Sequence

from recon4.locales.coded import CodedText, joined
from recon4.model.finding import Value
from recon4.recording.clocks.tuning import CLOCK_NAMES
from recon4.units import HOUR_S

_KNOWN_S = {18.0: "gps-utc", 37.0: "tai-utc", 19.0: "tai-gps"}
"""Since 2017."""
_NAMES = {
    "gps-utc": "GPS time against UTC",
    "tai-utc": "TAI against UTC",
    "tai-gps": "TAI against GPS time",
    "time-zone": "whole hours, as of a time zone",
    "power-on": "one of them counts from power-on",
}
"""As messages of errors name them."""


def known_offset_s(offset_s: float) -> float:
    """The exact offset that a measured one is; without a known one, the measured [s]."""
    sign = 1.0 if offset_s > 0 else -1.0
    if abs(offset_s) < CLOCK_NAMES.dates_s:
        for known in (*_KNOWN_S, round(abs(offset_s) / HOUR_S) * HOUR_S):
            if known and abs(abs(offset_s) - known) < CLOCK_NAMES.within_s:
                return sign * known
    return offset_s


def looks_like(offset_s: float) -> str:
    """What an offset between two clocks looks like, as a word of the catalog; empty = unknown."""
    exact = abs(known_offset_s(offset_s))
    if exact in _KNOWN_S:
        return _KNOWN_S[exact]
    if exact and exact < CLOCK_NAMES.dates_s and exact % HOUR_S == 0.0:
        return "time-zone"
    return "power-on" if abs(offset_s) > CLOCK_NAMES.dates_s else ""


def offset_values(ahead_s: float) -> dict[str, Value]:
    """An offset between two clocks as values of a finding."""
    looks = looks_like(ahead_s)
    return {"ahead_s": ahead_s} | ({"looks": looks} if looks else {})


def described(offset_s: float) -> str:
    """An offset in words, such as ``+18.012 s (GPS time against UTC)``."""
    name = _NAMES.get(looks_like(offset_s), "")
    return f"{offset_s:+z.3f} s{f' ({name})' if name else ''}"


def clocks_text(starts: Sequence[tuple[str, int]]) -> CodedText:
    """How far the clocks of LiDARs are apart, what that looks like, and the remedy.

    Args:
        starts: Name of each, and the time of its first point [ns]; the first one is the reference.
    """
    (first, start_ns), *others = starts
    ahead_s = {name: (t_ns - start_ns) / 1e9 for name, t_ns in others}
    exact_s = {name: known_offset_s(s) for name, s in ahead_s.items() if looks_like(s)}
    ahead = [
        CodedText("clock-ahead", name=name, first=first, offset=described(s))
        for name, s in ahead_s.items()
    ]
    remedies = [
        CodedText(
            "clock-remedy",
            name=name,
            offset=f"{-exact_s.get(name, s):.3f}",
            exact="exact" if name in exact_s else "about",
        )
        for name, s in ahead_s.items()
    ]
    return CodedText("clocks-differ", ahead=joined(ahead), remedy=joined(remedies))
