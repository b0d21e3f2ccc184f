"""``python -m tests.security.fuzz --kind laz --count 10000 --seed 1``."""

from __future__ import annotations

import argparse
import sys
import time
from collections import Counter
from pathlib import Path

from tests.security.fuzz.kinds import KINDS
from tests.security.fuzz.mutators import mutant
from tests.security.fuzz.runner import GOOD, Readers, Tally, fuzz


def main() -> int:
    """Fuzz some kinds; exit code 1 if there are findings."""
    parser = argparse.ArgumentParser(prog="python -m tests.security.fuzz")
    parser.add_argument("--kind", action="append", choices=sorted(KINDS), help="all if not given")
    parser.add_argument("--count", type=int, default=1000, help="mutants a kind")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, help="number of the first mutant")
    parser.add_argument("--keep", type=Path, help="folder for one mutant of each sort of finding")
    chosen = parser.parse_args()
    found = 0
    sys.stdout.write("kind | mutants | ok | rejected | salvaged | findings | a second\n")
    for kind in chosen.kind or sorted(KINDS):
        start = time.monotonic()
        with Readers() as readers:
            tally = fuzz(kind, readers, count=chosen.count, seed=chosen.seed, first=chosen.first)
        _print(tally, time.monotonic() - start)
        found += len(tally.findings)
        if chosen.keep:
            _keep(tally, chosen.keep)
    return 1 if found else 0


def _print(tally: Tally, seconds: float) -> None:
    good = " | ".join(str(tally.outcomes[name]) for name in GOOD)
    sys.stdout.write(
        f"{tally.kind} | {tally.mutants} | {good} | {len(tally.findings)} | "
        f"{tally.mutants / seconds:.0f}\n"
    )
    sorts = Counter((f.outcome, f.words) for f in tally.findings)
    first = {(f.outcome, f.words): f.number for f in reversed(tally.findings)}
    for (outcome, words), count in sorts.most_common(40):
        number = first[outcome, words]
        sys.stdout.write(f"    {count} x {outcome} (mutant {number}): {words[:200]}\n")
    sys.stdout.flush()


def _keep(tally: Tally, folder: Path) -> None:
    kind = KINDS[tally.kind]
    seeds = list(kind.seeds())
    folder.mkdir(parents=True, exist_ok=True)
    for words in {f.words for f in tally.findings}:
        number = next(f.number for f in tally.findings if f.words == words)
        data = mutant(kind, seeds, tally.seed, number).data
        (folder / f"{kind.name}-{tally.seed}-{number}-{Path(kind.file_name).name}").write_bytes(
            data
        )


if __name__ == "__main__":
    sys.exit(main())
