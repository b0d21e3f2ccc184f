"""What the nodes of a pose graph see: segments and range images, kept on disk."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from recon4.registration.overlap import make_range_image
from recon4.registration.submap import Ends, Submaps
from recon4.registration.tuning import OVERLAP, OverlapTuning
from recon4.store.row_file import RowFile


class SubmapReach(Protocol):
    """Multiframes around a node, and how many of their segments it keeps."""

    @property
    def source_reach(self) -> int:
        """Before and after the node, whose segments are registered."""

    @property
    def source_segments(self) -> int:
        """Largest number of these segments."""

    @property
    def target_reach(self) -> int:
        """Before and after the node, that form the target map."""


class NodeRangeImages:
    """Segments and range image of each node, for the registration of pairs; kept on disk.

    They are read when they are asked for, so memory does not grow with the walk.

    Args:
        count: Number of nodes.
        reach: Which multiframes belong to a node.
        overlap: Bins of the range images.
        scratch: Folder for the unnamed temporary file; a full disk raises OSError.
        kept: File in which an earlier run of the same search left nodes, and this one leaves its
            own; None = an unnamed file.
    """

    def __init__(
        self,
        count: int,
        reach: SubmapReach,
        *,
        scratch: Path,
        overlap: OverlapTuning = OVERLAP,
        kept: Path | None = None,
    ) -> None:
        self.scratch = scratch
        self._reach, self._overlap = reach, overlap
        self._bins = (overlap.azimuth_bins, overlap.elevation_bins)
        row = 4 * (6 * reach.source_segments + int(np.prod(self._bins)))
        self._rows = RowFile(count, row, scratch=scratch, kept=kept)

    def fill(self, submaps: Submaps, nodes: Sequence[int]) -> None:
        """Compute segments and range images of some nodes, unless an earlier run left them."""
        g = self._reach
        for node in nodes:
            if self._rows.has(node):
                continue
            # The segments of one multiframe are too few points to fill the bins of a view volume.
            wide = (
                submaps.around(node, g.target_reach).reshape(-1, 3)
                if g.target_reach
                else submaps.points_of(node)
            )
            near = _thin(submaps.around(node, g.source_reach), g.source_segments)
            view = make_range_image(wide, self._overlap)
            parts = view.nearest_m.astype(np.float32), near.astype(np.float32)
            self._rows.write(node, b"".join(part.tobytes() for part in parts))

    def has(self, node: int) -> bool:
        """Whether a node's are there and whole."""
        return self._rows.has(node)

    def ends(self, node: int) -> Ends:
        """Both ends of the node's segments, thinned evenly [m], (M, 2, 3)."""
        data = self._rows.read(node, start=4 * int(np.prod(self._bins)))
        return np.frombuffer(data, np.float32).reshape(-1, 2, 3).astype(np.float64)

    def nearest_m(self, node: int) -> NDArray[np.float32]:
        """The spherical z-buffer of the node, see `overlap.View`."""
        data = self._rows.read(node, size=4 * int(np.prod(self._bins)))
        return np.frombuffer(data, np.float32).reshape(self._bins)


def _thin(ends: Ends, limit: int) -> Ends:
    if len(ends) <= limit:
        return ends
    return ends[np.linspace(0, len(ends) - 1, limit).astype(np.intp)]
