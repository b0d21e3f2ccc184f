"""What a recording lacks and its reader derived or chose, as a record without prose."""

from __future__ import annotations

import msgspec

from recon4.model.derived_kinds import DerivedKind
from recon4.model.finding import Value


class Derived(msgspec.Struct, frozen=True, kw_only=True, omit_defaults=True):
    """One thing that was derived or chosen. ``recon4.findings.derived`` puts it into words."""

    kind: DerivedKind
    values: dict[str, Value] = {}
    """Figures and names that its text quotes, in SI units and radians; a value that is not known is
    left out."""
