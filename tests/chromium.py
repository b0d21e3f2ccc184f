"""The browser of tests: Debian's Chromium without a screen."""

import os
from pathlib import Path

CHROMIUM = Path(os.environ.get("RECON4_CHROMIUM", "/usr/bin/chromium"))
FLAGS = [
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
]
