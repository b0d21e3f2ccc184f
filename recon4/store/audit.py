"""Is a project still what was written? Every byte is read again."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

from recon4.progress import Progress, track
from recon4.store.hashing import hash_file
from recon4.store.project import read_artifacts, read_stages
from recon4.store.stage import damage_of


@dataclass(frozen=True, slots=True)
class Audit:
    """What re-hashing found."""

    checked: int
    """Artifacts and results whose bytes were compared."""
    damaged: tuple[str, ...]
    """What differs, in words; empty = all is well."""
    unknown: tuple[str, ...]
    """Entries below ``artifacts/`` that no stage accounts for; they are left alone."""


def audit(root: Path, progress: Progress) -> Audit:
    """Compare every artifact and result of a project with the hashes kept when it was written.

    Raises:
        StoreError: If the folder is not a project or its ledger is damaged.
    """
    stages = read_stages(root)
    damaged: list[str] = []
    for row in track(stages, progress, what="artifacts", unit="artifacts"):
        folder = root / "artifacts" / row.key
        damage = damage_of(folder, hashes=True) if folder.is_dir() else ["is missing"]
        damaged += [f"{row.stage} {row.key[:12]}: {what}" for what in damage]
    results = _result_hashes(root)
    for name, sha256 in track(results.items(), progress, what="results", unit="files"):
        path = root / name
        if not path.is_file():
            damaged.append(f"{name} is missing")
        elif hash_file(path) != sha256:
            damaged.append(f"{name} has other bytes")
    known = {row.key for row in stages} | {path.name for path in read_artifacts(root).values()}
    unknown = sorted(p.name for p in (root / "artifacts").iterdir() if p.name not in known)
    return Audit(len(stages) + len(results), tuple(damaged), tuple(unknown))


def _result_hashes(root: Path) -> dict[str, str]:
    path = root / "summary.json"
    if not path.is_file():
        return {}
    hashes: dict[str, str] = json.loads(path.read_text("utf-8"))["hashes"]["results"]
    return hashes
