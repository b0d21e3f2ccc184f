"""Flip single bits of a small approved project, one at a time; every one must be found.

    python -m tests.benchmarks.flips [--flips 2000]

A file is drawn first, then a bit of it, so that small files are hit as often as large ones.
"""

from __future__ import annotations

import argparse
import random
import sys
import tempfile
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

from recon4.archive.verify import verify
from recon4.errors import Recon4Error
from recon4.progress import Silent
from recon4.review.decisions import Decision, DecisionKind
from recon4.review.journal import append
from recon4.store.hashing import files_below
from recon4.store.seal import changing
from recon4_app.access.disk_reserve import RESERVE_FILE
from tests.project_builder import approve_project, build_project


@dataclass
class Outcome:
    """Results of the flips."""

    flips: int = 0
    found: int = 0
    missed: list[str] = field(default_factory=list)
    tracebacks: list[str] = field(default_factory=list)
    by_file: Counter[str] = field(default_factory=Counter)


def make(root: Path) -> Path:
    """A root with a project that was decided about, approved, and has control points."""
    office = root / "office"
    build_project(office, points=1_000)
    for kind in (DecisionKind.REJECT, DecisionKind.UNDO):
        pair = (0, 30) if kind is DecisionKind.REJECT else None
        append(office, Decision(kind=kind, who="anna", pair=pair))
    approve_project(office, root / ".recon4" / "signing.key", who="anna")
    with changing(office, "slices"):
        (office / "slices").mkdir()
        (office / "slices" / "control.json").write_text('{"points": [], "version": 1}')
    return office


def flip_bits(root: Path, flips: int, *, seed: int = 1) -> Outcome:
    """Flip, verify, and put back; disk space that is kept has no content."""
    rng, outcome = random.Random(seed), Outcome()
    names = [
        name
        for name in files_below(root)
        if (root / name).stat().st_size and not name.endswith(RESERVE_FILE)
    ]
    for _ in range(flips):
        path = root / rng.choice(names)
        whole, mode = path.read_bytes(), path.stat().st_mode
        at = rng.randrange(8 * len(whole))
        data = bytearray(whole)
        data[at // 8] ^= 1 << (at % 8)
        path.chmod(0o644)
        path.write_bytes(data)
        _judge(root, f"{path.relative_to(root)} bit {at}", outcome)
        path.write_bytes(whole)
        path.chmod(mode)
        outcome.by_file[path.name] += 1
    return outcome


def _judge(root: Path, what: str, outcome: Outcome) -> None:
    outcome.flips += 1
    try:
        damaged = verify(root, Silent()).damaged
    except Recon4Error:
        damaged = ("refused",)
    except Exception as error:  # the figure: what a user would see as a traceback
        outcome.tracebacks.append(f"{what}: {error!r}")
        return
    if damaged:
        outcome.found += 1
    else:
        outcome.missed.append(what)


def main() -> int:
    """Run and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--flips", type=int, default=2_000)
    chosen = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        make_server_state(root)
        make(root)
        clean = verify(root, Silent())
        sys.stdout.write(f"before: {clean.damaged} {clean.notes}\n")
        found = flip_bits(root, chosen.flips)
    for one in [*found.missed, *found.tracebacks]:
        sys.stdout.write(f"  {one}\n")
    sys.stdout.write(
        f"{found.flips} flips in {len(found.by_file)} kinds of files: {found.found} found, "
        f"{len(found.missed)} missed, {len(found.tracebacks)} tracebacks\n"
    )
    return 1 if found.missed or found.tracebacks or clean.damaged else 0


def make_server_state(root: Path) -> None:
    """Files of a server: queue, users, an interrupted upload."""
    from recon4.archive.verify import seal_state
    from recon4.review.signature import sign
    from recon4_app.access.login.login_service import open_access
    from recon4_app.jobs.store import JobStore

    state = root / ".recon4"
    (state / "uploads" / ("a" * 12)).mkdir(parents=True)
    (state / "uploads" / ("a" * 12) / "upload.json").write_text('{"name": "walk"}')
    JobStore(state / "jobs.sqlite").close()
    open_access(state, login=True).close()
    sign({}, state / "signing.key")
    seal_state(state)


if __name__ == "__main__":
    sys.exit(main())
