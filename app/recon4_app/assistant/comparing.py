"""Two runs side by side: what their summaries do not have in common."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence

from recon4.findings.summary_notes import SaidFinding, findings_in
from recon4.model.usability import verdict_in
from recon4_app.assistant.records import (
    Figure,
    FigureDifference,
    FindingDifference,
    RunComparison,
)

_APART = frozenset(
    {"settings", "hashes", "stages", "findings", "verdict", "versions", "approval"}
    | {"format", "name", "created"}
)
"""Parts of a summary that are no figures of the map."""
_Kind = tuple[str, str, str]
"""Code, sensor and direction of a finding."""


def figures_of(summary: Mapping[str, object]) -> dict[str, Figure]:
    """Figures of a summary; those of a group have a dot in their names, ``edges.accepted``."""
    return _flat({name: value for name, value in summary.items() if name not in _APART})


def compare(first: Mapping[str, object], second: Mapping[str, object]) -> RunComparison:
    """What two summaries do not have in common.

    Raises:
        StoreError: If a verdict or the findings of one cannot be read.
    """
    return RunComparison(
        verdicts=(_usability(first), _usability(second)),
        same_recording=_same_inputs(first, second),
        findings=_findings(findings_in(first) or [], findings_in(second) or []),
        figures=_differences(figures_of(first), figures_of(second)),
        settings=_differences(_flat(first.get("settings")), _flat(second.get("settings"))),
    )


def _usability(summary: Mapping[str, object]) -> str:
    verdict = verdict_in(summary)
    return verdict.usability if verdict else ""


def _same_inputs(first: Mapping[str, object], second: Mapping[str, object]) -> bool | None:
    inputs = [_hashes(summary) for summary in (first, second)]
    return inputs[0] == inputs[1] if all(inputs) else None


def _hashes(summary: Mapping[str, object]) -> list[str]:
    """Hashes of the inputs; their names may differ between runs."""
    hashes = summary.get("hashes")
    inputs = hashes.get("inputs") if isinstance(hashes, dict) else None
    return sorted(map(str, inputs.values())) if isinstance(inputs, dict) else []


def _findings(
    first: Sequence[SaidFinding], second: Sequence[SaidFinding]
) -> list[FindingDifference]:
    texts: dict[_Kind, tuple[list[str], list[str]]] = defaultdict(lambda: ([], []))
    about: dict[_Kind, SaidFinding] = {}
    for side, findings in enumerate((first, second)):
        for one in findings:
            kind = (one.kind, one.sensor, one.direction)
            texts[kind][side].append(one.text)
            about[kind] = max(about.get(kind, one), one, key=lambda found: found.level.rank)
    differing = [kind for kind, (of_first, of_second) in texts.items() if of_first != of_second]
    differing.sort(key=lambda kind: -about[kind].level.rank)
    return [
        FindingDifference(
            kind=kind[0], title=about[kind].title, first=texts[kind][0], second=texts[kind][1]
        )
        for kind in differing
    ]


def _differences(
    first: Mapping[str, Figure], second: Mapping[str, Figure]
) -> list[FigureDifference]:
    names = dict.fromkeys([*first, *second])
    return [
        FigureDifference(name=name, first=first.get(name), second=second.get(name))
        for name in names
        if first.get(name) != second.get(name)
    ]


def _flat(value: object, prefix: str = "") -> dict[str, Figure]:
    """Leaves of nested objects by dotted names; lists are left out."""
    if not isinstance(value, Mapping):
        return {}
    found: dict[str, Figure] = {}
    for name, one in value.items():
        if isinstance(one, Mapping):
            found |= _flat(one, f"{prefix}{name}.")
        elif one is None or isinstance(one, bool | int | float | str):
            found[f"{prefix}{name}"] = one
    return found
