"""Reads and maps made-up recordings drawn at random, and lists what must not happen.

Run: python -m tests.benchmarks.variants --count 200 --seed 1
"""

from __future__ import annotations

import argparse
import shutil
import tempfile
from collections import defaultdict
from pathlib import Path

from tests.variants.run import Outcome, run_variant
from tests.variants.walk import record_walk


def main() -> None:
    """Run the variants of some seeds."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1, help="of the first variant")
    parser.add_argument("--seconds", type=float, default=5.0, help="length of each recording")
    parser.add_argument("--whole", action="store_true", help="run all stages and show verdicts")
    parser.add_argument("--said", action="store_true", help="also show what was said of each")
    parser.add_argument("--keep", type=Path, help="folder for the recordings of the findings")
    a = parser.parse_args()
    outcomes = []
    with tempfile.TemporaryDirectory() as folder:
        walk = record_walk(Path(folder) / "walk", seconds=a.seconds)
        for seed in range(a.seed, a.seed + a.count):
            place = Path(folder) / str(seed)
            place.mkdir()
            outcome = run_variant(seed, walk, place, whole=a.whole)
            outcomes.append(outcome)
            more = outcome.said * a.said + outcome.verdict
            print(outcome.text(), *more, sep="\n    ", flush=True)
            if outcome.findings and a.keep:
                shutil.copytree(place, a.keep / str(seed), dirs_exist_ok=True)
            shutil.rmtree(place)
    print(table(outcomes))


def table(outcomes: list[Outcome]) -> str:
    """Counts of each kind as a table."""
    kinds = defaultdict(list)
    for outcome in outcomes:
        kinds[outcome.variant.kind].append(outcome)
    lines = ["| kind | recordings | mapped | refused | findings |", "|---|---|---|---|---|"]
    for kind, of_kind in sorted(kinds.items()):
        results = [o.result for o in of_kind]
        found = sum(bool(o.findings) for o in of_kind)
        counts = f"{results.count('mapped')} | {results.count('refused')} | {found}"
        lines.append(f"| {kind} | {len(of_kind)} | {counts} |")
    return "\n".join(lines)


if __name__ == "__main__":
    main()
