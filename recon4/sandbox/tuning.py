"""Tuning of confinement."""

from __future__ import annotations

from msgspec import Struct


class ConfinementTuning(Struct, frozen=True, kw_only=True):
    """What a confined process may take of the computer, and how barriers are tried."""

    memory_fraction: float = 0.7
    """Of the computer's memory: a file that asks for more ends its process only."""
    open_files: int = 4096
    """Of a command or a worker."""
    open_files_live: int = 1024
    """Of the recorder and the mapper."""
    tried_within_s: float = 30.0
    """Longest time of a child that says which barriers hold."""
    returned_block_bytes: int = 4 << 20
    """Freed blocks of this size go back to the system at once."""
    arenas: int = 1
    """Heaps of the C library that threads allocate in. Each keeps some of what is freed: in the
    stage calibration two more held 30 MB."""
    returned_packet_bytes: int = 8 << 20
    """The same while packets are decoded: a column of points of 0.1 s of an OS1-128 with two
    returns and 2048 columns takes 6 MB. Its multiframes are read in 0.6 of the time."""
    kept_bytes: int = 32 << 20
    """Of smaller ones this much stays with the process: a new page costs as much as the points of a
    packet that are decoded into it. Of an OS1-128 30 % of the time to read multiframes."""


CONFINEMENT = ConfinementTuning()
