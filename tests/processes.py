"""Processes of a running test, looked at from outside."""

from __future__ import annotations

from pathlib import Path

import psutil


def command_of(process: psutil.Process) -> list[str]:
    """Its command line; empty for one that has ended meanwhile."""
    try:
        return process.cmdline()
    except psutil.Error:
        return []


def viewer_process(root: Path) -> psutil.Process:
    """The viewer of the project below a folder; there must be one only."""
    mine = [
        process
        for process in psutil.Process().children(recursive=True)
        if "recon4_app.viewer.process" in command_of(process)
        and str(root / "office") in command_of(process)
    ]
    assert len(mine) == 1
    return mine[0]
