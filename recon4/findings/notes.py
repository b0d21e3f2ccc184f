"""What ``summary.json`` notes beside the verdict."""

from __future__ import annotations

from collections.abc import Mapping

from recon4.findings.finding import Level


def notes_in(summary: Mapping[str, object]) -> list[str]:
    """Texts of the findings that do not change the verdict; before format 3, of all warnings."""
    findings = summary.get("findings")
    if isinstance(findings, list):
        return [str(one.get("text", "")) for one in findings if one.get("level") == Level.NOTE]
    warnings = summary.get("warnings")
    return [str(text) for text in warnings] if isinstance(warnings, list) else []
