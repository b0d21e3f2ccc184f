"""The verdict on a map in one line, the same in every report and on the pages."""

from __future__ import annotations

from recon4.model.usability import Usability

HEADLINES = {
    Usability.GOOD: "No problem found in this map",
    Usability.CHECK: "Check this map",
    Usability.DO_NOT_USE: "Do not use this map",
}
"""As `STATES` of ``web/shared/format.js``."""
LEVELS = {Usability.GOOD: "good", Usability.CHECK: "warning", Usability.DO_NOT_USE: "bad"}
"""Style of the headline."""
