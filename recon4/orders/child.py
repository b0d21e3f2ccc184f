"""The confined process of ``recon4 process --workers``: ``recon4``, but it gives orders.

It ends with its parent, which receives the signals of the terminal and passes them on.
"""

from __future__ import annotations

import sys
from pathlib import Path

from recon4.orders.confined import order_from_parent
from recon4.system.processes import die_with_parent


def main() -> None:
    """Run the command behind the descriptors and the project in the arguments of this process."""
    die_with_parent(0)
    orders, answers, project, *command = sys.argv[1:]
    order_from_parent(int(orders), int(answers), Path(project))
    sys.argv[1:] = command
    from recon4.__main__ import main as recon4

    recon4()


if __name__ == "__main__":
    main()
