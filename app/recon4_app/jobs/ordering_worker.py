"""A worker that gives orders: the program of a job, with a parent that has parts of it made.

``python -m recon4_app.jobs.ordering_worker ORDERS ANSWERS PROJECT MODULE JOB_FOLDER``
"""

from __future__ import annotations

import runpy
import sys
from pathlib import Path

from recon4.orders.confined import order_from_parent
from recon4.system.processes import die_with_parent


def main() -> None:
    """Run the module behind the descriptors and the project; it confines itself."""
    die_with_parent(0)
    orders, answers, project, module, folder = sys.argv[1:]
    order_from_parent(int(orders), int(answers), Path(project))
    sys.argv[1:] = [folder]
    runpy.run_module(module, run_name="__main__", alter_sys=True)


if __name__ == "__main__":
    main()
