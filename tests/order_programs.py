"""Programs that give orders, in place of ``recon4 process``: as it should, and taken over."""

from __future__ import annotations

import os
import sys
from pathlib import Path

from recon4.orders.confined import order_from_parent, workers_of_this_process
from recon4.sandbox import Policy, confine
from recon4.sandbox.private_cache import use_private_cache
from recon4.system.processes import die_with_parent


def main() -> None:
    """Run the program that the last argument names."""
    die_with_parent(0)
    orders, answers, project, program = sys.argv[1:]
    if program == "map":
        make(int(orders), int(answers), Path(project))
    elif program.startswith("end"):
        os.write(int(orders), bytes.fromhex(program.removeprefix("end")))
        raise SystemExit(7)
    else:
        os.write(int(orders), bytes.fromhex(program))
        os.read(int(answers), 1)  # and wait for ever
        raise SystemExit(9)


def make(orders: int, answers: int, project: Path) -> None:
    """Make a map as a confined process does."""
    order_from_parent(orders, answers, project)
    use_private_cache(project / "caches")
    confine(Policy(read=(Path("/"),), write=(project,), temporary=project / "tmp"))
    from tests.ordered_maps import make_map

    make_map(project, workers_of_this_process())


if __name__ == "__main__":
    main()
