"""What a run said of its map in English, said in another language."""

from __future__ import annotations

from collections.abc import Mapping

import msgspec

from recon4.findings.wording import said
from recon4.locales.languages import ENGLISH
from recon4.model.finding import Finding
from recon4.untrusted.typed import as_type


def summary_in(language: str, summary: Mapping[str, object]) -> dict[str, object]:
    """``summary.json`` with its findings and the reasons of its verdict in a language.

    What cannot be said again stays as it is: findings of other versions of recon4, whose kind or
    values this one does not know, and all before format 3.
    """
    found = summary.get("findings")
    if language == ENGLISH or not isinstance(found, list):
        return dict(summary)
    findings = [_said_again(one, language) for one in found]
    again = {_whole(before): _whole(after) for before, after in zip(found, findings, strict=True)}
    verdict = summary.get("verdict")
    if isinstance(verdict, dict) and isinstance(verdict.get("reasons"), list):
        verdict = verdict | {"reasons": [again.get(one, one) for one in verdict["reasons"]]}
    return {**summary, "findings": findings, **({"verdict": verdict} if verdict else {})}


def _said_again(record: object, language: str) -> object:
    known = _as_mapping(record)
    values = known.get("values")
    if isinstance(values, dict):  # null in a file is what is not known
        known = {**known, "values": {key: one for key, one in values.items() if one is not None}}
    try:
        return {**known, **said(as_type(known, Finding), language)}
    except (msgspec.ValidationError, KeyError):
        return record


def _whole(record: object) -> str:
    """Text and remedy, as `recon4.findings.wording.whole_text` puts them into a verdict."""
    known = _as_mapping(record)
    return " ".join(str(known[part]) for part in ("text", "remedy") if known.get(part))


def _as_mapping(record: object) -> Mapping[str, object]:
    return record if isinstance(record, dict) else {}
