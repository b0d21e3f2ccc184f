"""What later stages read of the import report, ``report.json`` of the stage ``frames``."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import msgspec
from msgspec.structs import replace

from recon4.errors import StoreError
from recon4.locales.coded import unreadable
from recon4.model.derived import Derived
from recon4.model.derived_kinds import DerivedKind
from recon4.model.finding import Finding, Level
from recon4.model.finding_kinds import FindingKind
from recon4.untrusted.typed import as_type

HEIGHTS_UNSTATED, HEIGHTS_ORTHOMETRIC = "gnss_heights_unstated", "gnss_heights_orthometric"
"""Counts of fixes whose height is taken as ellipsoidal because nothing says what it is above, and
of those above sea level without a geoid separation."""

CLOUDS_UNTIMED = "clouds_untimed"
"""Count of clouds whose points have no times: these follow from the stamp, which may be that of the
start, the middle or the end of a cloud, so nothing says how a clock lies to that of the points."""

CLOUDS_EVENED = "clouds_evened"
"""Count of clouds that are put where even stamps would be: how late these are is not known."""

GYRO_UNIT_ASSUMED = "imu_gyro_assumed"
"""Count of angular rates that are taken as rad/s although they are large, and the accelerations do
not say whether they are in deg/s."""


class ImportNotes(msgspec.Struct, frozen=True):
    """Outcome, findings and counts of reading a recording."""

    outcome: str = "complete"
    """``complete``, ``lossy`` (salvaged) or ``nothing``."""
    findings: tuple[Finding, ...] = ()
    """What the readers warn of."""
    counts: dict[str, int] = {}


class _EarlierNotes(msgspec.Struct, frozen=True):
    """What readers wrote before their warnings were findings."""

    warnings: tuple[str, ...] = ()


def import_notes(report: Mapping[str, object], mount_doubts: Sequence[str] = ()) -> ImportNotes:
    """Read a parsed import report; missing parts are as by default.

    Sentences of earlier versions become findings that quote them.

    Args:
        report: Contents of ``report.json``.
        mount_doubts: Sentences of an earlier version about the mount of a 2-D laser.

    Raises:
        StoreError: If a value has another type.
    """
    try:
        notes = as_type(report, ImportNotes)
        sentences = as_type(report, _EarlierNotes).warnings
    except msgspec.ValidationError as error:
        raise StoreError(unreadable("frames/report.json", error)) from error
    others = (text for text in sentences if text not in mount_doubts)
    earlier = [_quoted(FindingKind.LASER_MOUNT, text) for text in mount_doubts]
    earlier += [_quoted(FindingKind.IMPORT_REMARK, text) for text in others]
    return replace(notes, findings=(*notes.findings, *earlier))


def derived_in(report: Mapping[str, object]) -> tuple[Derived, ...]:
    """What the readers derived, in a parsed import report.

    Sentences of earlier versions become records that quote them.

    Raises:
        StoreError: If a value has another type.
    """
    try:
        found = as_type(report.get("derived", []), list[str | Derived])
    except msgspec.ValidationError as error:
        raise StoreError(unreadable("frames/report.json", error)) from error
    earlier = DerivedKind.EARLIER_SENTENCE
    return tuple(
        Derived(kind=earlier, values={"text": one}) if isinstance(one, str) else one
        for one in found
    )


def _quoted(kind: FindingKind, text: str) -> Finding:
    return Finding(kind=kind, level=Level.CHECK, values={"text": text})
