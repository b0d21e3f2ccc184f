"""``python -m recon4`` is the command ``recon4``."""

import sys

from recon4.cli import main

sys.exit(main())
