"""Compile the kernels once, before processes that run side by side would each do it.

``python -m tests.compile_kernels`` maps a short simulated walk; without effect when the kernels
are compiled already.
"""

import tempfile
from pathlib import Path

from recon4.pipeline import process
from recon4.progress import Silent
from recon4.recording.sources import Sources
from recon4.sandbox.private_cache import is_compiled, mark_compiled
from recon4.simulation.setup import prepare
from recon4.simulation.simulate import simulate

SECONDS = 5.0


def compile_kernels() -> None:
    """Simulate and process a walk in a folder of its own."""
    office = prepare("office", seconds=SECONDS, seed=1)
    with tempfile.TemporaryDirectory() as name:
        walk = Path(name) / "walk"
        simulate(office, walk, bag=False, progress=Silent())
        sources = Sources((walk / "recording.pcap",), None, walk / "imu.csv", None)
        process(sources, Path(name) / "map")
    mark_compiled()


if __name__ == "__main__" and not is_compiled():
    compile_kernels()
