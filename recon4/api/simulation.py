"""Simulated walks, with the truth that a result can be compared with."""

from __future__ import annotations

from os import PathLike
from pathlib import Path

from recon4.cli.kernel_cache import settle_kernel_cache
from recon4.recording.sources import Sources


def simulate(
    world: str,
    out: str | PathLike[str],
    *,
    seconds: float = 60.0,
    seed: int = 1,
    rig: str | PathLike[str] = "4recon",
) -> Sources:
    """Simulate a walk of a person with a backpack of LiDARs and an IMU.

    Args:
        world: ``office``, ``staircase``, ``street``, ``field``, ``corridor:7``, …; all are in
            ``docs/explanation/simulation.md``.
        out: Folder to make, with the recording, its rig, and its truth (``truth.tum``,
            ``model.ply``).
        seconds: Length of the walk, at least 5 [s].
        seed: Draws the walk and the noise; the same seed gives the same bytes.
        rig: Name of a shipped rig, or a rig file.

    Returns:
        What `process` takes.

    Raises:
        ConfigError: If there is no such world, or the rig cannot be simulated.
        StoreError: If the folder exists with something in it, or cannot be written.

    >>> sources = api.simulate("office", "made", seconds=5.0)
    >>> [path.name for path in sources.paths]
    ['recording.pcap', 'imu.csv']
    """
    settle_kernel_cache()
    from recon4.model.rig import load_rig
    from recon4.progress import Silent
    from recon4.simulation.setup import prepare
    from recon4.simulation.simulate import simulate as run

    folder = Path(out)
    setup = prepare(world, seconds=seconds, seed=seed, rig=load_rig(rig))
    run(setup, folder, bag=False, progress=Silent())
    imu, gnss = folder / "imu.csv", folder / "gnss.csv"
    return Sources.of(
        folder / "recording.pcap",
        rig=folder / "rig.toml",
        imu=imu if imu.exists() else None,
        gnss=gnss if gnss.exists() else None,
    )
