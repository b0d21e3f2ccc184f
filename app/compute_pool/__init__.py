"""Short heavy work for the pages, in confined child processes.

The server parses no file of a user: whatever opens one runs here, in a child that can read and
write only what its `FileAccess` names and that has no network. A child hands back JSON of the
declared type, never a pickle: one that a hostile file took over cannot reach the server by it.
"""

from app.compute_pool.model import NO_FILES, FileAccess, Lane, Quota, Terms
from app.compute_pool.pool import ComputePool

__all__ = ["NO_FILES", "ComputePool", "FileAccess", "Lane", "Quota", "Terms"]
