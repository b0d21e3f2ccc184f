"""False loops injected into the graphs of processed walks (issue's row 4).

    python -m tests.benchmarks.false_loops_real PROJECT [PROJECT …]

The projects' own graphs before verification; a good edge is one that verification keeps when
nothing is injected.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from recon4.pose_graph.files import load_graph
from recon4.pose_graph.verification import verify
from recon4.settings import VerificationSettings
from recon4.store.project import read_artifacts
from tests.benchmarks.false_loops import ATTACKS

INJECTED = 20


def main(projects: list[Path]) -> None:
    print("graph, attack: false rejected, good edges lost")
    for project in projects:
        graph = load_graph(read_artifacts(project)["graph"])
        settings = VerificationSettings()
        kept = np.array([e.in_graph for e in verify(graph, settings=settings).graph.edges])
        for name, inject in ATTACKS.items():
            attacked = inject(graph, np.random.default_rng(3))
            found = verify(attacked, settings=settings).graph
            now = np.array([e.in_graph for e in found.edges])
            lost = int(np.sum(kept & ~now[: len(kept)]))
            rejected = int(np.sum(~now[-INJECTED:]))
            print(
                f"{project.name}, {name}: {rejected} of {INJECTED}, {lost} of {int(kept.sum())}",
                flush=True,
            )


if __name__ == "__main__":
    main([Path(name) for name in sys.argv[1:]])
