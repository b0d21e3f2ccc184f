"""Many kills of processes in real runs: ``… kills.py [--count 200] [--a-run 25]``.

Each run is killed at random moments, evenly over all of it, and must end in the bytes of an
unbroken one, with no stage run twice to its end, no process left and no unfinished file.
``--matrix``: instead four runs in which server, worker, viewer and child of the compute pool are
each killed in the middle of every stage once.
"""

from __future__ import annotations

import argparse
import shutil
import tempfile
import time
from collections import Counter
from pathlib import Path

from recon4.progress import Silent
from recon4.simulation.setup import prepare
from recon4.simulation.simulate import simulate
from tests.service import killing


def main() -> None:
    """Run, compare and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--a-run", type=int, default=25)
    parser.add_argument("--matrix", action="store_true")
    given = parser.parse_args()
    runs = len(killing.IN_A_STAGE) if given.matrix else -(-given.count // given.a_run)
    top = Path(tempfile.mkdtemp(prefix="recon4-kills-"))
    try:
        simulate(prepare("office", seconds=5.0, seed=3), top / "walk", bag=False, progress=Silent())
        whole = prepared(top, "whole")
        killing.run(whole, killing.request_for(whole), kills=0, seed=0)
        expected = killing.results(whole / "office"), killing.artifacts(whole / "office")
        hits: Counter[tuple[str, str]] = Counter()
        began = time.perf_counter()
        for seed in range(runs):
            root = prepared(top, f"run{seed}")
            request = killing.request_for(root)
            survived = (
                killing.run_gated(root, request, killing.row_of_the_matrix(seed))
                if given.matrix
                else killing.run(root, request, kills=given.a_run, seed=seed)
            )
            found = killing.results(root / "office"), killing.artifacts(root / "office")
            assert found == expected, f"run {seed} ended in other bytes: {survived}"
            twice = {k: n for k, n in killing.completed(root, survived).items() if n > 1}
            assert not twice, f"run {seed} did stages twice: {twice}"
            orphans, left = killing.orphans(root), killing.leftover_files(root)
            assert not orphans and not left, f"run {seed} left {orphans} {left}"
            hits.update(survived.hits)
            shutil.rmtree(root)
            print(f"run {seed}: {len(survived.hits)} kills survived", flush=True)
        print(f"{hits.total()} kills in {time.perf_counter() - began:.0f} s, all the same bytes")
        for (victim, stage), n in sorted(hits.items()):
            print(f"  {victim:7} in {stage:13} {n}")
    finally:
        shutil.rmtree(top, ignore_errors=True)


def prepared(top: Path, name: str) -> Path:
    """A folder of projects with the walk in it."""
    (top / name).mkdir()
    shutil.copytree(top / "walk", top / name / "walk")
    return top / name


if __name__ == "__main__":
    main()
