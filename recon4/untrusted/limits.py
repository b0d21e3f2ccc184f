"""How much is read of what we did not write, or what somebody may have changed.

A larger file is refused with its size before memory is taken for it.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class UntrustedLimits:
    """Limits of files and names of unknown origin."""

    line_bytes: int = 64 * 1024
    """No table that recon4 reads has longer lines."""
    depth: int = 64
    """Nesting of a JSON document: what recon4 writes has fewer than ten levels."""
    folders: int = 100
    """Folders in a name of a backup; projects and recordings have fewer than ten."""
    json_bytes: int = 64 << 20
    """A JSON file of which nothing else is said here; files of recon4 are much smaller."""
    findings_bytes: int = 16 << 20
    """Findings, the report of a 2-D walk, a coordinate reference system."""
    description_bytes: int = 4 << 20
    """``project.json``."""
    session_bytes: int = 1 << 20
    """Facts of a live capture."""
    tile_list_bytes: int = 256 << 20
    """``tiles.json`` has some 300 bytes per tile."""
    array_bytes: int = 1 << 30
    """All arrays that are read from one file."""
    expansion: int = 200
    """Compressed data expands to at most as many times its size …"""
    free_bytes: int = 64 << 20
    """… but always to this: an intensity table is mostly zeros."""
    name: int = 200
    note: int = 500
    """Characters of a name and of a note of a user."""


LIMITS = UntrustedLimits()
